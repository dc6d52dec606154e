"""Dresses a copied scene for its renders: in codes that say what each pixel shows, and in its own materials."""
from __future__ import annotations

import itertools
from collections.abc import Generator
from typing import NamedTuple

import bpy
import numpy as np

from ...core import ReflectionError
from .. import compat
from ..faults import Steps
from ..judge import (
    CodedMaterials,
    CodedTruth,
    CopiedScene,
    cycles_render,
    decode,
    lowest_corner,
    mirror_all,
    polygons,
    show,
)
from ..metrics import CodedPicture
from ..rendering import render_stage
from ..writing import records
from .pictures import Pictures, render_lit, render_pictures

DEEPEST = 1000  # bounces that are followed; Cycles knows 1024, four of them for other rays
RENDERS = 7  # renders of a comparison; two more where Cycles rounds normals


class Renders(NamedTuple):
    """All renders of a comparison.

    Attributes
    ----------
    mirror, bent : (height, width) bool
        Pixels in which the eye sees a mirror, and those of them where Cycles bends the shading normal.
    truth, shown : CodedPicture
        What the mirror shows, and what the reflection mesh shows.
    exact : CodedPicture or None
        What the mirror would show if Cycles did not round its normals; None where Cycles does not.
    pictures : Pictures
    """

    mirror: np.ndarray
    bent: np.ndarray
    truth: CodedPicture
    shown: CodedPicture
    exact: CodedPicture | None
    pictures: Pictures


def render_comparison(context: bpy.types.Context, copied: CopiedScene, diffuse: list, results: list,
                      samples: int) -> Steps[Renders]:
    """Render the copied scene in codes and in its own materials, a step for each render; `samples` as in `comparison`.
    """
    count = RENDERS + 2 * compat.packs_normals() + lit(results)
    renders = _renders(context, copied, diffuse, results, samples)
    try:
        what = next(renders)
        for number in itertools.count():
            told = number / count, render_stage(f"Rendering {what}, {number + 1} of {count}")
            yield told
            # nothing more is said of one that goes on beside
            while (what := next(renders)) is None:
                yield told
    except StopIteration as stop:
        return stop.value
    finally:
        renders.close()


def _renders(context: bpy.types.Context, copied: CopiedScene, diffuse: list, results: list,
             samples: int) -> Generator[str | None, None, Renders]:
    """Do the renders of `render_comparison`; yield like `render_pictures`."""
    depth = min(max((records.counts(result).get("depth", 1) for result in results), default=1) or 1, DEEPEST)
    cycles_render.prepare(copied.scene, depth)
    _code_results(copied, results, diffuse, polygons(context, diffuse))
    own = [(slot, slot.material) for copy in copied.everything for slot in copy.material_slots]
    codes = CodedMaterials(copied, lowest_corner(copied))
    coded = yield from _coded_pictures(copied, codes, depth)
    if lit(results):
        return Renders(*coded, (yield from render_lit(context, results, samples)))
    for slot, material in own:
        slot.material = material
    mirror_all(copied, codes.plain_mirror())
    return Renders(*coded, (yield from render_pictures(copied, context.scene, samples)))


def lit(results: list) -> bool:
    """Return True if some results show light, so that it can be compared with the light in the mirror."""
    return any(result.reflection_mesh.light_material is not None for result in results)


def _code_results(copied: CopiedScene, results: list, diffuse: list, polygons: list) -> None:
    """Give each face of the copied results its code: diffuse object and polygon, like the codes of the ground truth."""
    number = {obj: index for index, obj in enumerate(diffuse)}
    for copy, index in copied.results:
        mesh, sources = copy.data, [item.object for item in results[index].reflection_mesh.sources]
        count = len(mesh.polygons)
        source, face = (_face_numbers(mesh, name, results[index]) for name in ("source_object", "source_face"))
        code = np.zeros((count, 3), dtype=np.float32)
        for position, obj in enumerate(sources):
            own = source == position
            # a source that no longer takes part is shown where nothing should be
            code[own, 0] = number.get(obj, len(diffuse)) + 2
            table = polygons[number[obj]] if obj in number else None
            known = own & (face < (0 if table is None else len(table)))
            code[own, 1] = -1.0
            code[known, 1] = table[face[known]] if known.any() else -1.0
        code[:, 1] += 1.0
        mesh.attributes.new("reflection_code", "FLOAT_VECTOR", "FACE").data.foreach_set("vector", code.ravel())


def _face_numbers(mesh: bpy.types.Mesh, name: str, result: bpy.types.Object) -> np.ndarray:
    """Return a face attribute of a result's mesh. Edits of the mesh may have removed it."""
    attribute = mesh.attributes.get(name)
    if attribute is None or (attribute.data_type, attribute.domain) != ("INT", "FACE"):
        raise ReflectionError(f"The faces of '{result.name}' do not know what they show: generate it again, with all "
                              "attributes.")
    values = np.empty(len(mesh.polygons), dtype=np.int32)
    attribute.data.foreach_get("value", values)
    return values


def _coded_pictures(copied: CopiedScene, codes: CodedMaterials, depth: int) -> Generator[str | None, None, tuple]:
    """Render in codes what the mirrors and the reflection meshes show in each pixel.

    Parameters
    ----------
    copied : CopiedScene
        Its objects keep coded materials afterwards.
    codes : CodedMaterials
        Materials for `copied`.
    depth : int
        Number of reflections that are followed.

    Yields
    ------
    str or None
        The name of each render before it, such as "the outline of the mirror", and None while Blender renders.

    Returns
    -------
    tuple
        The first five fields of `Renders`: mirror, bent, truth, shown and exact.
    """
    truth = CodedTruth(copied, codes, depth)
    yield "the outline of the mirror"
    seen, bent = yield from truth.mirror()
    reflected = yield from truth.reflected(seen)
    exact = (yield from truth.reflected(seen, unrounded=True)) if compat.packs_normals() else None
    truth.end()
    show(copied.results, True)
    codes.dress(copied.results, codes.attribute("reflection_code"))
    yield "the faces of the mesh"
    identity = yield from cycles_render.render_codes(copied.scene)
    codes.dress(copied.results, codes.attribute_position("reflected_position"))
    yield "the positions on the mesh"
    position = yield from cycles_render.render_codes(copied.scene)
    shown = decode(identity, position, codes.origin, True, face_start=1)
    return seen, bent, reflected, shown, exact

