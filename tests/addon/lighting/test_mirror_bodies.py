"""What lies under the foot of a mirror, or within it, is dark, and no mirror shows it: light on the objects is as if it
were not there."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from lamp_scenes import picture, psnr, scene_of

RADIUS, FLOOR = 0.8, -0.6


def light(samples: int = 64) -> None:
    assert bpy.ops.reflection_mesh.light(samples=samples, kind="OBJECTS", every=True) == {"FINISHED"}


def standing(context: bpy.types.Context, caps: str = "NGON", sunk: float = 0.0) -> bpy.types.Object:
    """A tube that mirrors the floor on which it stands, with normals as of a bell: its foot shows what is close to it,
    and that large; the floor has a pattern."""
    wall = scene_of(context)
    silver = wall.data.materials[0]
    for obj in (wall, bpy.data.objects["Box"]):
        bpy.data.objects.remove(obj)
    tube = parts.add("cylinder", "Tube", vertices=64, radius=RADIUS, depth=2.4, end_fill_type=caps,
                     location=(0.0, -1.0, FLOOR + 1.2 - sunk))
    tube.data.shade_smooth()
    tube.data.materials.append(silver)
    context.scene.camera.location.z, context.scene.camera.rotation_euler.x = 1.6, 1.25
    context.view_layer.update()
    parts.select(bpy.data.objects["Floor"], tube)
    return tube


def bodies_of(context: bpy.types.Context, room, result: bpy.types.Object):
    return room("addon.baking.mirror_bodies").mirror_bodies(context, [result], room("addon.reading").read_view(context))


@pytest.mark.slow
def test_a_floor_is_as_bright_as_it_is_up_to_the_foot_of_what_stands_on_it(blank, room):
    """Against Cycles: in 8 pixels that show half a texel of the floor there was the dark under the foot."""
    standing(blank)
    reference, other = picture(room), picture(room, seed=7)
    parts.generate()
    light()
    assert psnr(picture(room), reference) > psnr(other, reference) - 3.0


@pytest.mark.parametrize("sunk", [0.0, 0.1])
@pytest.mark.parametrize("caps", ["NGON", "NOTHING"])
def test_what_is_hidden_is_what_lies_within(blank, room, caps, sunk):
    """Against the radius of a tube, on the floor and on its back; into an open one one may look, as long as it ends
    above the floor."""
    standing(blank, caps, sunk)
    bodies = bodies_of(blank, room, parts.generate(tolerance=4.0))
    rng = np.random.default_rng(3)
    places = np.column_stack((rng.uniform(-2.0, 2.0, (2000, 2)) + (0.0, -1.0), np.full(2000, FLOOR)))
    away = np.linalg.norm(places[:, :2] - (0.0, -1.0), axis=1)
    # its sides are those of a polygon
    places, away = (one[(away < 0.998 * RADIUS) | (away > RADIUS)] for one in (places, away))
    above = bodies.hide(places, np.tile((0.0, 0.0, 1.0), (len(places), 1)))
    assert (above == ((away < RADIUS) & (caps == "NGON"))).all() and above.any() == (caps == "NGON")
    below = bodies.hide(places, np.tile((0.0, 0.0, -1.0), (len(places), 1)))
    assert (below == ((away < RADIUS) & (caps == "NGON") & (sunk > 0.0))).all()


def test_what_a_mirror_shows_is_not_hidden_however_close(blank, room):
    """The underside of a thing just above a mirror on the floor, a floor beside a ball's foot, and all that stands in a
    room of mirrors together with the camera."""
    wall = scene_of(blank)
    silver, box = wall.data.materials[0], bpy.data.objects["Box"]
    bpy.data.objects.remove(wall)
    ground = parts.add("plane", "Ground", size=8.0, location=(0.0, 0.0, FLOOR))
    ball = parts.add("uv_sphere", "Ball", segments=64, ring_count=32, radius=1.0, location=(0.0, 0.0, FLOOR + 1.0))
    hall = parts.add("cube", "Hall", size=30.0)
    up = np.array((0.0, 0.0, 1.0))
    rng = np.random.default_rng(5)
    around = np.column_stack((rng.uniform(-1.5, 1.5, (500, 2)), np.full(500, FLOOR)))
    around = around[np.linalg.norm(around[:, :2], axis=1) > 0.1]
    mirrors = {ground: (around + (0.0, 0.0, 0.01), -up), ball: (around, up), hall: (around, up)}
    for obj, (places, normal) in mirrors.items():
        obj.data.materials.append(silver)
        for other in mirrors:
            other.hide_render = other != obj
            other.hide_set(other != obj)
        blank.view_layer.update()
        parts.select(box, obj)
        bodies = bodies_of(blank, room, parts.generate(tolerance=4.0))
        assert len(bodies.tree) and not bodies.hide(places, np.tile(normal, (len(places), 1))).any()
        bpy.ops.reflection_mesh.clear()


def test_texels_tell_how_much_of_them_is_shown(blank, room):
    """Against the area of a circle; those whose middles are hidden count as whole."""
    standing(blank)
    bodies = bodies_of(blank, room, parts.generate(tolerance=4.0))
    corners = np.array((((-1.0, -2.0, FLOOR), (1.0, -2.0, FLOOR), (-1.0, 0.0, FLOOR)),
                        ((1.0, 0.0, FLOOR), (-1.0, 0.0, FLOOR), (1.0, -2.0, FLOOR))))
    spots = 8.0 + 24.0 * (corners[..., :2] + (1.0, 2.0)) + 0.01
    shown = room("addon.baking.shown_texels").shown_texels(bodies, corners, spots, np.array((64, 72)), False)
    hidden = (1.0 - shown).sum() / 24.0**2
    assert hidden == pytest.approx(np.pi * RADIUS**2, rel=0.02)
    assert ((shown > 0.0) & (shown < 1.0)).any() and (shown[:8] == 1.0).all()
    assert room("addon.baking.shown_texels").shown_texels(bodies, corners + (5.0, 0.0, 0.0), spots, np.array((64, 72)),
                                                          False) is None
