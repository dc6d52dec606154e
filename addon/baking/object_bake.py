"""Light baked once for all objects of a scene, into one picture of all of their triangles."""
from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import bpy
import numpy as np

from ...core import View, breathe, in_steps
from ..faults import Steps, part
from ..reading import DiffuseScene, is_opaque, materials_of
from ..reading.meshes import read_meshes
from .charts import charts_of, laid_out
from .fineness import fineness
from .levels import fine_where_seen
from .mirror_bodies import MirrorBodies, mirror_bodies
from .seen_sources import SeenSources, has_rim, outer_sides, seen_sources, triangles_by_source
from .shown_texels import shown_texels
from .stage import BakeScene, bake_scene, is_deformed, new_meshes, stand_ins, undeformed_positions
from .texels import is_glossy
from .thrown import thrown_light

LIGHT, COLOURS = 0.7, 0.15  # of the work of a picture; colours are baked twice at most
FEWER = 0.5     # of the samples are enough where a picture is denoised
LINES = 512     # of the map, which are put together in one step
PREPARING = "Copying the scene"
MEASURING = "Measuring visible faces"


@dataclass(frozen=True)
class ObjectLight:
    """Light of a scene.

    Attributes
    ----------
    texels : (height, width, 4) float32
        Linear light, and how opaque what sends it is; no more of the square than is used.
    uv : (m, 3, 2) float32
        Where in it the corners of triangles lie, sheet by sheet.
    frames : (m, 2, 2) float32
        The lowest and the highest place in it that belongs to the sheet of each.
    sheets : list of (int, bool)
        Which triangles: all of a source in their own order, and whether it is their backs; the same ones several times,
        from coarse to fine, where what is kept of the finer does not hold all of them.
    dull : tuple of str
        The names of those sources that have gloss, and are not seen as from one place.
    """

    texels: np.ndarray
    uv: np.ndarray
    frames: np.ndarray
    sheets: list
    dull: tuple


def baked(context: bpy.types.Context, results: list, view: View, scene: DiffuseScene, samples: int,
          ) -> Steps[ObjectLight]:
    """Bake the light on the sources of `scene`, as finely as `results` show them to `view` and from where they do.

    Raises
    ------
    ReflectionError
        Where there are more triangles than texels, or Blender's bake is cancelled.
    """
    yield 0.0, MEASURING
    seen = yield from part(in_steps(partial(seen_sources, results, view, scene)), 0.0, 0.0, MEASURING)
    parts, open_, sides = yield from part(in_steps(partial(_sides_of, scene, seen)), 0.0, 0.0, MEASURING)
    density = yield from part(in_steps(partial(fine_where_seen, results, view, scene, parts, seen.density)), 0.0, 0.0,
                              MEASURING)
    levels, charts = yield from part(in_steps(partial(charts_of, results, view, scene, parts, sides, density)),
                                     0.0, 0.0, MEASURING)
    used = np.max([chart.at + chart.size for chart in charts], axis=0)
    uv, frames = laid_out(levels, charts)
    sheets = [(chart.number, chart.back) for chart in charts]
    side = int(used.max())
    thrown, lit = yield from part(thrown_light(context, scene, sheets, (uv / side, frames / side), side), 0.0, 0.0)
    # opacity is the same from both sides
    asked = sides + [(number, None) for number, through in enumerate(open_) if through]
    bodies = yield from part(in_steps(partial(mirror_bodies, context, results, view)), 0.0, 0.0, MEASURING)
    pictures, colours = yield from _pictures(context, scene, (seen, bodies), levels,
                                             {sheet: sheet in lit for sheet in asked}, samples)
    texels = np.zeros((*used[::-1], 4), dtype=np.float32)
    for chart in charts:
        number, back, (column, row), (wide, high) = chart.number, chart.back, chart.at.tolist(), chart.size.tolist()
        place = slice(row, row + high), slice(column, column + wide)
        light = pictures[number, back][chart.level]
        # opacity is kept of all that either side has
        left, below = np.maximum(chart.low - levels[number].frame(chart.level, None)[0], 0).tolist()
        for first in range(0, high, LINES):
            yield 1.0, PREPARING
            own = texels[place][first:first + LINES]
            within = slice(first, first + len(own)), slice(wide)
            own[..., :3] = light[within][..., :3]
            own[..., 3] = pictures[number, None][chart.level][below + first:, left:][:len(own), :wide, 0] \
                if open_[number] else 1.0
            if (number, back) in lit:
                own[..., :3] += colours[number, back][chart.level][within][..., :3] * thrown[place][within]
    yield 1.0, PREPARING
    return ObjectLight(texels, (uv / used).astype(np.float32), (frames / used).astype(np.float32), sheets,
                       _dull(scene, seen))


def _dull(scene: DiffuseScene, seen: SeenSources) -> tuple:
    return tuple(source.name for source, one_eye in zip(scene.sources, seen.one_eye, strict=True)
                 if not one_eye and any(map(is_glossy, materials_of(source))))


def _sides_of(scene: DiffuseScene, seen: SeenSources) -> tuple[list, list, list]:
    """The triangles of each source, whether it is open in places, and what is baked: (source, whether its backs)."""
    parts = triangles_by_source(scene)
    breathe()
    open_ = [not all(is_opaque(scene.materials[index]) for index in np.unique(scene.material[part])) for part in parts]
    return parts, open_, [(number, back) for number, through in enumerate(open_)
                          for back in _sides(scene.mesh.positions, scene.mesh.triangles[parts[number]], seen, number,
                                             through)]


def _sides(positions: np.ndarray, triangles: np.ndarray, seen: SeenSources, number: int, open_: bool) -> list:
    """Whether backs are baked, for each side of a source that is: where it is `open_` in places its backs are seen
    through it, what has a rim shows both sides as it is, and of what is closed the outside hides the inside."""
    if open_:
        return [False, True]
    if not seen.both[number] or seen.backs[number]:
        return [bool(seen.backs[number])]
    sides = (True, True) if has_rim(triangles) else outer_sides(positions, triangles)
    return [back for back, outside in zip((False, True), sides) if outside]


def _pictures(context: bpy.types.Context, scene: DiffuseScene, how: tuple[SeenSources, MirrorBodies], levels: dict,
              asked: dict, samples: int) -> Steps[tuple[dict, dict]]:
    """What Cycles bakes of each of `asked`, (source, whether its backs); None there for how opaque it is; and, of those
    whose value there says so, the colours of what is matte."""
    seen, bodies = how
    placed = read_meshes(context.evaluated_depsgraph_get(), scene.sources, mirror=False, answered=True)
    divisions = {number: one.division for number, one in levels.items()}
    corners = [scene.mesh.positions[scene.mesh.triangles[one]] for one in triangles_by_source(scene)]
    undeformed = yield from part(_undeformed(context.scene, scene.sources), 0.0, 0.0, PREPARING)
    # coarse ones first, the finest of all objects together
    bakes: dict = {}
    finer = fineness(scene)
    for number, back in asked:
        for level in range(-len(levels[number].atlases), 0):
            bakes.setdefault((back is None, bool(back), level), []).append(number)
    found, matte = {}, {}
    done, whole = 0.0, sum(levels[number].texels(level, None) for (*_, level), some in bakes.items() for number in some)
    for (opacity, turned, level), chosen in sorted(bakes.items()):
        back = None if opacity else turned
        places = {number: one.places(level, back) if number in chosen else one.nowhere()
                  for number, one in levels.items()}
        yield done / whole, PREPARING
        stands = stand_ins(placed, divisions, places, set(chosen) if turned else set(), undeformed)
        meshes = yield from part(new_meshes(stands), done / whole, 0.0, PREPARING)
        with bake_scene(context, seen.view, scene.sources, list(zip(stands, meshes, strict=True)), opacity=opacity,
                        backs=turned) as stage:
            for number in chosen:
                own = levels[number]
                denoised = own.wide and not opacity
                # as many samples for each pixel, not for each texel
                few = max(round(samples * (FEWER if denoised else 1.0) / finer[number] ** 2), 1)
                size = tuple(own.window(level, back)[1].tolist())
                picture, colours, own_colours = yield from part(
                    _baked(stage, number, size, seen.seen_from[number], few, (denoised, asked[number, back])),
                    done / whole, own.texels(level, None) / whole,
                    f"Baking light on '{scene.sources[number].name}'")
                made = [(found, picture, colours)]
                if own_colours is not None:
                    made.append((matte, own_colours, own_colours))
                shown = None if opacity else (yield from part(
                    in_steps(partial(shown_texels, bodies, *own.baked_parts(level, back, corners[number]),
                                     own.frame(level, back)[1], turned)), done / whole, 0.0, PREPARING))
                for kept, picture, colours in made:
                    before = kept.setdefault((number, back), [])
                    before.append((yield from part(
                        in_steps(partial(own.picture, back, picture, before, colours, shown)),
                        done / whole, 0.0, PREPARING)))
                done += own.texels(level, None)
    return found, matte


def _baked(stage: BakeScene, number: int, size: tuple[int, int], seen_from: np.ndarray, samples: int,
           how: tuple[bool, bool]) -> Steps[tuple]:
    """The light on an object, `how`: whether denoised, with the colours that it has then, and whether with those of
    what is matte; None where they are not asked for."""
    denoised, matte = how
    light = yield from part(stage.bake(number, size, seen_from, samples, denoised), 0.0, LIGHT)
    colours = own_colours = None
    if denoised:
        colours = yield from part(stage.colours(number, size, samples), LIGHT, COLOURS)
    if matte:
        own_colours = yield from part(stage.matte(number, size, samples), LIGHT + COLOURS, COLOURS)
    return light, colours, own_colours


def _undeformed(scene: bpy.types.Scene, sources: list) -> Steps[dict]:
    """Positions before anything deforms them, by source, of those that are deformed; a step before each."""
    found = {}
    for number, source in enumerate(sources):
        if not is_deformed(source):
            continue
        yield 0.0, PREPARING
        found[number] = undeformed_positions(scene, source)
    return found
