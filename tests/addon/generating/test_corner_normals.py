"""Normals of their own that meshes are given: as they are, and the mesh's where there are none."""
from __future__ import annotations

import bpy
import numpy as np
import pytest


@pytest.mark.skipif(bpy.app.version < (4, 5, 0), reason="Blender averages those of neighbours that hardly differ")
def test_a_mesh_has_the_normals_that_it_is_given(blank, room):
    bpy.ops.mesh.primitive_uv_sphere_add(segments=12, ring_count=6)
    mesh = bpy.context.object.data
    own = np.empty((len(mesh.loops), 3), dtype=np.float32)
    mesh.corner_normals.foreach_get("vector", own.reshape(-1))
    given = own + 0.2 * np.random.default_rng(4).standard_normal(own.shape)
    given[::7] = 0.0
    wanted = np.where((given == 0.0).all(axis=1, keepdims=True), own, given)
    wanted /= np.linalg.norm(wanted, axis=1, keepdims=True)
    # over what it has by then, of whatever kind
    mesh.normals_split_custom_set(own)
    room("addon.compat").set_corner_normals(mesh, 3.0 * given)
    found = np.empty_like(own)
    mesh.corner_normals.foreach_get("vector", found.reshape(-1))
    assert np.abs(found - wanted)[(given != 0.0).any(axis=1)].max() < 1e-6
    assert np.abs(found - wanted).max() < 1e-3 and mesh.has_custom_normals
