"""Live where lines are drawn: results with the faces that Generate makes, and vertices that follow."""
from __future__ import annotations

import bpy
import parts
from drawn_lines import add_line_art
from live_scene import generated, shape, switched_on


def test_results_of_which_lines_are_drawn_are_kept_right(scene, room):
    """Also from when on they are, and where they are no longer."""
    # its image in the ball of few faces has borders within
    scene.leaf.reflection_mesh.role = "IGNORE"
    floor = parts.add("plane", "Floor", size=14.0)
    floor.reflection_mesh.role = "DIFFUSE"
    plain = generated(floor, scene.ball)
    with switched_on(room) as clock:
        assert clock.updater.following.tracks and shape(scene.result) == plain
        drawn, _ = add_line_art(scene.result)
        parts.select()
        assert "exact" in clock.rest()
        lined = shape(scene.result)
        assert clock.updater.following.tracks and lined != plain
        place = scene.camera.location.copy()
        scene.camera.location.x += 0.05
        done = clock.run(0.1)
        assert "followed" in done and "exact" not in done
        assert len(parts.attribute(scene.result, "position")) == clock.updater.following.tracks[0].images.source.size
        scene.camera.location = place
        clock.rest()
        assert shape(scene.result) == lined == generated(floor, scene.ball)
        clock.rest()
        bpy.data.objects.remove(drawn)
        clock.rest()
        assert shape(scene.result) == plain
