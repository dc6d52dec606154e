"""Copies of objects cut along what a mirror shows of them: made or found, written, standing in for their sources."""
from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace

import bpy
from mathutils import Matrix

from .. import compat
from ..faults import AllOrNothing, Steps, keep_data, keep_object
from ..writing import MeshArrays, new_beside, write_mesh
from .sheet_arrays import Sheet


def source_of(context: bpy.types.Context, obj: bpy.types.Object) -> bpy.types.Object:
    """Return the object that `obj` is a copy of if that is still in the view layer, else `obj`."""
    source = obj.reflection_mesh.mirror_uv_source
    return source if source is not None and source.name in context.view_layer.objects else obj


@contextmanager
def shown(context: bpy.types.Context, sources: list) -> Iterator[None]:
    """Show the sources that copies replace while the block reads them."""
    layer = context.view_layer
    hidden = [(obj, obj.hide_get(), obj.hide_render) for obj in sources if obj.name in layer.objects]
    hidden = [entry for entry in hidden if entry[1] or entry[2]]
    for obj, _, _ in hidden:
        obj.hide_set(False)
        obj.hide_render = False
    if hidden:
        layer.update()
    try:
        yield
    finally:
        for obj, viewport, render in hidden:
            obj.hide_set(viewport)
            obj.hide_render = render


def write_copy(context: bpy.types.Context, sheet: Sheet, paper: bpy.types.Material | None,
               whole: AllOrNothing) -> Steps[bpy.types.Object]:
    """Write the copy of a source object, a new one beside it or its existing one, and hide the source. Yields
    (fraction, "").

    Parameters
    ----------
    paper : bpy.types.Material or None
        Material of the copy in place of its source's; None keeps the present ones.
    """
    source = sheet.source
    earlier = [obj for obj in context.scene.objects if obj.reflection_mesh.mirror_uv_source == source
               and obj.type == "MESH" and obj.library is None]
    if earlier:
        obj = earlier[0]
        keep_object(obj, whole)
        keep_data(obj, whole)
        paper = paper or obj.reflection_mesh.mirror_uv_picture
    else:
        obj = _new_copy(context, source, whole)
    render_map = _render_map(obj.data, sheet)
    write_mesh(obj.data, sheet.arrays if paper is None else _on_paper(sheet.arrays, paper))
    yield 0.5, ""
    compat.set_corner_normals(obj.data, sheet.normals)
    if render_map:
        obj.data.uv_layers[render_map].active_render = True
    if paper is not None:
        whole.undo(setattr, obj.reflection_mesh, "mirror_uv_picture", obj.reflection_mesh.mirror_uv_picture)
        obj.reflection_mesh.mirror_uv_picture = paper
    obj.matrix_world = Matrix(sheet.matrix.tolist())
    _hide(context, source, whole)
    return obj


def _on_paper(arrays: MeshArrays, paper: bpy.types.Material) -> MeshArrays:
    """Return the same arrays with `paper` as the only material."""
    return replace(arrays, materials=[paper],
                   attributes=tuple(entry for entry in arrays.attributes if entry.name != "material_index"))


def _render_map(mesh: bpy.types.Mesh, sheet: Sheet) -> str:
    """Return the UV map for materials without a named one: the present one, else the source's."""
    of_source = [name for name in sheet.arrays.uv_maps[1:]]
    earlier = next((layer.name for layer in mesh.uv_layers if layer.active_render), "")
    return earlier if earlier in of_source else next(iter(of_source), "")


def _new_copy(context: bpy.types.Context, source: bpy.types.Object, whole: AllOrNothing) -> bpy.types.Object:
    obj = new_beside(context, f"{source.name} Anamorphosis", source, whole)
    record = obj.reflection_mesh
    record.role, record.mirror_uv_source = source.reflection_mesh.role, source
    return obj


def _hide(context: bpy.types.Context, source: bpy.types.Object, whole: AllOrNothing) -> None:
    """Hide the source, since two surfaces in one place would flicker."""
    if source.library is None:
        whole.undo(setattr, source, "hide_render", source.hide_render)
        source.hide_render = True
    if source.name in context.view_layer.objects:
        # hiding an object deselects it, so store the selection first
        whole.undo(source.select_set, source.select_get())
        whole.undo(source.hide_set, source.hide_get())
        source.hide_set(True)
