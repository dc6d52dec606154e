"""Edges of triangles: those that Blender finds, worked out in steps, so that writing a large mesh is a short one."""
from __future__ import annotations

import time
from pathlib import Path

import bpy
import numpy as np
import parts
import pytest

SAMPLES = Path(__file__).resolve().parents[3] / "sample_blends"
CELLS = 670     # along a side of a square, two triangles each


def square() -> tuple[np.ndarray, np.ndarray]:
    """Positions and triangles of a square with 900,000 faces, in no order."""
    at = np.arange((CELLS + 1) ** 2, dtype=np.int32).reshape(CELLS + 1, -1)
    low, right, high, left = at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1]
    triangles = np.stack((low, right, high, low, high, left), axis=-1).reshape(-1, 3)
    rng = np.random.default_rng(8)
    positions = np.stack((*np.divmod(np.arange(at.size), CELLS + 1), np.zeros(at.size)), axis=1).astype(np.float32)
    return positions, rng.permutation(at.size).astype(np.int32)[rng.permutation(triangles)]


def of(mesh: bpy.types.Mesh, name: str, width: int) -> np.ndarray:
    values = np.empty((len(mesh.attributes[name].data), width), dtype=np.int32)
    mesh.attributes[name].data.foreach_get("value", values.reshape(-1))
    return values


def sides(mesh: bpy.types.Mesh) -> np.ndarray:
    """The vertices of the edge that each corner begins, the lower first."""
    return np.sort(of(mesh, ".edge_verts", 2), axis=1)[of(mesh, ".corner_edge", 1)[:, 0]]


def by_blender(triangles: np.ndarray, count: int) -> bpy.types.Mesh:
    mesh = bpy.data.meshes.new("By Blender")
    mesh.vertices.add(count)
    mesh.loops.add(triangles.size)
    mesh.polygons.add(len(triangles))
    mesh.loops.foreach_set("vertex_index", triangles.reshape(-1))
    mesh.polygons.foreach_set("loop_start", np.arange(0, triangles.size, 3, dtype=np.int32))
    mesh.update(calc_edges=True)
    return mesh


@pytest.mark.thorough
@pytest.mark.parametrize("name", ["sphere", "bowl", "mirrors"])
def test_they_are_blenders(name):
    """Of each corner the same edge, each edge once, and as many."""
    bpy.ops.wm.open_mainfile(filepath=str(SAMPLES / f"{name}.blend"))
    mesh = parts.generate(tolerance=2.0).data
    triangles = of(mesh, ".corner_vert", 1).reshape(-1, 3)
    other = by_blender(triangles, len(mesh.vertices))
    assert len(mesh.edges) == len(other.edges)
    assert np.array_equal(sides(mesh), sides(other))
    assert not mesh.validate(verbose=True)


def test_sides_and_borders_by_hand(room):
    """Two triangles that share a side, in both directions, and one beside them."""
    kind = room("addon.writing.arrays.mesh_edges").Edges
    edges = kind.of(np.array([[7, 2, 4], [4, 2, 9], [1, 0, 3]], dtype=np.int32))
    assert edges.ends.tolist() == [[0, 1], [0, 3], [1, 3], [2, 4], [2, 7], [2, 9], [4, 7], [4, 9]]
    assert edges.of_side.tolist() == [4, 3, 6, 3, 5, 7, 0, 1, 2]
    assert edges.borders.tolist() == [True, True, True, False, True, True, True, True]
    chosen = np.zeros(9, dtype=bool)
    chosen[[1, 3, 8]] = True
    assert np.flatnonzero(edges.among(chosen)).tolist() == [2, 3]
    none = kind.of(np.zeros((0, 3), dtype=np.int32))
    assert none.ends.shape == (0, 2) and none.of_side.shape == (0,) and none.borders.shape == (0,)


def test_a_million_faces_are_written_in_short_steps(blank, room):
    """Edges in steps, and all of writing in one that no window waits for: half a second is the most, with UV maps,
    colours, sharp edges and marks."""
    writing, edges = room("addon.writing.arrays.mesh_arrays"), room("addon.writing.arrays.mesh_edges").Edges
    positions, triangles = square()
    longest, steps, begun = 0.0, room("core").in_steps(lambda: edges.of(triangles)), now()
    try:
        while True:
            next(steps)
            longest, begun = max(longest, lesser(begun)), now()
    except StopIteration as stop:
        found, longest = stop.value, max(longest, lesser(begun))
    every = np.arange(len(found.ends)) % 3 == 0
    arrays = writing.MeshArrays(np.zeros(3), positions, triangles, (
        *(writing.Attribute(f"UV {k}", "FLOAT2", "CORNER", np.ones((triangles.size, 2), np.float32)) for k in range(2)),
        writing.Attribute("Colour", "FLOAT_COLOR", "CORNER", np.ones((triangles.size, 4), np.float32)),
        writing.Attribute("where", "FLOAT_VECTOR", "POINT", np.ones((len(positions), 3), np.float32))), [],
        writing.Lines(every, every, np.ones(len(triangles), dtype=bool)), found)
    mesh = bpy.data.meshes.new("Large")
    seconds = []
    for _ in range(3):
        begun = now()
        room("addon.writing").write_mesh(mesh, arrays)
        seconds.append(lesser(begun))
    assert len(mesh.polygons) == 2 * CELLS ** 2 and len(mesh.edges) == 3 * CELLS ** 2 + 2 * CELLS
    assert longest < 0.5 and min(seconds) < 0.5


def now() -> tuple[float, float]:
    return time.process_time(), time.perf_counter()


def lesser(begun: tuple[float, float]) -> float:
    """The lesser of the processor's and the clock's seconds, so that other work on the machine does not count."""
    return min(end - start for end, start in zip(now(), begun))
