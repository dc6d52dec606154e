"""How far a reflection mesh is from the truth: displacement and coverage, as the design defines them."""
from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from core import ReflectionMesh, TriangleMesh, View
from tests.oracles.raster import rasterise
from tests.oracles.truth import Truth, trace

# Another source triangle further away than this is another surface.
NEIGHBOUR = 2.0
NOTHING, SAME, HOLE, SPILL, WRONG_LAYER, LEFT_OUT = range(6)


@dataclass(frozen=True)
class Judgement:
    """Truth and mesh, pixel by pixel; n = width x height, rows from the lower left corner.

    Attributes
    ----------
    kind : (n,) uint8
        NOTHING (neither shows a reflection), SAME, HOLE, SPILL, WRONG_LAYER or LEFT_OUT.
    displacement : (n,) float64
        In pixels where both show a reflection, not a number elsewhere.
    shown : (n,) int64
        The face that the mesh shows, -1 where it shows none.
    position : (n, 3) float64
        The diffuse point that the mesh shows, zero where none.
    mirror_pixels : int
        Pixels that show the mirror, those left out not counted.
    numbers : dict
        What `judge` returns.
    """

    kind: np.ndarray
    displacement: np.ndarray
    shown: np.ndarray
    position: np.ndarray
    mirror_pixels: int
    numbers: dict


def judge(view: View, mirror: TriangleMesh, scene: TriangleMesh, reflection_mesh: ReflectionMesh,
          truth: Truth | None = None, **options) -> dict:
    """Displacement in pixels and coverage in % of the mirror's visible pixels; see `compare` for the options.

    Returns
    -------
    dict
        `median`, `p95`, `p99`, `maximum`: displacement in pixels over the `compared` pixels, where truth and mesh
        show the same surface, and `worst_pixel`, where the maximum is (column, row from below).
        `hole`, `spill`, `wrong_layer` and their sum `uncovered`: % of the `mirror_pixels`; `spill_outside` is the
        part of `spill` beyond the mirror's outline, `sunk` the part of `hole` where the mesh lies behind the mirror.
        `sees_itself`, `bent`: pixels left out, in % of all the pixels that show the mirror.
    """
    truth = trace(view, mirror, scene) if truth is None else truth
    return compare(view, mirror, reflection_mesh, truth, **options).numbers


def compare(view: View, mirror: TriangleMesh, mesh: ReflectionMesh, truth: Truth, *, placement: str = "LAYERED",
            single_precision: bool = False) -> Judgement:
    """Judge a mesh against the truth, pixel by pixel.

    Parameters
    ----------
    placement : {'LAYERED', 'SURFACE', 'VIRTUAL'}
        The mirror hides what lies behind it only from a LAYERED mesh.
    single_precision : bool
        Round the mesh's positions to float32 first, about the mirror's middle, as Blender would hold them.
    """
    positions = mesh.positions
    if single_precision:
        middle = mirror.positions[mirror.triangles.ravel()].mean(axis=0)
        positions = (positions - middle).astype(np.float32).astype(np.float64) + middle
    drawn = rasterise(view, positions, mesh.triangles)
    mirror_seen = truth.mirror_triangle >= 0
    hidden = np.where(mirror_seen, np.inf, truth.scene_depth)
    if placement == "LAYERED":
        hidden = np.minimum(truth.mirror_depth, truth.scene_depth)
    shows = (drawn.triangle >= 0) & (drawn.depth < hidden)
    position = np.where(shows[:, None], drawn.interpolate(mesh.reflected_position, mesh.triangles), 0.0)
    source = np.where(shows, mesh.source_face[np.maximum(drawn.triangle, 0)], -1) if len(mesh.source_face) \
        else np.full(len(shows), -1)
    shown = np.where(shows, drawn.triangle, -1)
    return _compared(view, truth, _Shown(source, position, shown, drawn.triangle >= 0))


def compare_picture(view: View, truth: Truth, triangle: np.ndarray, position: np.ndarray) -> Judgement:
    """Judge any picture of a reflection as a mesh is judged.

    Parameters
    ----------
    triangle : (height, width) int64
        The scene's triangle that each pixel shows, negative where it shows none; rows from below.
    position : (height, width, 3) float64
        The point on it.
    """
    source, position = triangle.reshape(-1), position.reshape(-1, 3)
    shows = source >= 0
    return _compared(view, truth, _Shown(source, np.where(shows[:, None], position, 0.0), np.where(shows, source, -1),
                                         shows))


@dataclass(frozen=True)
class _Shown:
    """What pixels (n,) show: the scene's triangle and the point on it (n, 3), the triangle of the mesh, -1 where that
    is none or hidden, and whether anything was drawn there."""

    source: np.ndarray
    position: np.ndarray
    triangle: np.ndarray
    drawn: np.ndarray


def _compared(view: View, truth: Truth, picture: _Shown) -> Judgement:
    shows, position = picture.triangle >= 0, picture.position
    mirror_seen = truth.mirror_triangle >= 0
    left_out = mirror_seen & (truth.sees_itself | truth.bent)
    counted = mirror_seen & ~left_out
    sees = counted & (truth.source_triangle >= 0)
    both = sees & shows
    displacement = np.full(len(shows), np.nan)
    displacement[both] = np.linalg.norm(position[both] - truth.position[both], axis=1) / truth.motion[both]
    wrong = both & (picture.source != truth.source_triangle) & (displacement > NEIGHBOUR)

    kind = np.full(len(shows), NOTHING, dtype=np.uint8)
    kind[both] = SAME
    kind[wrong] = WRONG_LAYER
    kind[sees & ~shows] = HOLE
    kind[shows & ~sees] = SPILL
    kind[left_out] = LEFT_OUT
    numbers = _numbers(view, truth, picture.drawn, kind, displacement)
    return Judgement(kind, displacement, picture.triangle, position, int(counted.sum()), numbers)


def _numbers(view: View, truth: Truth, drawn: np.ndarray, kind: np.ndarray, displacement: np.ndarray) -> dict:
    mirror_seen = truth.mirror_triangle >= 0
    same = np.flatnonzero(kind == SAME)
    pixels = displacement[same]
    median, p95, p99, maximum = np.percentile(pixels, (50, 95, 99, 100)) if len(pixels) else (np.nan,) * 4
    worst = same[np.argmax(pixels)] if len(pixels) else -1
    counted = int((mirror_seen & (kind != LEFT_OUT)).sum())
    share = 100.0 / max(counted, 1)
    hole, spill, wrong = (share * float((kind == k).sum()) for k in (HOLE, SPILL, WRONG_LAYER))
    return {
        "median": float(median), "p95": float(p95), "p99": float(p99), "maximum": float(maximum),
        "worst_pixel": (int(worst % view.resolution[0]), int(worst // view.resolution[0])),
        "hole": hole, "spill": spill, "wrong_layer": wrong, "uncovered": hole + spill + wrong,
        "spill_outside": share * float(((kind == SPILL) & ~mirror_seen).sum()),
        "sunk": share * float(((kind == HOLE) & drawn).sum()),
        "mirror_pixels": counted, "compared": len(same),
        "sees_itself": 100.0 * float((mirror_seen & truth.sees_itself).sum()) / max(int(mirror_seen.sum()), 1),
        "bent": 100.0 * float((mirror_seen & truth.bent).sum()) / max(int(mirror_seen.sum()), 1),
    }


def write_images(folder: str | Path, name: str, scene: TriangleMesh, mesh: ReflectionMesh, truth: Truth,
                 judgement: Judgement) -> list[Path]:
    """Write `<name>_error.png`, `<name>_kinds.png` and `<name>_picture.png` (mesh left, truth right) into `folder`.

    Errors are shown from black (0.001 pixels) over red (0.1) to white (10 and more). Kinds: grey the same surface,
    red a hole, yellow spill, blue a wrong layer, dark green left out.
    """
    from matplotlib import colormaps
    from matplotlib.image import imsave

    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    width, height = truth.resolution
    level = np.log10(np.maximum(np.nan_to_num(judgement.displacement, nan=0.0), 1e-3)) / 4.0 + 0.75
    error = colormaps["hot"](np.clip(level, 0.0, 1.0))[:, :3]
    error[np.isnan(judgement.displacement)] = (0.15, 0.2, 0.3)
    kinds = np.array([[0, 0, 0], [110, 110, 110], [255, 40, 40], [255, 230, 0], [40, 110, 255], [10, 60, 30]]) / 255.0
    source = np.where(judgement.shown >= 0, mesh.source_face[np.maximum(judgement.shown, 0)], -1) \
        if len(mesh.source_face) else judgement.shown
    cell = np.ptp(scene.positions[scene.triangles.ravel()], axis=0).max() / 24.0
    pictures = [_chequered(source, judgement.position, cell), _chequered(truth.source_triangle, truth.position, cell)]
    images = {"error": error.reshape(height, width, 3), "kinds": kinds[judgement.kind].reshape(height, width, 3),
              "picture": np.concatenate([picture.reshape(height, width, 3) for picture in pictures], axis=1)}
    paths = [folder / f"{name}_{what}.png" for what in images]
    for path, image in zip(paths, images.values(), strict=True):
        imsave(path, np.clip(image[::-1], 0.0, 1.0))
    return paths


def _chequered(triangle: np.ndarray, position: np.ndarray, cell: float) -> np.ndarray:
    """A colour for each source triangle, darker in every other cell of space; dark blue where there is none."""
    colours = np.random.default_rng(7).uniform(0.3, 1.0, (257, 3))[np.maximum(triangle, 0) % 257]
    # Half a cell off, so that no axis-aligned surface at the origin lies on a border between cells.
    dark = np.floor(position / cell + 0.37).astype(np.int64).sum(axis=1) % 2 == 1
    colours = np.where(dark[:, None], 0.55 * colours, colours)
    return np.where((triangle >= 0)[:, None], colours, (0.02, 0.02, 0.08))
