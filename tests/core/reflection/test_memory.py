"""Arrays stay within the memory that the settings allow: no more than that and what comes out."""
from __future__ import annotations

import tracemalloc
from dataclasses import fields

import numpy as np
import pytest

from core import ReflectionMesh, Settings, TriangleMesh, View, reflect
from tests.inputs.shapes import uv_sphere

pytestmark = pytest.mark.slow


def balls(count: int, segments: int) -> TriangleMesh:
    """Small balls all round one of radius 1."""
    rng, (points, triangles, _) = np.random.default_rng(4), uv_sphere(np.zeros(3), 0.04, segments, segments // 2)
    middles = rng.normal(size=(count, 3))
    middles *= (rng.uniform(1.2, 2.5, count) / np.linalg.norm(middles, axis=1))[:, None]
    return TriangleMesh((middles[:, None] + points).reshape(-1, 3),
                        (np.arange(count)[:, None, None] * len(points) + triangles).reshape(-1, 3))


def output(mesh: ReflectionMesh) -> int:
    """Bytes of the arrays of a result, those of its discs among them."""
    return sum(array.nbytes for part in (mesh, mesh.discs) if part is not None
               for array in (getattr(part, field.name) for field in fields(part)) if isinstance(array, np.ndarray))


# without a bound the first two take 0.51 GB for 89 MB of output, and 0.58 GB for 69 MB
@pytest.mark.parametrize(("count", "segments", "gigabytes", "settings"), [
    (1200, 20, 0.3, {}), (400, 24, 0.3, {"hidden_faces": True}), (1200, 20, 0.15, {"method": "POINTS"})],
    ids=["whole faces", "cameras", "points"])
def test_the_largest_arrays_fit_what_is_allowed(count, segments, gigabytes, settings):
    points, triangles, normals = uv_sphere(np.zeros(3), 1.0, 32, 16)
    view = View.looking_at((0.0, -6.0, 1.0), (0.0, 0.0, 0.0), (768, 768), field_of_view=0.45)
    mirror, scene = TriangleMesh(points, triangles, normals[triangles]), balls(count, segments)
    tracemalloc.start()
    try:
        mesh = reflect(view, mirror, scene, Settings(maximum_memory=gigabytes, **settings))
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert peak <= 1e9 * gigabytes + output(mesh)
