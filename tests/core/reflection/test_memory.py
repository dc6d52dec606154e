"""Arrays stay within the memory that the settings allow: no more than that and what comes out."""
from __future__ import annotations

import os
import platform
import subprocess
import sys
import tracemalloc
from dataclasses import fields

import numpy as np
import pytest

from core import ReflectionMesh, Settings, TriangleMesh, View, reflect
from tests.inputs.shapes import uv_sphere

pytestmark = pytest.mark.slow

# pages that the system has to clear for the second of two reflections
FAULTS = """
import resource
from core import Settings, TriangleMesh, View, reflect
from tests.inputs.shapes import uv_sphere
points, triangles, normals = uv_sphere((0.0, 0.0, 0.0), 1.0, 48, 24)
around, faces, _ = uv_sphere((0.0, 0.0, 0.0), 3.0, 32, 16)
view = View.looking_at((0.0, -2.6, 0.4), (0.0, 0.0, 0.0), (512, 512), field_of_view=0.6)
given = view, TriangleMesh(points, triangles, normals[triangles]), TriangleMesh(around, faces)
reflect(*given)
before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
reflect(*given)
print(resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before)
"""


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


@pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="what the system clears is told of GNU's malloc")
def test_memory_that_arrays_leave_is_taken_again():
    again = int(subprocess.run([sys.executable, "-c", FAULTS], capture_output=True, text=True, check=True,
                               env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}).stdout)
    assert again < 5000  # pages; 13,000 where it is given back
