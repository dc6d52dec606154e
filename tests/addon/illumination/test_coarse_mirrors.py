"""A coarse mirror that is shaded smooth throws less than Cycles, which bends its normals (docs/caustics.md): told."""
from __future__ import annotations

import bpy
import parts
import pytest
from caustic_scene import paint, scene_of


@pytest.mark.parametrize("faces, smooth, told", [((24, 8), True, True), ((24, 8), False, False),
                                                 ((48, 16), True, False)], ids=str)
def test_it_is_told_where_cycles_throws_much_more(blank, capfd, faces, smooth, told):
    floor, mirror, lamp = scene_of()
    bpy.data.objects.remove(mirror)
    ring = parts.add("torus", "Ring", major_segments=faces[0], minor_segments=faces[1], location=(0.0, 0.0, 0.4))
    ring.data.polygons.foreach_set("use_smooth", [smooth] * len(ring.data.polygons))
    ring.data.materials.append(paint("Metal", "GLOSSY", (1.0, 1.0, 1.0)))
    parts.select(floor, lamp, ring)
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    assert ("The mirror 'Ring' is coarse" in capfd.readouterr().out) == told
