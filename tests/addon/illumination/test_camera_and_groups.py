"""Light follows what it falls on where the camera does not see that, and its lamp into groups of lights."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from caustic_scene import paint, rendered, scene_of


@pytest.mark.thorough
def test_light_on_what_the_camera_does_not_see_is_not_seen_either(blank, room, tmp_path):
    """Only light on the floor, in the shadow of the box, is left; it is shown by mirrors all the same."""
    floor, mirror, lamp = scene_of("AREA", size=0.02)
    blank.scene.cycles.max_bounces = 2
    box = parts.add("cube", "Box", size=0.4, location=(0.3, 0.0, 0.2))
    box.data.materials.append(paint("Wood", "DIFFUSE", (0.5, 0.5, 0.5)))
    box.visible_camera = mirror.visible_camera = False
    dark = rendered(tmp_path, 64)
    parts.select(floor, box, lamp, mirror)
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    light = rendered(tmp_path, 64) - dark
    made = bpy.data.objects["Mirror Caustics"]
    on_box = parts.attribute(made, "lit_unseen") > 0.5
    sources = [source.object for source in made.reflection_mesh.sources]
    assert np.array_equal(on_box, parts.attribute(made, "source_object") == sources.index(box)) and on_box.any()
    # the floor alone, which the box shades
    parts.select(floor, lamp, mirror)
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    expected = rendered(tmp_path, 64) - dark
    assert np.abs(light - expected).max() < 0.02 * expected.max()
    assert "lit_unseen" not in bpy.data.objects["Mirror Caustics"].data.attributes
    stale = room("addon.freshness").why_light_is_stale
    assert not stale(blank, made)
    floor.visible_camera = False
    assert "what is lit has changed" in stale(blank, made)
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    assert not stale(blank, made) and np.abs(rendered(tmp_path)).max() == 0.0
    # a second mirror shows it to the camera
    shown = parts.add("plane", "Other", size=3.0, location=(0.0, 0.0, 3.0), rotation=(np.pi, 0.0, 0.0))
    shown.data.materials.append(paint("Chrome", "GLOSSY", (1.0, 1.0, 1.0)))
    blank.scene.camera.location.z, blank.scene.camera.rotation_euler.x = 1.0, np.pi
    assert rendered(tmp_path).max() > 0.1


def test_light_is_in_the_group_of_its_lamp(blank):
    floor, mirror, lamp = scene_of()
    blank.view_layer.lightgroups.add(name="Key")
    for group in ("Key", ""):
        lamp.lightgroup = group
        assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
        assert bpy.data.objects["Mirror Caustics"].lightgroup == group
