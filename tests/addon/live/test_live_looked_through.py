"""Live where the camera looks past a wall that it does not see: what is behind it is kept right while it moves."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from live_scene import generated, moved, shape, switched_on

PLACEMENTS = ("LAYERED", "SURFACE", "VIRTUAL")


@pytest.fixture(params=PLACEMENTS)
def house(blank, request):
    """A camera outside of a house, in which a mirror and a leaf hang; the house, all three, and the mirror's result."""
    house = parts.add("cube", "House", size=5.0, location=(0.0, -1.2, 1.2))
    mirror = parts.add("plane", "Mirror", size=2.0, location=(0.0, 1.0, 1.0), rotation=(np.pi / 2, 0.0, 0.0))
    mirror.reflection_mesh.role, house.reflection_mesh.role = "MIRROR", "DIFFUSE"
    blank.scene.reflection_mesh.placement = request.param
    # a wall that the camera sees would hide what lies behind the mirror
    house.visible_camera = request.param != "VIRTUAL"
    leaf = parts.add("plane", "Leaf", size=0.4, location=(0.4, 0.0, 1.0), rotation=(-np.pi / 2, 0.0, 0.0))
    leaf.reflection_mesh.role = "DIFFUSE"
    blank.view_layer.update()
    parts.select(leaf, house, mirror)
    result = parts.generate()
    parts.select()
    return house, (leaf, house, mirror), result


def picture_area(result: bpy.types.Object, eye) -> float:
    """The solid angle, nearly, that the faces of a result take as seen by the eye."""
    places = np.array([result.matrix_world @ vertex.co for vertex in result.data.vertices]) - eye
    corners = (places / np.linalg.norm(places, axis=1, keepdims=True))[parts.corners(result)]
    return float(0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]),
                                      axis=1).sum())


@pytest.mark.thorough
def test_a_wall_that_is_taken_away_for_the_camera_moves(house, room):
    """What Live shows at rest is what Generate makes, to the last bit, and the mirror is full of it."""
    wall, everything, result = house
    eye = np.array(bpy.context.scene.camera.location)
    with switched_on(room) as clock:
        few = picture_area(result, eye)
        if wall.visible_camera:
            wall.visible_camera = False
            assert clock.rest()[-1] == "exact"
            assert picture_area(result, eye) > few + 0.01
        through = picture_area(result, eye)
        assert shape(result) == generated(*everything)
        clock.rest()
        for by in ((0.0, 0.2, 0.1), (0.1, 0.0, 0.0)):
            before = shape(result)
            moved(wall, by)
            done = clock.rest()
            assert done and done[-1] == "exact" and shape(result) != before
            assert shape(result) == generated(*everything)
            assert picture_area(result, eye) == pytest.approx(through, rel=0.02)
            clock.rest()


@pytest.mark.thorough
def test_a_wall_that_the_camera_does_not_see_comes_before_a_mirror_and_goes(house, room):
    """It is looked through only where the mirror is within it."""
    wall, everything, result = house
    eye = np.array(bpy.context.scene.camera.location)
    wall.visible_camera = False
    wall.location.y -= 30.0
    with switched_on(room) as clock:
        clock.rest()
        away = shape(result)
        for by in (30.0, -30.0, 30.0):
            moved(wall, (0.0, by, 0.0))
            assert "exact" in clock.rest()
            assert (shape(result) == away) == (by < 0.0)
            assert shape(result) == generated(*everything)
            clock.rest()
        assert picture_area(result, eye) > 0.05
