"""Lamps that the user has linked: what is told of Cycles' own caustics is so."""
from __future__ import annotations

import bpy
import pytest
from caustic_scene import paint, rendered, scene_of

TOLD = "whose light is linked already"


def link(lamp: bpy.types.Object, *entries) -> None:
    """Let a lamp's light be linked to objects, or to collections of one object, each as it is told."""
    linked = bpy.data.collections.new("Linked")
    lamp.light_linking.receiver_collection = linked
    for obj, state, nested in entries:
        if not nested:
            linked.objects.link(obj)
            linked.collection_objects[-1].light_linking.link_state = state
            continue
        inner = bpy.data.collections.new("Inner")
        inner.objects.link(obj)
        linked.children.link(inner)
        linked.collection_children[-1].light_linking.link_state = state


def is_lit(mirror: bpy.types.Object, tmp_path) -> bool:
    """Whether Cycles shows the lamp's light on the mirror, painted white."""
    metal = mirror.data.materials[0]
    mirror.data.materials[0] = paint("White", "DIFFUSE", (1.0, 1.0, 1.0))
    camera = bpy.context.scene.camera
    camera.location, camera.rotation_euler = (-2.0, 0.0, 0.7), (1.5708, 0.0, -1.5708)
    camera.data.ortho_scale = 0.4
    seen = rendered(tmp_path).mean()
    mirror.data.materials[0] = metal
    return seen > 1e-3


@pytest.mark.thorough
@pytest.mark.parametrize("wanted", [
    (), (("Mirror", "EXCLUDE", False),), (("Mirror", "INCLUDE", False),), (("Floor", "INCLUDE", False),),
    (("Floor", "EXCLUDE", False),), (("Mirror", "EXCLUDE", True),), (("Mirror", "INCLUDE", True),),
    (("Floor", "INCLUDE", True),), (("Mirror", "INCLUDE", True), ("Mirror", "EXCLUDE", False)),
    (("Mirror", "INCLUDE", False), ("Mirror", "EXCLUDE", True)),
    (("Mirror", "INCLUDE", True), ("Mirror", "EXCLUDE", True)),
    (("Mirror", "EXCLUDE", True), ("Mirror", "INCLUDE", True))], ids=str)
def test_who_has_taken_the_mirror_out_is_not_asked_to(blank, tmp_path, capfd, wanted):
    """Cycles' own caustics are told of where the lamp lights the mirror, and only there."""
    floor, mirror, lamp = scene_of(shadow_soft_size=0.1)
    blank.scene.cycles.max_bounces = 0
    link(lamp, *((bpy.data.objects[name], state, nested) for name, state, nested in wanted))
    linked = lamp.light_linking.receiver_collection
    before = bpy.data.collections[:], bpy.data.objects[:]
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    told = TOLD in capfd.readouterr().out
    bpy.data.objects["Mirror Caustics"].hide_render = True
    assert told == is_lit(mirror, tmp_path)
    bpy.ops.reflection_mesh.clear()
    assert lamp.light_linking.receiver_collection == linked and (bpy.data.collections[:], bpy.data.objects[:]) == before
