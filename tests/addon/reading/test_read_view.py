"""Cameras against Blender's own picture positions, for every lens setting that a picture can have."""
import itertools

import bpy
import numpy as np
import pytest
from bpy_extras.object_utils import world_to_camera_view
from mathutils import Vector

POINTS = np.random.default_rng(7).uniform((-2.0, 2.0, -2.0), (2.0, 9.0, 3.0), (40, 3))


def expected_pixels(scene: bpy.types.Scene) -> np.ndarray:
    scene.view_layers[0].update()
    scale = scene.render.resolution_percentage / 100.0
    size = int(scene.render.resolution_x * scale), int(scene.render.resolution_y * scale)
    return np.array([world_to_camera_view(scene, scene.camera, Vector(point))[:2] for point in POINTS]) * size


@pytest.mark.parametrize(("kind", "fit", "size", "aspect"), list(itertools.product(
    ("PERSP", "ORTHO"), ("AUTO", "HORIZONTAL", "VERTICAL"), ((320, 200), (200, 320)), ((1.0, 1.0), (1.0, 1.5)))))
def test_points_land_where_blender_puts_them(blank, room, kind, fit, size, aspect):
    scene = blank.scene
    camera = scene.camera.data
    camera.type, camera.sensor_fit = kind, fit
    camera.lens, camera.ortho_scale = 31.0, 7.5
    camera.sensor_width, camera.sensor_height = 33.0, 21.0
    camera.shift_x, camera.shift_y = 0.13, -0.21
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.render.resolution_percentage = 50
    scene.render.pixel_aspect_x, scene.render.pixel_aspect_y = aspect
    scene.camera.rotation_euler = 1.4, 0.2, -0.1
    view = room("addon.reading.read_view").read_view(blank)
    assert view.resolution == (size[0] // 2, size[1] // 2)
    assert view.orthographic == (kind == "ORTHO")
    assert np.abs(view.pixels(POINTS) - expected_pixels(scene)).max() < 2e-3


def test_the_cameras_scale_takes_no_part(blank, room):
    blank.scene.camera.scale = 3.0, 3.0, 0.5
    blank.view_layer.update()
    placement = room("addon.reading.read_view").read_view(blank).camera_to_world
    assert np.allclose(placement[:3, :3].T @ placement[:3, :3], np.eye(3), atol=1e-6)
    assert np.allclose(placement[:3, 3], (0.0, -6.0, 1.0))
    assert np.allclose(placement[:3, 2], (0.0, -np.sin(1.45), np.cos(1.45)), atol=1e-6)


def test_an_animated_lens_is_that_of_the_frame(blank, room):
    camera = blank.scene.camera.data
    for frame, lens in ((1, 20.0), (11, 40.0)):
        camera.lens = lens
        camera.keyframe_insert("lens", frame=frame)
    widths = []
    for frame in (1, 11):
        blank.scene.frame_set(frame)
        widths.append(room("addon.reading.read_view").read_view(blank).projection[0, 0])
    assert np.isclose(widths[1] / widths[0], 2.0, rtol=1e-6)


def test_the_percentage_is_taken_in_whole_numbers(blank, room):
    """57 % of 100 pixels are 57; in floating point they are 56.99..., which would lose one."""
    render = blank.scene.render
    render.resolution_x, render.resolution_y, render.resolution_percentage = 100, 201, 57
    assert room("addon.reading.read_view").read_view(blank).resolution == (57, 114)
