"""Lamps that rays of mirrors do not meet: Cycles makes no caustics of them, and what is done here."""
from __future__ import annotations

import bpy
import parts
import pytest
from caustic_scene import add_lamp, add_mesh_lamp, inner, light_and_lamp_behind, rendered, scene_of

LARGE = {"POINT": {"shadow_soft_size": 0.3}, "SUN": {"angle": 0.3}, "AREA": {"size": 0.6}}
HIDDEN = "is hidden from glossy rays"


def large_lamp(kind: str) -> tuple:
    floor, mirror, lamp = scene_of("POINT" if kind == "MESH" else kind, **LARGE.get(kind, {}))
    if kind == "MESH":
        bpy.data.objects.remove(lamp)
        lamp = add_mesh_lamp("panel")
    parts.select(floor, lamp, mirror)
    return floor, mirror, lamp


def own_caustics(mirror: bpy.types.Object, lamp: bpy.types.Object, tmp_path) -> float:
    """How much light Cycles finds by itself that the lamp sends to the mirror alone."""
    cycles, linking = bpy.context.scene.cycles, lamp.light_linking
    linking.receiver_collection = bpy.data.collections.new("Mirror alone")
    linking.receiver_collection.objects.link(mirror)
    cycles.diffuse_bounces, mirror.visible_camera = 1, False
    found = []
    for cycles.caustics_reflective in (False, True):
        found.append(rendered(tmp_path, 32).mean())
    bpy.data.collections.remove(linking.receiver_collection)
    return float(found[1] - found[0])


@pytest.mark.thorough
@pytest.mark.parametrize("kind", [*LARGE, "MESH"])
def test_what_is_hidden_from_glossy_rays_throws_nothing_as_in_cycles(blank, room, capfd, tmp_path, kind):
    floor, mirror, lamp = large_lamp(kind)
    assert own_caustics(mirror, lamp, tmp_path) > 1e-4
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT", leave_out=False) == {"FINISHED"}
    stale = room("addon.freshness").why_light_is_stale
    result = bpy.data.objects["Mirror Caustics"]
    assert stale(bpy.context, result) == ""
    lamp.visible_glossy = False
    blank.view_layer.update()
    assert stale(bpy.context, result) == "the lamp has changed"
    assert own_caustics(mirror, lamp, tmp_path) == 0.0
    assert HIDDEN in parts.refusal(bpy.ops.reflection_mesh.caustics)
    other = add_lamp("Other", "POINT", (-0.9, 0.1, 1.8))
    parts.select(floor, lamp, other, mirror)
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    assert HIDDEN in capfd.readouterr().out and "Mirror Caustics Other" in bpy.data.objects


@pytest.mark.parametrize("kind", LARGE)
def test_a_lamp_that_cycles_samples_by_itself_alone_stays_as_it_is(blank, tmp_path, kind):
    """Cycles makes no caustics of it that would be there twice, and shows it in no mirror: it lights that further."""
    floor, mirror, lamp = large_lamp(kind)
    lamp.data.cycles.use_multiple_importance_sampling = False
    assert own_caustics(mirror, lamp, tmp_path) == 0.0
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    assert lamp.light_linking.receiver_collection is None and not lamp.children


def put_away(obj: bpy.types.Object) -> None:
    """Put an object into a collection that renders leave out."""
    store = bpy.data.collections.new("Store")
    bpy.context.scene.collection.children.link(store)
    bpy.context.scene.collection.objects.unlink(obj)
    store.objects.link(obj)
    store.hide_render = True
    bpy.context.view_layer.update()


def test_a_lamp_whose_collection_is_hidden_in_renders_throws_nothing_as_in_cycles(blank, tmp_path):
    """Its light was thrown all the same."""
    floor, mirror, lamp = large_lamp("AREA")
    other = add_lamp("Other", "POINT", (-0.9, 0.1, 1.8))
    put_away(lamp)
    other.hide_render = True
    assert rendered(tmp_path, 1).max() == 0.0
    parts.select(floor, lamp, mirror)
    assert "There is no lamp" in parts.refusal(bpy.ops.reflection_mesh.caustics)
    other.hide_render = False
    parts.select(floor, lamp, other, mirror)
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    made, = (obj for obj in bpy.data.objects if obj.reflection_mesh.role == "CAUSTICS")
    assert made.reflection_mesh.lamp == other


def test_what_renders_leave_out_by_its_collection_hides_no_light(blank, tmp_path):
    """A wall that stands before the lamp."""
    floor, mirror, lamp = scene_of()
    wall = parts.add("plane", "Wall", size=3.0, location=(-0.5, 0.1, 1.6), rotation=(0.0, 1.2, 0.0))
    parts.select(floor, lamp, mirror)
    with pytest.raises(RuntimeError):
        bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT")
    put_away(wall)
    parts.select(floor, lamp, mirror)
    light, expected = light_and_lamp_behind(mirror, lamp, tmp_path)
    seen = inner(light)
    assert seen.sum() > 500 and abs(light[seen].sum() / expected[seen].sum() - 1.0) < 2e-3
