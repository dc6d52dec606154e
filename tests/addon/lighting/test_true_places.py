"""Where light on the objects shows what shines in a pattern: where a flat mirror has it, and not only as near as the
result's tolerance is."""
from __future__ import annotations

import bpy
import numpy as np
import parts
from lamp_scenes import scene_of
from test_density import checked_card

WRONG = 0.12  # pixels: a tenth, and what the picture's own perspective does to so short an edge


def off_by(room, result, mirror) -> np.ndarray:
    """How far, in pixels, the middle of each side of a result's faces shows its place from where the mirror has it."""
    reading = room("addon.reading")
    view, corners = reading.read_view(bpy.context), reading.corner_vertices(result.data)
    shown, own = (reading.vectors(result.data, name)[corners] for name in ("reflected_position", "position"))
    own = own + np.array(result.matrix_world.translation)
    to_world, face = mirror.matrix_world, mirror.data.polygons[0]
    place, normal = np.array(to_world @ face.center), np.array((to_world.to_3x3() @ face.normal).normalized())
    middle, seen = ((0.5 * (places + np.roll(places, -1, axis=1))).reshape(-1, 3) for places in (shown, own))
    image = middle - 2.0 * ((middle - place) @ normal)[:, None] * normal
    return np.linalg.norm(view.pixels(image) - view.pixels(seen), axis=1)


def test_it_lies_where_a_flat_mirror_shows_it(blank, room):
    """By the law of reflection, at the middle of every edge; as generated, half a pixel is allowed."""
    mirror = scene_of(blank)
    checked_card(6.0, 30)
    result = parts.generate()
    before = off_by(room, result, mirror)
    assert before.max() > 2.0 * WRONG
    bpy.ops.reflection_mesh.light(samples=1, kind="OBJECTS", every=True)
    assert off_by(room, result, mirror).max() < WRONG
    assert "Reflection Light Nearer" not in result.data.attributes


def test_what_does_not_shine_is_not_cut(blank):
    scene_of(blank)
    checked_card(0.9, 30)
    result = parts.generate()
    count = len(result.data.polygons)
    bpy.ops.reflection_mesh.light(samples=1, kind="OBJECTS", every=True)
    assert len(result.data.polygons) == count
