"""A room that the camera looks into from outside, past a wall that it does not see: mirrors show all of the room."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest


def cut_off(room, camera) -> None:
    camera.data.clip_start = 2.5


def turned_over(room, camera) -> None:
    room.data.flip_normals()
    cut_off(room, camera)


def unseen(room, camera) -> None:
    room.visible_camera = False


def indirect(room, camera) -> None:
    branch = bpy.data.collections.new("Indirect")
    bpy.context.scene.collection.children.link(branch)
    branch.objects.link(room)
    bpy.context.scene.collection.objects.unlink(room)
    bpy.context.view_layer.layer_collection.children["Indirect"].indirect_only = True


def instanced(room, camera) -> None:
    unseen(room, camera)
    library = bpy.data.collections.new("Library")
    library.objects.link(room)
    bpy.context.scene.collection.objects.unlink(room)
    placed = bpy.data.objects.new("Placed", None)
    placed.instance_type, placed.instance_collection = "COLLECTION", library
    bpy.context.scene.collection.objects.link(placed)


def area_in_the_picture(result) -> float:
    """Of its faces as the camera, which looks nearly along Y, sees them."""
    places = np.array([vertex.co for vertex in result.data.vertices]) @ np.array(result.matrix_world)[:3, :3].T
    corners = places[np.array([polygon.vertices for polygon in result.data.polygons])][..., [0, 2]]
    along, up = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    return float(0.5 * np.abs(along[:, 0] * up[:, 1] - along[:, 1] * up[:, 0]).sum())


@pytest.mark.parametrize("way", [cut_off, turned_over, unseen, indirect, instanced])
def test_what_a_camera_looks_into_from_outside_is_in_its_mirrors(blank, way):
    """As where Hidden Faces are asked for, which leaves nothing out; its mirror shows it all over."""
    room = parts.add("cube", "Room", size=5.0, location=(0.0, -1.2, 1.2))
    mirror = parts.add("plane", "Mirror", size=2.0, location=(0.0, 1.0, 1.0), rotation=(np.pi / 2, 0.0, 0.0))
    mirror.reflection_mesh.role = "MIRROR"
    way(room, blank.scene.camera)
    blank.view_layer.update()
    areas = []
    for everything in (True, False):
        parts.select(mirror)
        areas.append(area_in_the_picture(parts.generate(hidden_faces=everything, placement="SURFACE")))
        bpy.ops.reflection_mesh.clear()
    assert areas[0] == pytest.approx(4.0, rel=0.01) and areas[1] > 0.99 * areas[0]


def test_a_wall_that_the_camera_no_longer_sees_makes_what_is_behind_it_stale(blank, room):
    """And a wall that it sees again does not: nobody would see a difference. Frames tell the same."""
    outside = parts.add("cube", "Room", size=5.0, location=(0.0, -1.2, 1.2))
    mirror = parts.add("plane", "Mirror", size=2.0, location=(0.0, 1.0, 1.0), rotation=(np.pi / 2, 0.0, 0.0))
    mirror.reflection_mesh.role = "MIRROR"
    blank.scene.camera.location.y = -6.0
    leaf = parts.add("plane", "Leaf", size=0.4, location=(0.4, 0.0, 1.0), rotation=(-np.pi / 2, 0.0, 0.0))
    blank.view_layer.update()
    freshness, chosen = room("addon.freshness"), room("addon.reading").Participants([mirror], [outside, leaf], [])
    parts.select(mirror)
    result = parts.generate(placement="SURFACE")
    seen, few = freshness.frame_origin(bpy.context, chosen, False), area_in_the_picture(result)
    assert freshness.why_stale(bpy.context, result) == ""
    outside.visible_camera = False
    blank.view_layer.update()
    assert freshness.why_stale(bpy.context, result) == "the camera looks through a reflected object now"
    unseen_now = freshness.frame_origin(bpy.context, chosen, False)
    assert freshness.frame_difference(seen, unseen_now) == freshness.why_stale(bpy.context, result)
    assert freshness.frame_difference(unseen_now, seen) == ""
    assert bpy.ops.reflection_mesh.update() == {"FINISHED"} and freshness.why_stale(bpy.context, result) == ""
    assert area_in_the_picture(result) > few + 1.0
    outside.visible_camera = True
    blank.view_layer.update()
    assert freshness.why_stale(bpy.context, result) == ""
