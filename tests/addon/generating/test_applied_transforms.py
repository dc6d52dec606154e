"""Transforms that were applied to a result (Object > Apply, Ctrl A), as to everything before an export."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from mathutils import Matrix
from reflected_box import reflected_box

EYE = np.array((0.0, -6.0, 1.0))


@pytest.fixture
def scene(blank):
    return reflected_box()


def apply(result: bpy.types.Object) -> None:
    parts.select(result)
    assert bpy.ops.object.transform_apply() == {"FINISHED"}


def beside_their_lines(result: bpy.types.Object, by: Matrix = Matrix.Identity(4)) -> float:
    """How far vertices, moved back `by` a transform, are from the lines between the eye and the images behind a mirror
    at y = 1, at the most."""
    to_world = np.array(by.inverted() @ result.matrix_world)
    there = parts.attribute(result, "position") @ to_world[:3, :3].T + to_world[:3, 3]
    image = parts.attribute(result, "reflected_position") * (1.0, -1.0, 1.0) + (0.0, 2.0, 0.0)
    way = (image - EYE) / np.linalg.norm(image - EYE, axis=1, keepdims=True)
    return float(np.linalg.norm(np.cross(there - EYE, way), axis=1).max())


@pytest.mark.parametrize("parented", [False, True])
def test_what_was_applied_has_moved_nothing(scene, parented):
    mirror, cube, result = scene
    if parented:
        holder = bpy.data.objects.new("Holder", None)
        bpy.context.scene.collection.objects.link(holder)
        holder.matrix_world = Matrix.Rotation(0.7, 4, "Z") @ Matrix.Translation((1.0, 2.0, 3.0))
        # as by script, without a parent inverse
        place = result.matrix_world.copy()
        result.parent = holder
        bpy.context.view_layer.update()
        result.matrix_world = place
        bpy.context.view_layer.update()
        parts.generate()
    apply(result)
    assert beside_their_lines(result) < 1e-4
    for _ in range(2):
        cube.location.x += 0.2
        bpy.context.view_layer.update()
        assert parts.generate() == result
        assert beside_their_lines(result) < 1e-4


def test_what_was_moved_and_applied_stays_moved(scene):
    mirror, cube, result = scene
    by = Matrix.Translation((0.5, 0.0, 2.0)) @ Matrix.Rotation(0.4, 4, "Y")
    result.matrix_world = by @ result.matrix_world
    apply(result)
    parts.generate()
    bpy.context.view_layer.update()
    assert beside_their_lines(result, by) < 1e-4


def test_light_lies_where_it_did(scene):
    mirror, cube, result = scene
    bpy.context.scene.render.resolution_percentage = 25
    found = []
    for applied in (False, True):
        if applied:
            apply(result)
        bpy.ops.reflection_mesh.light(samples=1)
        found.append(np.array([spot.vector for spot in result.data.uv_layers["Reflection Light"].uv]))
    assert found[0].shape == found[1].shape and np.abs(found[0] - found[1]).max() < 1e-4


@pytest.mark.parametrize("what", ["delete", "sculpt"])
def test_what_was_edited_is_no_transform(scene, what):
    mirror, cube, result = scene
    parts.select(result)
    if what == "sculpt":
        for vertex in result.data.vertices:
            vertex.co.x += 0.3 * (vertex.index**2 % 3)
    else:
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.mesh.delete(type="FACE")
        bpy.ops.object.mode_set(mode="OBJECT")
    by = Matrix.Translation((0.5, 0.0, 2.0))
    result.matrix_world = by @ result.matrix_world
    parts.generate()
    bpy.context.view_layer.update()
    assert beside_their_lines(result, by) < 1e-4
