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


def strokes(drawn: bpy.types.Object) -> int:
    """Return how many strokes the Line Art of an evaluated object has."""
    evaluated = drawn.evaluated_get(bpy.context.evaluated_depsgraph_get())
    frames = [frame for layer in evaluated.data.layers for frame in layer.frames]
    return sum(len((frame if bpy.app.version < (4, 3, 0) else frame.drawing).strokes) for frame in frames)


def after_tag(drawn: bpy.types.Object) -> int:
    """Return the same after the object was tagged, as Blender draws it anew."""
    drawn.update_tag()
    return strokes(drawn)


@pytest.fixture
def still_life(blank):
    """A cube and a monkey before a wall mirror, and Line Art of the scene that is drawn already."""
    objects = [parts.add("cube", "Box", size=1.0, location=(1.0, -1.0, 0.8)),
               parts.add("monkey", "Monkey", size=1.0, location=(-1.0, -1.0, 0.8)), parts.add_wall_mirror()]
    objects[-1].reflection_mesh.role = "MIRROR"
    add = bpy.ops.object.gpencil_add if bpy.app.version < (4, 3, 0) else bpy.ops.object.grease_pencil_add
    add(type="LINEART_SCENE")
    assert strokes(bpy.context.object) > 50
    return bpy.context.object, objects


def test_line_art_is_drawn_again_when_a_result_comes_changes_or_goes(still_life):
    """Blender 4.2 forgets it after objects were removed, later versions after objects were added."""
    drawn, objects = still_life
    before, seen = strokes(drawn), []

    def drawn_at_once() -> int:
        now = strokes(drawn)
        assert now == after_tag(drawn)
        seen.append(now)
        return now
    parts.select(*objects)
    parts.generate()
    assert drawn_at_once() >= before + 20
    objects[0].location.z += 0.3
    bpy.ops.reflection_mesh.update()
    assert drawn_at_once() >= before + 20
    bpy.ops.reflection_mesh.light(samples=1)
    assert drawn_at_once() >= before + 20
    bpy.ops.reflection_mesh.clear()
    assert abs(drawn_at_once() - before) < 10


def test_line_art_is_drawn_again_after_undo_and_for_copies_with_mirror_uvs(still_life):
    drawn, objects = still_life
    name, before = drawn.name, strokes(drawn)
    bpy.ops.ed.undo_push(message="Before")
    parts.select(*objects)
    parts.generate()
    made = strokes(drawn)
    bpy.ops.ed.undo_push(message="Generated")
    bpy.ops.ed.undo()
    assert strokes(bpy.data.objects[name]) == before
    bpy.ops.ed.redo()
    assert strokes(bpy.data.objects[name]) == made
    bpy.ops.reflection_mesh.clear()
    parts.select(*(bpy.data.objects[other] for other in ("Box", "Mirror")))
    assert bpy.ops.reflection_mesh.mirror_uvs() == {"FINISHED"}
    now = strokes(bpy.data.objects[name])
    assert now == after_tag(bpy.data.objects[name])


def test_line_art_is_drawn_again_when_another_camera_shows_its_own_results(still_life):
    drawn, objects = still_life
    scene, first = bpy.context.scene, bpy.context.scene.camera
    second = bpy.data.objects.new("Second", first.data.copy())
    scene.collection.objects.link(second)
    second.matrix_world = first.matrix_world
    second.location.x += 0.5
    for camera in (first, second):
        scene.camera = camera
        parts.select(*objects)
        parts.generate()
    for camera in (first, second):
        scene.camera = camera
        bpy.context.view_layer.update()
        now = strokes(drawn)
        assert now == after_tag(drawn)
