"""Live and results that are lit: their light goes while it does not fit, and is there again when it fits."""
from __future__ import annotations

import bpy
import parts
import pytest
from lamp_scenes import outdated, scene_of
from live_scene import switched_on


@pytest.mark.thorough
@pytest.mark.parametrize("kind", ["PICTURE", "OBJECTS"])
def test_light_comes_back_where_the_camera_comes_back(blank, room, kind):
    scene_of(blank)
    result = parts.generate(tolerance=8.0)
    blank.scene.reflection_mesh.tolerance = 8.0
    bpy.ops.reflection_mesh.light(samples=1, kind=kind)
    light = result.reflection_mesh.light_material

    def shown() -> bool:
        return {slot.material == light for slot in result.material_slots} == {True}
    with switched_on(room) as clock:
        clock.rest()
        assert shown()
        before = blank.scene.camera.location.x
        blank.scene.camera.location.x = before + 0.4
        clock.rest()
        assert shown() == (kind == "OBJECTS")
        blank.scene.camera.location.x = before
        clock.rest()
        assert shown() and not outdated(room, result)
