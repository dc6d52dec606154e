"""When reflections have faces that show the world, and what these show where they are not lit."""
from __future__ import annotations

import bpy
import parts
import pytest
from lamp_scenes import picture, psnr, scene_of, shine

WORLD = -1


def ball_under_the_sky(context: bpy.types.Context) -> bpy.types.Object:
    """A ball that mirrors a box that shines and a sky of a gradient; selected with the box."""
    scene_of(context)
    shine(context.scene)
    # what is not lit shows no lamps
    bpy.data.objects["Area"].visible_glossy = False
    for name in ("Mirror", "Floor"):
        bpy.data.objects.remove(bpy.data.objects[name])
    box = bpy.data.objects["Box"]
    box.data.materials[0] = parts.material("Shine")
    ball = parts.add("uv_sphere", "Ball", radius=1.6, segments=48, ring_count=24, location=(0.0, 1.0, 1.0))
    ball.data.shade_smooth()
    ball.data.materials.append(bpy.data.materials["Silver"])
    parts.select(box, ball)
    return ball


def shows_world(result: bpy.types.Object) -> bool:
    return bool((parts.attribute(result, "source_object") == WORLD).any())


@pytest.mark.parametrize(("wanted", "generated", "lit"), [
    ("NEVER", False, False), ("LIT", False, True), ("ALWAYS", True, True)])
def test_they_are_added_when_the_setting_says_so(blank, wanted, generated, lit):
    ball_under_the_sky(blank)
    result = parts.generate(world_faces=wanted)
    assert shows_world(result) == generated
    bpy.ops.reflection_mesh.light(samples=1)
    assert shows_world(result) == lit
    # generated again, they come once
    faces = len(parts.generate(world_faces=wanted).data.polygons)
    assert len(parts.generate(world_faces=wanted).data.polygons) == faces


@pytest.mark.parametrize("preview", [False, True])
def test_without_light_they_show_the_world_by_its_own_shader(blank, room, preview):
    ball = ball_under_the_sky(blank)
    reference = picture(room)
    before = set(bpy.data.materials)
    parts.generate(world_faces="ALWAYS", preview=preview)
    ball.hide_render = True
    # measured: 56.6 dB
    assert psnr(picture(room), reference) > 54.0
    ball.hide_render = False
    bpy.ops.reflection_mesh.clear()
    assert set(bpy.data.materials) == before
