"""Mattes: a pass tells how much of each pixel a reflection fills with one object, as Cycles tells it of the mirror."""
from __future__ import annotations

import bpy
import eevee
import numpy as np
import parts
import pytest
from every_engine import skip_or_fail
from lamp_scenes import principled, scene_of
from render_passes import rendered_passes

SAMPLES = 64


@pytest.fixture
def box(blank) -> bpy.types.Object:
    """Seen in the mirror alone, beside a ball that hides a part of it there; the scene is 96 pixels wide."""
    scene_of(blank)
    box = bpy.data.objects["Box"]
    ball = parts.add("uv_sphere", "Ball.001", radius=0.35, location=(0.4, -1.9, 0.8))
    ball.data.materials.append(principled("Paint", (0.1, 0.6, 0.2)))
    for obj in (box, ball):
        obj.visible_camera = False
    parts.select(box, ball, bpy.data.objects["Floor"], bpy.data.objects["Mirror"])
    return box


def emission(strength: float) -> bpy.types.Material:
    made = parts.material("Code")
    made.node_tree.nodes["Emission"].inputs["Color"].default_value = (strength,) * 3 + (1.0,)
    return made


def truth(path, shown: bpy.types.Object) -> np.ndarray:
    """Render by Cycles a scene of perfect mirrors in which `shown` alone emits light. Restore the file afterwards."""
    scene = bpy.context.scene
    meshes = [obj for obj in scene.objects if obj.type == "MESH" and obj.reflection_mesh.role != "REFLECTION"]
    before = [(obj, list(obj.data.materials)) for obj in meshes]
    lamps = [obj for obj in scene.objects if obj.type == "LIGHT" or obj.reflection_mesh.role == "REFLECTION"]
    codes = emission(0.0), emission(1.0)
    white = parts.material("White", "GLOSSY")
    white.node_tree.nodes["Glossy BSDF"].inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    world, scene.world = scene.world, None
    for obj in meshes:
        obj.data.materials.clear()
        obj.data.materials.append(white if obj.name == "Mirror" else codes[obj == shown])
    for obj in lamps:
        obj.hide_render = True
    found = rendered_passes(path, samples=4 * SAMPLES)["ViewLayer.Combined.R"]
    scene.world = world
    for obj, materials in before:
        obj.data.materials.clear()
        for material in materials:
            obj.data.materials.append(material)
    for obj in lamps:
        obj.hide_render = False
    return found


def matte(path, name: str, engine: str = "CYCLES") -> np.ndarray:
    return rendered_passes(path, engine, SAMPLES)[f"ViewLayer.{name}.X"]


def assert_same(found: np.ndarray, right: np.ndarray, wider: float = 0.0) -> None:
    """Equal but for noise and a fraction of a pixel at outlines, which discs may be `wider` by, in pixels."""
    outline = float(((right > 0.1) & (right < 0.9)).sum())
    assert right.sum() > 50.0 and outline > 20
    assert abs((found - right).sum()) < (0.005 + wider) * outline
    assert np.abs(found - right).sum() < (0.04 + wider) * outline and np.abs(found - right).max() < 0.1 + wider


@pytest.mark.parametrize("kind", ["preview", "lit"])
def test_a_matte_is_what_the_mirror_shows_of_the_object(box, tmp_path, kind):
    right = truth(tmp_path / "truth.exr", box)
    box.reflection_mesh.matte = True
    result = parts.generate(preview=kind == "preview")
    if kind != "preview":
        parts.select(result)
        assert bpy.ops.reflection_mesh.light(samples=4) == {"FINISHED"}
    assert_same(matte(tmp_path / "matte.exr", "Matte Box"), right)


def test_each_object_has_its_own_whenever_it_is_asked_for(box, tmp_path):
    """After the making, for a second object, of a name with a dot; with none left nothing of it stays."""
    ball, layer = bpy.data.objects["Ball.001"], bpy.context.view_layer
    right = [truth(tmp_path / "truth.exr", obj) for obj in (box, ball)]
    used = [material for obj in bpy.data.objects if obj.type == "MESH" for material in obj.data.materials]
    before = {material: len(material.node_tree.nodes) for material in used}
    result = parts.generate()
    box.reflection_mesh.matte = True
    ball.reflection_mesh.matte = True
    assert {aov.name for aov in layer.aovs} == {"Matte Box", "Matte Ball_001"}
    found = rendered_passes(tmp_path / "mattes.exr", samples=SAMPLES)
    for name, wanted in zip(("Box", "Ball_001"), right):
        assert_same(found[f"ViewLayer.Matte {name}.X"], wanted)
    # the user's materials are as they were
    assert {material: len(material.node_tree.nodes) for material in used} == before
    box.reflection_mesh.matte = False
    assert [aov.name for aov in layer.aovs] == ["Matte Ball_001"]
    # what is generated and lit again keeps it
    parts.select(result)
    parts.generate()
    bpy.ops.reflection_mesh.light(samples=1)
    assert_same(matte(tmp_path / "again.exr", "Matte Ball_001"), right[1])
    own = layer.aovs.add()
    own.name, own.type = "Matte of mine", "VALUE"
    bpy.ops.reflection_mesh.clear()
    assert [aov.name for aov in layer.aovs] == ["Matte of mine"] and not bpy.context.scene.reflection_mesh.mattes


@pytest.mark.slow
def test_points_have_mattes(box, tmp_path):
    for obj in (box, bpy.data.objects["Ball.001"], bpy.data.objects["Floor"]):
        fine = obj.modifiers.new("Fine", "SUBSURF")
        fine.subdivision_type, fine.levels, fine.render_levels = "SIMPLE", 6, 6
    right = truth(tmp_path / "truth.exr", box)
    box.reflection_mesh.matte = True
    parts.generate(method="POINTS", preview=True)
    assert_same(matte(tmp_path / "matte.exr", "Matte Box"), right, 0.8)


@pytest.mark.slow
def test_eevee_puts_them_out_as_well(box, tmp_path):
    if not eevee.is_there():
        skip_or_fail("EEVEE cannot render here: it needs OpenGL.")
    right = truth(tmp_path / "truth.exr", box)
    box.reflection_mesh.matte = True
    parts.generate(preview=True)
    bpy.context.scene.eevee.taa_render_samples = SAMPLES
    assert_same(matte(tmp_path / "matte.exr", "Matte Box", eevee.engine()), right)


def test_a_result_without_the_numbers_of_objects_says_so(box, capfd):
    box.reflection_mesh.matte = True
    parts.generate(attributes="SHOWN")
    assert "'Mirror Reflection' has no mattes, because Attributes is Shown." in capfd.readouterr().out
    assert not len(bpy.context.view_layer.aovs)
