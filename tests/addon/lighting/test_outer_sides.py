"""Light that stays with the objects, on closed ones whose normals point inward, all of them or some shells."""
from __future__ import annotations

import bpy
import parts
import pytest
from lamp_scenes import picture, principled, psnr, scene_of


def _ring(turned: bool) -> bpy.types.Object:
    ring = parts.add("torus", "Ring", major_radius=0.6, minor_radius=0.15, location=(1.4, -1.2, 1.0),
                     rotation=(1.3, 0.2, 0.5))
    ring.data.shade_smooth()
    if turned:
        ring.data.flip_normals()
    return ring


def _what(kind: str) -> bpy.types.Object:
    if kind == "curve":
        bpy.ops.curve.primitive_bezier_circle_add(radius=0.6, location=(1.4, -1.2, 1.0), rotation=(1.3, 0.2, 0.5))
        bpy.context.object.data.bevel_depth = 0.15
        return bpy.context.object
    ring = _ring(True)
    if kind == "two shells":
        cube = parts.add("cube", "Cube", size=0.5, location=(0.9, -1.0, 0.4))
        parts.select(cube, ring)
        bpy.ops.object.join()
    return ring


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["turned", "two shells", "curve"])
def test_the_outside_is_lit(blank, room, kind):
    scene_of(blank)
    bpy.data.objects.remove(bpy.data.objects["Box"])
    shown = _what(kind)
    shown.data.materials.append(principled("Pale", (0.8, 0.9, 0.95)))
    parts.select(shown, bpy.data.objects["Floor"], bpy.data.objects["Mirror"])
    reference, other = picture(room), picture(room, seed=7)
    parts.generate()
    bpy.ops.reflection_mesh.light(samples=64)
    assert psnr(picture(room), reference) > psnr(other, reference)


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["room", "block"])
def test_what_is_looked_at_from_within_shows_its_inside(blank, room, kind):
    """Walls around mirror and camera, their normals inward, as rooms have them, or outward."""
    scene_of(blank)
    walls = parts.add("cube", "Walls", size=14.0, location=(0.0, -2.0, 2.0))
    if kind == "room":
        walls.data.flip_normals()
    walls.data.materials.append(principled("Wall", (0.7, 0.6, 0.5)))
    parts.select(walls, *(bpy.data.objects[name] for name in ("Box", "Floor", "Mirror")))
    reference, other = picture(room), picture(room, seed=7)
    parts.generate()
    bpy.ops.reflection_mesh.light(samples=64)
    assert psnr(picture(room), reference) > psnr(other, reference)
