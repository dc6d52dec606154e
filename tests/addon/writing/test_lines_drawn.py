"""Faces share vertices for lines where lines are drawn, and nowhere else: by all ways to draw them."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from drawn_lines import add_line_art, smooth
from live_scene import generated


@pytest.fixture
def floor(blank):
    """A floor in a coarse ball, whose image has borders within."""
    camera = blank.scene.camera
    camera.location, camera.rotation_euler, camera.data.lens = (0.0, -9.0, 4.4), (1.26, 0.0, 0.0), 54.0
    blank.scene.render.resolution_x = blank.scene.render.resolution_y = 300
    floor = parts.add("plane", "Floor", size=14.0)
    ball = parts.add("uv_sphere", "Mirror", radius=2.2, segments=24, ring_count=12, location=(0.07, 0.6, 2.2))
    smooth(ball)
    return floor, ball


def borders(obj: bpy.types.Object) -> int:
    """How many edges of a mesh one face alone has."""
    edges = np.empty(len(obj.data.loops), dtype=np.int32)
    obj.data.loops.foreach_get("edge_index", edges)
    return int((np.bincount(edges) == 1).sum())


def line_art_hidden(source: bpy.types.Object) -> None:
    drawn, _ = add_line_art(source)
    drawn.hide_viewport = drawn.hide_render = True


def line_art_off(source: bpy.types.Object) -> None:
    _, modifier = add_line_art(source)
    modifier.show_viewport = modifier.show_render = False


def line_art_in_renders(source: bpy.types.Object) -> None:
    drawn, modifier = add_line_art(source)
    drawn.hide_viewport, modifier.show_viewport = True, False


def freestyle(_source: bpy.types.Object) -> None:
    bpy.context.scene.render.use_freestyle = bpy.context.view_layer.use_freestyle = True


def freestyle_of_no_layer(source: bpy.types.Object) -> None:
    freestyle(source)
    bpy.context.view_layer.use_freestyle = False


def grease_pencil(_source: bpy.types.Object) -> None:
    """Strokes drawn by hand."""
    bpy.context.scene.collection.objects.link(bpy.data.objects.new("Strokes", (
        bpy.data.grease_pencils if bpy.app.version < (4, 3, 0) else
        getattr(bpy.data, "grease_pencils_v3", bpy.data.grease_pencils)).new("Strokes")))


@pytest.mark.parametrize("how", [line_art_hidden, line_art_off, freestyle_of_no_layer, grease_pencil])
def test_without_lines_nothing_is_done_for_them(floor, how):
    before = generated(*floor)
    how(floor[1])
    assert generated(*floor) == before


@pytest.mark.parametrize("how", [add_line_art, line_art_in_renders, freestyle])
def test_where_lines_are_drawn_faces_share_vertices(floor, how):
    """And nothing else about the result changes but its faces."""
    parts.select(*floor)
    result = parts.generate()
    before, size, error = borders(result), sum(face.area for face in result.data.polygons), (
        result.reflection_mesh.estimated_error)
    how(floor[1])
    parts.select(*floor)
    assert parts.generate() == result
    assert borders(result) < 0.8 * before
    assert sum(face.area for face in result.data.polygons) == pytest.approx(size, rel=1e-4)
    assert result.reflection_mesh.estimated_error == error
    assert result.reflection_mesh.faces == len(result.data.polygons)


def test_a_copy_has_the_same_faces(floor):
    parts.select(*floor)
    result = parts.generate()
    parts.select(result)
    bpy.ops.object.duplicate()
    copy = bpy.context.object
    add_line_art(floor[1])
    before = borders(copy)
    parts.select(*floor)
    parts.generate()
    assert borders(copy) == borders(result) < 0.8 * before
