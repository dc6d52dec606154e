"""What is kept of the pictures of objects' light: each face shows the finest that holds all of it, and there is no more
of it than is worth its time."""
from __future__ import annotations

from types import SimpleNamespace

import bpy
import numpy as np
import parts
import pytest
from lamp_scenes import SIZE
from test_asked_parts import ball_scene, light

IMAGE = "Reflection Light"


@pytest.fixture
def lit_ball(blank):
    """The reflection of a wide floor in a ball, lit with few samples."""
    ball_scene(blank)
    blank.scene.render.resolution_x = blank.scene.render.resolution_y = 2 * SIZE
    result = parts.generate()
    light(1)
    return result


def faces(room, result) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Where in the map corners of faces lie, (n, 3, 2), from 0 to 1; their areas in texels, and in pixels."""
    mesh, geometry = result.data, room("core.geometry")
    view = room("addon.reading").read_view(bpy.context)
    corners = np.array([face.vertices for face in mesh.polygons])
    spots = np.array([entry.vector for entry in mesh.uv_layers.active.uv]).reshape(-1, 3, 2)
    pixels = view.pixels(room("addon.reading").vectors(mesh, "mirror_position"))[corners]
    texels = spots * bpy.data.images[IMAGE].size
    return spots, *(np.abs(0.5 * geometry.doubled_areas(at)) for at in (texels, pixels))


def frames(room, result) -> tuple[np.ndarray, np.ndarray]:
    """The frames of its map, and the sheet of each."""
    kept = room("addon.baking").KeptMap(result.reflection_mesh.light_map, [])
    return np.unique(kept.frames, axis=0, return_inverse=True)


@pytest.mark.thorough
def test_each_face_lies_in_what_is_kept_of_one_picture_and_is_as_fine_as_it_is_seen(lit_ball, room):
    spots, texels, pixels = faces(room, lit_ball)
    ends, sheet = frames(room, lit_ball)
    assert len(ends) == 3 and len(sheet) == 6  # a floor of two triangles, three times
    within = np.array([((spots >= low - 1e-6) & (spots <= high + 1e-6)).all(axis=(1, 2)) for low, high in ends])
    assert (within.sum(axis=0) == 1).all() and (within.sum(axis=1) > 20).all()
    # what is kept does not overlap
    for one in range(3):
        for other in range(one):
            apart = (ends[one, 0] > ends[other, 1]) | (ends[other, 0] > ends[one, 1])
            assert apart.any()
    finer = room("addon.baking.fineness").FINER
    large = pixels > 0.05
    assert np.mean((texels / np.maximum(pixels, 1e-12))[large] > 0.9 * finer**2) > 0.9


@pytest.mark.parametrize(("beside", "finest"), [(0.0, True), (0.2, True), (0.9, False)])
def test_a_face_on_the_rim_of_what_is_kept_is_as_fine_as_others(room, beside, finest):
    """One triangle, kept twice in 100 x 100 texels; a face has two corners so many texels `beside` the middle of the
    last one of the finer. What is beside it by less than half a texel is in it."""
    triangle = np.array(((0.0, 0.0), (1.0, 0.0), (0.0, 1.0)))
    uv = np.array((0.1 + 0.2 * triangle, 0.4 + 0.4 * triangle))
    frames = np.array((((0.1, 0.1), (0.3, 0.3)), ((0.4, 0.4), (0.8, 0.8))))
    frames[1, 0, 0] += 0.01 * beside
    rows = [(np.array([0]), np.array([-1])), (np.array([1]), np.array([-1]))]
    kept, weights = SimpleNamespace(uv=uv, frames=frames), np.eye(3)[None]
    spots = room("addon.baking.object_map")._spots(kept, rows, (np.zeros(1, int), np.ones(1, bool)), weights, 0.005)
    shown = np.clip(uv[1], *frames[1]) if finest else uv[0]
    assert np.allclose(spots[0], shown, atol=1e-6)


@pytest.mark.thorough
def test_what_was_not_seen_so_finely_is_shown_as_it_was(lit_ball, room):
    """From elsewhere faces show what is kept of the coarser pictures where the finer do not have them, and nothing that
    belongs to others."""
    bpy.context.scene.camera.location.x += 3.0
    bpy.context.view_layer.update()
    parts.select(bpy.data.objects["Floor"], bpy.data.objects["Ball"])
    result = parts.generate()
    assert result.reflection_mesh.light_material is not None
    spots, texels, pixels = faces(room, result)
    ends, _ = frames(room, result)
    within = np.array([((spots >= low - 1e-6) & (spots <= high + 1e-6)).all(axis=(1, 2)) for low, high in ends])
    assert within.any(axis=0).all()
    assert ((texels < pixels) & (pixels > 0.05)).any()


@pytest.mark.thorough
def test_maps_of_earlier_versions_have_no_frames(lit_ball, room):
    light_map = lit_ball.reflection_mesh.light_map
    light_map.attributes.remove(light_map.attributes["frame"])
    ends, _ = frames(room, lit_ball)
    assert ends.tolist() == [[[0.0, 0.0], [1.0, 1.0]]]


@pytest.mark.thorough
@pytest.mark.parametrize("most", [20_000, 60_000])
def test_no_more_is_kept_than_is_worth_it(blank, room, monkeypatch, most):
    """And nearly as much as that."""
    charts = room("addon.baking.charts")
    ball_scene(blank)
    blank.scene.render.resolution_x = blank.scene.render.resolution_y = 2 * SIZE
    parts.generate()
    monkeypatch.setattr(charts, "FEWEST", most)
    monkeypatch.setattr(charts, "MOST", 0.0)
    kept, made = [], charts.charts_of

    def noted(*arguments):
        found = made(*arguments)
        kept.append(sum(int(chart.size.prod()) for chart in found[1]))
        return found
    monkeypatch.setattr(room("addon.baking.object_bake"), "charts_of", noted)
    light(1)
    assert 0.6 * most < kept[0] <= most


@pytest.mark.thorough
def test_of_many_triangles_each_has_its_texels_whatever_they_take(blank, room, monkeypatch):
    """More than is worth it where nothing is coarser: that is no reason to refuse them."""
    charts = room("addon.baking.charts")
    ball_scene(blank)
    other = parts.add("ico_sphere", "Other", subdivisions=5, radius=0.5, location=(1.5, -2.5, 0.6))
    other.data.materials.append(bpy.data.objects["Floor"].data.materials[0])
    parts.select(bpy.data.objects["Floor"], other, bpy.data.objects["Ball"])
    parts.generate(tolerance=2.0)
    monkeypatch.setattr(charts, "FEWEST", 1)
    monkeypatch.setattr(charts, "MOST", 0.0)
    light(1)
    assert np.prod(bpy.data.images[IMAGE].size) > 4 * len(other.data.polygons)
