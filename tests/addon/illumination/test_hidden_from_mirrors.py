"""Light falls on what is hidden from glossy rays too: mirrors do not show it, and in Cycles their light lights it."""
from __future__ import annotations

import bpy
import parts
import pytest
from caustic_scene import inner, light_and_lamp_behind, rendered, scene_of


def instanced(floor: bpy.types.Object) -> bpy.types.Object:
    """The floor put into a collection that is shown as an instance alone."""
    store = bpy.data.collections.new("Store")
    bpy.context.scene.collection.objects.unlink(floor)
    store.objects.link(floor)
    instance = bpy.data.objects.new("Instance", None)
    instance.instance_type, instance.instance_collection = "COLLECTION", store
    bpy.context.scene.collection.objects.link(instance)
    return instance


def test_cycles_lights_it(blank, tmp_path):
    """What is done here is what Cycles' own caustics do."""
    floor, mirror, lamp = scene_of("POINT", shadow_soft_size=0.3)
    lamp.light_linking.receiver_collection = bpy.data.collections.new("Mirror alone")
    lamp.light_linking.receiver_collection.objects.link(mirror)
    mirror.visible_camera, found = False, []
    for floor.visible_glossy in (True, False):
        found.append(rendered(tmp_path, 16).mean())
    assert found[0] > 1e-3 and found[1] == pytest.approx(found[0], rel=1e-6)


@pytest.mark.thorough
@pytest.mark.parametrize("kind", ["object", "instance", "mirror alone"])
def test_it_is_lit_as_by_the_lamp_mirrored(blank, room, capfd, tmp_path, kind):
    """It was left out: where it was alone, with an error."""
    floor, mirror, lamp = scene_of()
    floor.visible_glossy = False
    lit = instanced(floor) if kind == "instance" else floor
    parts.select(*([] if kind == "mirror alone" else [lit]), lamp, mirror)
    light, expected = light_and_lamp_behind(mirror, lamp, tmp_path)
    seen = inner(light)
    assert seen.sum() > 500 and abs(light[seen].sum() / expected[seen].sum() - 1.0) < 2e-3
    assert "hidden" not in capfd.readouterr().out
    result = bpy.data.objects["Mirror Caustics"]
    assert [source.object for source in result.reflection_mesh.sources] == [lit]


def test_it_is_followed(blank, room):
    """By the panel, which tells that it has moved, and by Live."""
    floor, mirror, lamp = scene_of()
    floor.visible_glossy = False
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    stale, result = room("addon.freshness").why_light_is_stale, bpy.data.objects["Mirror Caustics"]
    assert stale(bpy.context, result) == ""
    group, = room("addon.live.thrown").light_groups(bpy.context)
    assert group.chosen.diffuse == [floor]
    floor.location.z -= 0.2
    blank.view_layer.update()
    assert stale(bpy.context, result) == "what is lit has changed"
    floor.visible_glossy = True
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    floor.visible_glossy = False  # which changes nothing of its light
    blank.view_layer.update()
    assert stale(bpy.context, result) == ""
