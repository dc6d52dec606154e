"""Scenes in map coordinates: reflections are the same there, but renders are noisy, which is said."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest

TOO_FAR = 2.0**21  # units; single precision has steps of a quarter there
MAP = 2.0**10
SIZE = 64


@pytest.fixture
def rounding(room):
    return room("addon.operators.rounding")


@pytest.fixture
def core(room):
    return room("core")


def scene(offset: float) -> tuple[bpy.types.Object, bpy.types.Object]:
    """A box before a mirror on the ground, and a lamp, all moved along X and Y; the box and the mirror."""
    camera = bpy.context.scene.camera
    camera.location, camera.rotation_euler = (0.5, -6.0, 4.0), (1.0, 0.0, 0.0)
    bpy.context.scene.render.resolution_x = bpy.context.scene.render.resolution_y = SIZE
    box = parts.add("cube", "Box", size=1.0, location=(0.25, 0.5, 0.75), rotation=(0.1, 0.2, 0.3))
    box.data.materials.append(parts.material("Paint", "DIFFUSE"))
    mirror = parts.add("plane", "Mirror", size=4.0)
    mirror.data.materials.append(parts.material("Silver", "GLOSSY"))
    lamp = bpy.data.objects.new("Lamp", bpy.data.lights.new("Lamp", "POINT"))
    lamp.location, lamp.data.energy = (1.0, -1.0, 2.0), 100.0
    bpy.context.scene.collection.objects.link(lamp)
    for obj in (camera, box, mirror, lamp):
        # numbers of single precision at all offsets here
        obj.location = np.array(obj.location) + (offset, offset, 0.0)
    bpy.context.view_layer.update()
    parts.select(box, mirror)
    return box, mirror


def test_spacing_in_pixels_of_a_parallel_view_is_a_power_of_two(rounding, core):
    """Numbers from 2**k on are 2**(k - 23) apart; 64 pixels see 2 units."""
    for k in (3, 10, 15, 16, 22):
        at = np.array((2.0**k, 0.0, 0.0))
        view = core.View.looking_at(at + (0, 0, 2), at, (64, 64), up=(0, 1, 0), orthographic_scale=2.0)
        spacing, pixels = rounding.rounding(view, at + np.array(((0.25, 0.25, 0), (0.5, -0.5, 0), (0.1, 0.2, 0.3))))
        assert spacing == 2.0**(k - 23)
        assert pixels == pytest.approx(2.0**(k - 18), rel=1e-9)


def test_spacing_in_pixels_of_a_perspective_view_falls_with_the_distance(rounding, core):
    """In the middle of the picture, w pixels wide, a pixel covers 2 d tan(f / 2) / w at a distance of d."""
    place = np.array((2.0**20, 0.0, 0.0))
    for distance, field, width in ((1.0, 0.7, 64), (8.0, 0.7, 64), (8.0, 1.2, 1920)):
        view = core.View.looking_at(place - (0.0, distance, 0.0), place, (width, width), field_of_view=field)
        _, pixels = rounding.rounding(view, place[None])
        assert pixels == pytest.approx(0.125 * width / (2.0 * distance * np.tan(0.5 * field)), rel=1e-6)


def test_what_nobody_sees_is_not_rounded(rounding, core):
    view = core.View.looking_at((0, 0, 1), (0, 1, 1), (64, 64), field_of_view=1.0)
    assert rounding.rounding(view, np.zeros((0, 3))) == (0.0, 0.0)
    assert rounding.rounding(view, np.array(((0.0, 0.0, 1.0),))) == (0.0, 0.0)


@pytest.mark.parametrize("offset", [MAP, TOO_FAR])
def test_a_reflection_far_out_is_the_one_at_the_origin(blank, offset):
    """Vertices lie relative to the mirror, and keep all digits of single precision."""
    box, mirror = scene(0.0)
    near = parts.generate(tolerance=0.25)
    places, faces = parts.attribute(near, "position").copy(), len(near.data.polygons)
    for obj in (near, box, mirror, bpy.data.objects["Lamp"]):
        bpy.data.objects.remove(obj)
    scene(offset)
    far = parts.generate(tolerance=0.25)
    bpy.context.view_layer.update()
    assert tuple(far.matrix_world.translation) == (offset, offset, 0.0)
    assert len(far.data.polygons) == faces > 30
    apart = np.abs(parts.attribute(far, "position")[:, None] - places).max(axis=2)
    assert apart.min(axis=0).max() < 2e-6 and apart.min(axis=1).max() < 2e-6


@pytest.mark.thorough
@pytest.mark.parametrize(("offset", "said"), [(0.0, False), (MAP, False), (TOO_FAR, True)])
def test_generate_light_caustics_and_compare_say_that_renders_are_noisy(blank, capfd, tmp_path, offset, said):
    box, mirror = scene(offset)
    sentence = "Blender rounds places so far from the origin to 0.25 units"
    for run in (parts.generate, lambda: bpy.ops.reflection_mesh.light(samples=1),
                lambda: bpy.ops.reflection_mesh.compare(filepath=str(tmp_path), samples=1),
                lambda: (parts.select(box, mirror), bpy.ops.reflection_mesh.caustics())):
        run()
        assert capfd.readouterr().out.count(sentence) == said
