"""Mirrors behind clear panes, films and drops: they show the scene through these, as Cycles renders it."""
from __future__ import annotations

import json

import bpy
import numpy as np
import parts
import pytest
from lamp_scenes import SIZE, picture, psnr

KINDS = {"glass": "ShaderNodeBsdfGlass", "transparent": "ShaderNodeBsdfTransparent"}


def clear(kind: str, colour=(1.0, 1.0, 1.0), share: float = 1.0) -> bpy.types.Material:
    """A clear material, of which so much is clear; the rest is light blue."""
    made = parts.material(f"Clear {kind}")
    tree = made.node_tree
    shader, output = tree.nodes.new(KINDS[kind]), tree.nodes["Material Output"]
    shader.inputs["Color"].default_value = (*colour, 1.0)
    if kind == "glass":
        shader.inputs["Roughness"].default_value = 0.0
    mix = tree.nodes.new("ShaderNodeMixShader")
    mix.inputs[0].default_value = share
    tree.nodes["Emission"].inputs[0].default_value = (0.4, 0.6, 0.9, 1.0)
    tree.links.new(tree.nodes["Emission"].outputs[0], mix.inputs[1])
    tree.links.new(shader.outputs[0], mix.inputs[2])
    tree.links.new((shader if share == 1.0 else mix).outputs[0], output.inputs["Surface"])
    return made


@pytest.fixture
def before_a_mirror(blank):
    """Boxes of three colours before a wall mirror at y = 1, 7 m from the camera: layers slide by 2 to 15 mm there."""
    scene = blank.scene
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    scene.cycles.samples = 16
    boxes = []
    for number, x in enumerate((-1.6, 0.0, 1.7)):
        place = (x, -1.5 - 0.5 * number, 0.4 + 0.7 * number)
        boxes.append(parts.add("cube", f"Box {number}", size=1.0, location=place))
        boxes[-1].data.materials.append(parts.material(f"Paint {number}"))
        boxes[-1].data.materials[0].node_tree.nodes["Emission"].inputs[0].default_value = (
            *np.roll((0.9, 0.3, 0.1), number), 1.0)
        boxes[-1].visible_camera = False
    mirror = parts.add_wall_mirror()
    mirror.data.materials.append(parts.material("Chrome", "GLOSSY"))
    mirror.data.materials[0].node_tree.nodes[0].inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    return mirror


def pane(ahead: float, thick: float, material: bpy.types.Material) -> bpy.types.Object:
    """A box in the whole of the picture, so far before the mirror."""
    made = parts.add("cube", "Pane", size=1.0, location=(0.0, 1.0 - ahead - 0.5 * thick, 1.0))
    made.scale = (5.0, thick, 5.0)
    made.data.materials.append(material)
    return made


def film(ahead: float, material: bpy.types.Material) -> bpy.types.Object:
    made = parts.add("plane", "Film", size=2.0, location=(0.3, 1.0 - ahead, 1.2), rotation=(np.pi / 2, 0.0, 0.0))
    made.data.materials.append(material)
    return made


def drops(material: bpy.types.Material) -> bpy.types.Object:
    drop = parts.add("uv_sphere", "Drop", segments=24, ring_count=12, radius=0.3, location=(0.2, 1.0, 1.1))
    drop.scale.y = 0.1
    drop.data.shade_smooth()
    drop.data.materials.append(material)
    return drop


CASES = {"6 mm": lambda: pane(0.006, 0.004, clear("glass")), "3 mm": lambda: pane(0.003, 0.004, clear("glass")),
         "1 mm": lambda: pane(0.001, 0.004, clear("glass")), "0.5 mm": lambda: pane(0.0005, 0.004, clear("glass")),
         "touching": lambda: pane(0.00005, 0.005, clear("transparent")),
         "tinted": lambda: pane(0.004, 0.004, clear("transparent", (0.5, 0.9, 0.6))),
         "film": lambda: film(0.004, clear("transparent", share=0.7)),
         "close film": lambda: film(0.0005, clear("transparent", share=0.7)),
         "drop": lambda: drops(clear("glass"))}


@pytest.mark.thorough
@pytest.mark.parametrize("name", CASES)
def test_a_mirror_shows_the_scene_through_what_is_clear(before_a_mirror, room, name, capfd):
    CASES[name]()
    parts.select(before_a_mirror)
    reference, other = picture(room), picture(room, seed=7)
    result = parts.generate()
    shown = [source.object.name for source in result.reflection_mesh.sources]
    faces = np.bincount(parts.attribute(result, "source_object"), minlength=len(shown))
    there = all(faces[shown.index(f"Box {number}")] for number in range(3))
    # what lies too close to be shown through is left out, with a sentence
    assert there == (name != "close film") == ("so close before this mirror" not in capfd.readouterr().out)
    # Cycles shows results to rays of the camera, which go on through what is transparent: nothing is left to the mirror
    before_a_mirror.hide_render = name in ("touching", "tinted", "film")
    assert psnr(picture(room), reference) > min(psnr(other, reference), 40.0) - 1.5


@pytest.mark.parametrize("name", ["6 mm", "0.5 mm", "film", "drop"])
def test_a_comparison_looks_through_it_too(before_a_mirror, tmp_path, name):
    CASES[name]()
    parts.select(before_a_mirror)
    assert bpy.ops.reflection_mesh.compare(filepath=str(tmp_path), samples=1) == {"FINISHED"}
    report = json.loads((tmp_path / "report.json").read_text())
    assert report["judged_pixels"] > 0.3 * SIZE * SIZE
    assert report["coverage_percent"]["all"] < 0.1 and report["displacement_px"]["p99"] < 0.5


def test_a_film_over_all_of_a_mirror_is_named(before_a_mirror):
    """And not the camera or the objects, which are where they should be."""
    pane(0.0003, 0.0001, clear("transparent", share=0.7))
    parts.select(before_a_mirror)
    assert parts.refusal().startswith("Mirror: A film or tinted pane is so close before this mirror")


def test_what_is_tinted_or_unknown_is_no_clear_glass(blank, room):
    is_colourless = room("addon.reading.materials").is_colourless
    assert is_colourless(clear("glass")) and is_colourless(clear("transparent"))
    textured = clear("transparent")
    textured.node_tree.links.new(textured.node_tree.nodes.new("ShaderNodeTexNoise").outputs["Color"],
                                 textured.node_tree.nodes["Transparent BSDF"].inputs["Color"])
    for other in (clear("glass", (0.2, 0.9, 0.9)), clear("glass", share=0.5), textured, parts.material("Paint"), None):
        assert not is_colourless(other)
