"""Live and results that are lit: their light stays on what is shown from elsewhere too."""
from __future__ import annotations

import bpy
import parts
from lamp_scenes import outdated, scene_of
from live_scene import switched_on


def test_light_stays_while_the_camera_moves(blank, room):
    scene_of(blank)
    result = parts.generate(tolerance=8.0)
    blank.scene.reflection_mesh.tolerance = 8.0
    bpy.ops.reflection_mesh.light(samples=1)
    light = result.reflection_mesh.light_material

    def shown() -> bool:
        return {slot.material == light for slot in result.material_slots} == {True}
    with switched_on(room) as clock:
        clock.rest()
        assert shown()
        before = blank.scene.camera.location.x
        blank.scene.camera.location.x = before + 0.4
        clock.rest()
        assert shown() and outdated(room, result)
        blank.scene.camera.location.x = before
        clock.rest()
        assert shown() and not outdated(room, result)
