"""Measure the errors of a method in two ways: at the pixels' centres, and over the area of the pixels.

A picture is more than its pixels' centres. A ray tracer is exact there by definition, since the ground truth is traced
along the same rays. Between them it shows its nearest sample. A mesh is defined everywhere. So both are also compared
at random places in the pixels.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...core.rivals import RivalPicture
from ..metrics import OTHER_SURFACE, percentages
from .case import Case
from .truth import Truth

WRONG = ("hole", "spill", "wrong_layer")


@dataclass(frozen=True)
class Sampled:
    """The output of a method: a picture with `across` x `across` samples per pixel, or a mesh, which is part of the
    picture.
    """

    picture: RivalPicture
    across: int = 1


def look(made: Sampled, truth: Truth) -> tuple[np.ndarray, np.ndarray]:
    """Return the triangle (n,), negative for none, and the position (n, 3) that a method shows at the places of a
    truth.
    """
    width, height = truth.view.resolution
    picture = made.picture
    if picture.mesh is not None:
        triangle, position = np.full(width * height, -1), np.zeros((width * height, 3))
        pixel, shown, place = picture.mesh.seen(truth.view, truth.mirror_depth, truth.scene_depth)
        triangle[pixel], position[pixel] = shown, place.T
        return triangle, position
    lines, columns = picture.triangle.shape
    x = np.clip(np.floor(truth.columns * made.across), 0, columns - 1).astype(np.int64)
    y = np.clip(np.floor(truth.rows * made.across), 0, lines - 1).astype(np.int64)
    sample = (y[:, None] * columns + x).ravel()
    return picture.triangle.ravel()[sample], picture.position.reshape(-1, 3)[sample]


def errors(case: Case, truths: list[Truth], made: Sampled) -> dict:
    """Return displacement and coverage of a method's output at all places of the truths that show a part of the scene.

    Returns
    -------
    dict
        `mean_error_px`: the displacement, at most one pixel, averaged over the places at which the truth shows the
        scene; a hole or a wrong layer counts as one there, and each place of spill adds one. `displacement_px`:
        median, p95, p99 and max where the same surface is shown. `coverage_percent`: hole, spill, wrong layer and
        all, of the judged places of the mirror. All as `pixel_errors.measure` defines them.
    """
    tallies = [_tally(case, truth, *look(made, truth)) for truth in truths]
    displacement = np.concatenate([tally.pop("displacement") for tally in tallies])
    count = {name: sum(tally[name] for tally in tallies) for name in tallies[0]}
    asked = len(displacement) + count["hole"] + count["wrong_layer"]
    wrong = sum(count[name] for name in WRONG)
    values = dict.fromkeys(("median", "p95", "p99", "max"))
    if len(displacement):
        values = dict(zip(values, map(float, np.percentile(displacement, (50, 95, 99, 100)))))
    return {"mean_error_px": float((np.minimum(displacement, 1.0).sum() + wrong) / asked), "displacement_px": values,
            "coverage_percent": percentages({name: count[name] for name in WRONG}, count["judged"])}


def _tally(case: Case, truth: Truth, triangle: np.ndarray, position: np.ndarray) -> dict:
    drawn = triangle >= 0
    spill = drawn & (truth.empty | ~truth.mirror)
    both = drawn[truth.pixel]
    pixel = truth.pixel[both]
    shown = triangle[pixel]
    displacement = np.linalg.norm(position[pixel] - truth.position[both], axis=1) / truth.motion[both]
    face, true_face = case.polygon[shown], truth.face[both]
    elsewhere = case.scene.source_object[shown] != truth.source[both]
    elsewhere |= (face != true_face) & (face >= 0) & (true_face >= 0)
    # without a neighbour there is no scale: another face is then taken for another surface
    wrong = elsewhere & ~(displacement <= OTHER_SURFACE)
    return {"displacement": displacement[~wrong & np.isfinite(displacement)], "judged": int(truth.judged.sum()),
            "hole": len(truth.pixel) - len(pixel), "spill": int(spill.sum()), "wrong_layer": int(wrong.sum())}
