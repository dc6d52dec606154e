"""What holds in every result of `reflection_mesh.generate`, as Blender holds it."""
from __future__ import annotations

from collections.abc import Iterator

import bpy
import numpy as np

from tests.fuzz.blender.scene_state import arrays, digest

FINITE = (np.float32, np.float64)


def result_problems(result: bpy.types.Object) -> Iterator[str]:
    """Blender finds nothing to mend, every number is one, and every index names something."""
    if result.reflection_mesh.role != "REFLECTION":
        yield f"an object that is no reflection, with the role {result.reflection_mesh.role}"
        return
    if not np.isfinite(np.array(result.matrix_world)).all():
        yield "its place is not finite"
    error = result.reflection_mesh.estimated_error
    if not (np.isfinite(error) and error >= 0.0):
        yield f"its estimated error is {error}"
    mesh = result.data
    if not len(mesh.vertices):
        yield "it shows nothing"
    # before Blender validates a copy: it writes through to what both share
    values = {name.split("|")[0]: array for name, array in arrays(mesh).items()}
    yield from _mended(mesh)
    for name, array in values.items():
        if array.dtype in FINITE and not np.isfinite(array).all():
            yield f"{name} holds {np.count_nonzero(~np.isfinite(array))} numbers that are none"
    sources = len(result.reflection_mesh.sources)
    bounds = {"source_object": (0, sources), "source_face": (0, None), "mirror_face": (-1, None),
              "image_parity": (-1, 2), "material_index": (0, max(1, len(mesh.materials))),
              "source_material": (0, max(1, len(mesh.materials))), "path_length": (0.0, None)}
    for name, (low, high) in bounds.items():
        array = values.get(name, np.zeros(0))
        if array.size and (array.min() < low or (high is not None and array.max() >= high)):
            yield f"{name} reaches from {array.min()} to {array.max()}"
    for name in ("reflected_position", "mirror_position", "path_length", "image_parity", "source_object", "source_face",
                 "mirror_face"):
        if name not in values:
            yield f"it has no {name}"


def _mended(mesh: bpy.types.Mesh) -> Iterator[str]:
    before, copy = digest(mesh), mesh.copy()
    if copy.validate(verbose=False) or copy.validate_material_indices() or digest(copy) != before:
        yield "Blender mends its mesh"
    bpy.data.meshes.remove(copy)


def disc_problems(result: bpy.types.Object) -> Iterator[str]:
    """Points are drawn as discs, which are finite."""
    evaluated = result.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = evaluated.to_mesh()
    positions = arrays(mesh).get("position|POINT", np.zeros((0, 3)))
    if not np.isfinite(positions).all():
        yield "its discs are not finite"
    if not len(mesh.polygons):
        yield "its points have no discs"
    evaluated.to_mesh_clear()
