"""Light baked once for all objects of a scene, into one picture of all of their triangles."""
from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from ...core import ReflectionError, View
from ..faults import Steps, Undivided
from ..reading import DiffuseScene, is_opaque
from ..reading.read_meshes import read_meshes
from .atlas import Atlas, arranged, packed
from .bake_scene import UNTOUCHED, bake_scene
from .seen_sources import has_rim, seen_sources, triangles_by_source
from .stand_ins import stand_ins

LARGEST = 4096  # texels along a side of all maps together
FINER = 1.5     # texels a pixel along a line: interpolation and the picture's filter blur them
WIDE = 32.0     # texels across triangles from which on what lies side by side in a picture does in the scene too
ALMOST_ALL = 0.9  # of an object's surface, whose triangles are so wide where its picture is denoised
FEWER = 0.5     # of the samples are enough where a picture is denoised
COARSER = 0.7   # texels along a line, where there are too many, from one try to the next


@dataclass(frozen=True)
class ObjectLight:
    """Light of a scene.

    Attributes
    ----------
    texels : (size, size, 4) float32
        Linear light, and how opaque what sends it is.
    uv : (m, 3, 2) float32
        Where in it the corners of triangles lie, sheet by sheet.
    sheets : list of (int, bool)
        Which triangles: all of a source in their own order, and whether it is their backs.
    """

    texels: np.ndarray
    uv: np.ndarray
    sheets: list


def baked(context: bpy.types.Context, results: list, view: View, scene: DiffuseScene, samples: int,
          ) -> Steps[ObjectLight]:
    """Bake the light on the sources of `scene`, as finely as `results` show them to `view` and from where they do.

    Raises
    ------
    ReflectionError
        Where there are more triangles than texels, or Blender's bake is cancelled.
    """
    seen = seen_sources(results, view, scene)
    parts = triangles_by_source(scene)
    open_ = [not all(is_opaque(scene.materials[index]) for index in np.unique(scene.material[part])) for part in parts]
    # through an object that is open in places its backs are seen, and what has a rim shows both sides as it is
    both = [through or (seen.both[number] and has_rim(scene.mesh.triangles[parts[number]]))
            for number, through in enumerate(open_)]
    sheets = [(number, back) for number in range(len(parts)) for back in (False, True)
              if both[number] or back == bool(seen.backs[number])]
    atlases, at, side = _packed(scene, parts, sheets, FINER * seen.density)
    placed = read_meshes(context.evaluated_depsgraph_get(), scene.sources, mirror=False)
    texels = np.zeros((side, side, 4), dtype=np.float32)
    areas = {sheet: texels[row:row + atlases[sheet[0]].size, column:column + atlases[sheet[0]].size]
             for sheet, (column, row) in zip(sheets, at.tolist(), strict=True)}
    uv = {number: atlas.uv for number, atlas in atlases.items()}
    wide = {number: is_wide(atlas) for number, atlas in atlases.items()}
    # opacity is the same from both sides
    work = [(False, sheet) for sheet in sheets]
    work += [(True, sheet) for sheet in sheets if open_[sheet[0]] and not sheet[1]]
    done, whole = 0.0, float(sum(areas[sheet].size for _, sheet in work))
    for opacity, back in sorted({(opacity, sheet[1]) for opacity, sheet in work}):
        chosen = [sheet for asked, sheet in work if asked == opacity and sheet[1] == back]
        stands = stand_ins(placed, uv, turned={number for number, _ in chosen} if back else set())
        with bake_scene(context, scene.sources, stands, opacity=opacity, backs=back) as stage:
            for number, _ in chosen:
                yield done / whole, Undivided(f"Cycles bakes the light on '{scene.sources[number].name}'")
                denoised = wide[number] and not opacity
                # as many samples for each pixel, not for each texel
                share = (FEWER if denoised else 1.0) / FINER ** 2
                picture = spread(stage.bake(number, atlases[number].size, seen.seen_from[number],
                                            bool(seen.one_eye[number]), max(round(samples * share), 1), denoised))
                for sheet in [(number, False), (number, True)] if opacity else [(number, back)]:
                    if opacity:
                        areas[sheet][..., 3] = picture[..., 0]
                    else:
                        areas[sheet][..., :3], areas[sheet][..., 3] = picture[..., :3], 1.0
                done += areas[number, back].size
    return ObjectLight(texels, np.concatenate([(uv[sheet[0]] * atlases[sheet[0]].size + start) / side for sheet, start
                                               in zip(sheets, at, strict=True)]).astype(np.float32), sheets)


def _packed(scene: DiffuseScene, parts: list, sheets: list, density: np.ndarray) -> tuple[dict, np.ndarray, int]:
    """The atlas of each source, where each sheet lies in the whole picture, and its side."""
    corners = scene.mesh.positions[scene.mesh.triangles]
    while True:
        atlases = {number: packed(corners[part], float(density[number])) for number, part in enumerate(parts)}
        at, side = arranged(np.array([atlases[number].size for number, _ in sheets]))
        if side <= LARGEST:
            return atlases, at, side
        if density.max() * np.ptp(corners) < 1.0:
            raise ReflectionError("The reflected objects have more triangles than a map of their light has room for: "
                                  "light the reflection in the picture.")
        density = density * COARSER


def is_wide(atlas: Atlas) -> bool:
    """Whether the triangles of a picture are so large in it that denoising mixes nothing that lies apart."""
    corners = atlas.uv.astype(np.float64) * atlas.size
    sides = corners[:, (1, 2, 0)] - corners
    area = np.abs(sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0])
    across = np.linalg.norm(sides, axis=2).min(axis=1)
    return float(area[across >= WIDE].sum()) >= ALMOST_ALL * float(area.sum())


def spread(picture: np.ndarray) -> np.ndarray:
    """The picture with the texels around what was baked as their neighbours in the mean, two rings of them."""
    known = picture[..., 3] != UNTOUCHED
    values = np.where(known[..., None], picture, 0.0)
    for _ in range(2):
        weight = _sum_around(known.astype(np.float32))
        ring = ~known & (weight > 0.0)
        values[ring] = (_sum_around(values) / np.maximum(weight, 1.0)[..., None])[ring]
        known |= ring
    return values


def _sum_around(values: np.ndarray) -> np.ndarray:
    """The sum of each texel and its eight neighbours."""
    padded = np.pad(values, ((1, 1), (1, 1)) + ((0, 0),) * (values.ndim - 2))
    across = padded[:, :-2] + padded[:, 1:-1] + padded[:, 2:]
    return across[:-2] + across[1:-1] + across[2:]
