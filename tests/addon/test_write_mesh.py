"""Arrays -> mesh: only faces that Blender keeps, and attributes that stay with their faces."""
from pathlib import Path

import bpy
import numpy as np
import parts
import pytest

SAMPLES = Path(__file__).resolve().parents[2] / "sample_blends"


def test_distinct_faces_against_sets(blank, room):
    triangles = np.random.default_rng(11).integers(0, 9, (400, 3))
    kept = room("addon.write_mesh").distinct_faces(triangles)
    seen, expected = set(), []
    for index, triangle in enumerate(map(frozenset, triangles.tolist())):
        if len(triangle) == 3 and triangle not in seen:
            expected.append(index)
            seen.add(triangle)
    assert kept.tolist() == expected
    assert room("addon.write_mesh").distinct_faces(np.zeros((0, 3), dtype=np.int64)).tolist() == []


def test_folded_faces_leave_a_valid_mesh(blank, room):
    """Two faces on the same vertices and one that is a line: the mesh keeps the first, with its own attributes."""
    leaf = parts.add_triangle("Leaf", [(0, 0, 0), (1, 0, 0), (0, 1, 0)])
    scene = room("addon.join_meshes").read_scene(bpy.context.evaluated_depsgraph_get(), [leaf])
    positions = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)], dtype=np.float64)
    result = room("core").ReflectionMesh(
        positions, np.array([(0, 1, 2), (2, 1, 0), (1, 1, 3), (1, 3, 2)]), positions, positions, np.ones(4),
        np.array([1, 1, 0, -1]), np.zeros(4, dtype=np.int64), np.tile(np.eye(3), (4, 1, 1)), np.array([5, 6, 7, -1]))
    mesh = bpy.data.meshes.new("Folded")
    writer = room("addon.write_mesh")
    writer.write_mesh(mesh, writer.mesh_arrays(result, scene, np.arange(10) + 100, np.zeros(3)))
    assert not mesh.validate(verbose=True)
    obj = bpy.data.objects.new("Folded", mesh)
    assert parts.corners(obj).tolist() == [[0, 1, 2], [1, 3, 2]]
    assert parts.attribute(obj, "mirror_face").tolist() == [105, -1]
    assert parts.attribute(obj, "image_parity").tolist() == [1, 1, 0, -1]


def test_more_uv_maps_than_a_mesh_holds(blank):
    """Two objects with eight maps each: the active one is among those that are kept, and nothing fails."""
    leaf = parts.add_triangle("Leaf", [(-0.5, -1.0, 0.6), (0.7, -1.5, 0.8), (0.1, -0.5, 1.7)])
    other = parts.add_triangle("Other", [(-1.5, -1.0, 0.6), (-0.7, -1.5, 0.8), (-1.1, -0.5, 1.7)])
    for obj in (leaf, other):
        for index in range(7):
            obj.data.uv_layers.new(name=f"{obj.name} {index}")
    leaf.data.uv_layers["Leaf 6"].active_render = True
    for obj in (leaf, other):
        obj.data.update()
    parts.select(leaf, other, parts.add_wall_mirror())
    result = parts.generate()
    assert len(result.data.uv_layers) == 8
    assert next(layer.name for layer in result.data.uv_layers if layer.active_render) == "Leaf 6"


@pytest.mark.parametrize("name", ["sphere", "water", "bowl"])
def test_samples_give_valid_meshes(name):
    bpy.ops.wm.open_mainfile(filepath=str(SAMPLES / f"{name}.blend"))
    result = parts.generate(tolerance=2.0)
    assert len(result.data.polygons) > 1000
    assert not result.data.validate(verbose=True)
    assert all(np.isfinite(parts.attribute(result, attribute)).all()
               for attribute in ("position", "reflected_position", "mirror_position", "path_length"))
