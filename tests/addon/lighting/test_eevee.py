"""What EEVEE shows of a lit reflection, and of light that mirrors throw, against Cycles."""
from __future__ import annotations

import bpy
import caustic_scene
import eevee
import numpy as np
import parts
import pytest
from every_engine import skip_or_fail
from lamp_scenes import principled, scene_of


@pytest.fixture(scope="module", autouse=True)
def rendering():
    if not eevee.is_there():
        skip_or_fail("EEVEE cannot render here: it needs OpenGL.")


def lit_ball(context: bpy.types.Context, shining: bool) -> bpy.types.Object:
    """A ball that shows a floor of tiles, lit, and a box, which may shine far too brightly; its result alone is
    rendered, and returned."""
    scene_of(context)
    # the outline of a lamp that is far brighter than white is noise: each pixel has few samples of it
    bpy.data.objects["Area"].visible_glossy = False
    box, floor, wall = (bpy.data.objects[name] for name in ("Box", "Floor", "Mirror"))
    tiles = principled("Tiles")
    checks = tiles.node_tree.nodes.new("ShaderNodeTexChecker")
    checks.inputs["Scale"].default_value = 24.0
    shader = next(node for node in tiles.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    uv = tiles.node_tree.nodes.new("ShaderNodeUVMap")
    tiles.node_tree.links.new(uv.outputs[0], checks.inputs["Vector"])
    tiles.node_tree.links.new(checks.outputs["Color"], shader.inputs["Base Color"])
    floor.data.materials[0] = tiles
    if shining:
        box.data.materials[0] = caustic_scene.glowing(strength=10.0)
    ball = parts.add("uv_sphere", "Ball", radius=1.2, location=(0.0, 0.0, 0.8), segments=48, ring_count=24)
    ball.data.polygons.foreach_set("use_smooth", np.ones(len(ball.data.polygons), dtype=bool))
    ball.data.materials.append(wall.data.materials[0])
    bpy.data.objects.remove(wall)
    parts.select(box, floor, ball)
    result = parts.generate()
    bpy.ops.reflection_mesh.light(samples=8)
    for obj in context.scene.objects:
        obj.hide_render = obj != result and obj != context.scene.camera
    context.scene.render.film_transparent, context.scene.view_settings.view_transform = True, "Raw"
    return result


@pytest.mark.parametrize("shining, least", [(False, 50.0), (True, 60.0)])
def test_a_lit_ball_looks_as_in_cycles(blank, room, shining, least):
    """By EEVEE's own look-up of the image it is 22 to 29 dB from Cycles. Pixels beside what is brighter than white are
    left out: of its outline each engine has a few samples of its own."""
    lit_ball(blank, shining)
    by_cycles, by_eevee = (eevee.linear(room, one) for one in (False, True))
    inside = (by_cycles[..., 3] > 0.99) & (by_eevee[..., 3] > 0.99)
    bright = np.pad((by_cycles[..., :3].max(axis=2) > 1.0) & inside, 2)
    height, width = inside.shape
    inside &= ~np.logical_or.reduce([bright[y:y + height, x:x + width] for y in range(5) for x in range(5)])
    assert inside.sum() > 500
    error = (np.clip(by_cycles, 0.0, 1.0) - np.clip(by_eevee, 0.0, 1.0))[..., :3][inside]
    assert -10.0 * np.log10((error**2).mean()) > least


def test_caustics_are_as_bright_as_in_cycles(blank, room):
    caustic_scene.scene_of()
    bpy.ops.reflection_mesh.caustics()
    thrown = [obj for obj in blank.scene.objects if obj.reflection_mesh.role == "CAUSTICS"]
    told = []
    for engine in (False, True):
        both = []
        for hidden in (False, True):
            for obj in thrown:
                obj.hide_render = hidden
            both.append(eevee.linear(room, engine)[..., :3])
        told.append(both[0] - both[1])
    by_cycles, by_eevee = told
    assert by_cycles.sum() > 10.0
    assert np.allclose(by_eevee.sum(axis=(0, 1)), by_cycles.sum(axis=(0, 1)), rtol=0.03)


def test_a_preview_is_as_open_as_its_mirror(blank, room):
    """A card that shines, seen straight on in a golden mirror that is half open, alone."""
    wall, gold = scene_of(blank, "", "Tint"), (0.95, 0.7, 0.35)
    next(node for node in wall.data.materials[0].node_tree.nodes
         if node.type == "BSDF_PRINCIPLED").inputs["Alpha"].default_value = 0.5
    card = parts.add("plane", "Card", size=3.0, location=(0.0, -8.0, 1.0), rotation=(-np.pi / 2, 0.0, 0.0))
    card.data.materials.append(parts.material("Card"))
    parts.select(card, wall)
    result = parts.generate(preview=True)
    for obj in blank.scene.objects:
        obj.hide_render = obj != result and obj != blank.scene.camera
    blank.scene.render.film_transparent, blank.scene.view_settings.view_transform = True, "Raw"
    shown = eevee.linear(room, True)[60:68, 44:52].mean(axis=(0, 1))
    assert np.abs(shown - (*(0.5 * np.array(gold)), 0.5)).max() < 0.02
