"""One lit scene tried: reflected, lit, and its picture compared with what Cycles shows of the mirror; then cleared."""
from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import bpy
import numpy as np

from tests.fuzz.blender import scene_trial
from tests.fuzz.blender.lit_scenes import lit_scene
from tests.fuzz.blender.pictures import as_srgb, heard, mirror_pixels, rendered, save
from tests.fuzz.blender.scene_state import differences, state, without
from tests.fuzz.blender.scenes import select

SECONDS = 120.0  # of processor time
WANTED = 38.0    # dB over the mirror's pixels
NEARLY = 1.5     # dB that Cycles may be nearer to itself, where its noise is more than that
WORST = 0.005    # of the pixels, which are left out
FEW = 60         # pixels: a mirror of which less is seen says nothing
TOLD = "which a reflection does not follow"  # where a result is told to lack something


@dataclass(frozen=True)
class Judged:
    """PSNR in dB over the mirror, of the lit result and of Cycles with other noise; and how many pixels that are."""

    lit: float
    own: float
    pixels: int

    @property
    def wrong(self) -> bool:
        return self.pixels >= FEW and self.lit < min(WANTED, self.own - NEARLY)


def tried_lit(seed: int, keep: Path | None = None) -> dict:
    """What the scene of a seed is called, how it was refused, and all that is wrong, each "what: how".

    Parameters
    ----------
    keep : Path, optional
        A folder for the three pictures, as PNG: the mirror, the mirror with other noise, and the result.
    """
    scene = lit_scene(seed)
    before, reference, again, inside = state(), _picture(0), _picture(1), mirror_pixels(scene.mirrors)
    problems: list[str] = []
    with heard() as words:
        outcome = (scene_trial._called("generate", SECONDS, **scene.options["generate"])
                   or scene_trial._called("light", SECONDS, **scene.options["light"]))
    told = TOLD in "".join(words)
    if outcome:
        problems += scene_trial._refusal_problems(outcome)
    shown = _picture(2)
    judged = Judged(_psnr(shown, reference, inside), _psnr(again, reference, inside), int(inside.sum()))
    if judged.wrong and not outcome and not told:
        problems.append(f"light: {judged.lit:.1f} dB, Cycles with other noise {judged.own:.1f}")
    if keep is not None:
        for name, picture in (("mirror", reference), ("again", again), ("result", shown)):
            save(keep / f"{seed}_{name}.png", picture)
    if any(obj.reflection_mesh.role == "REFLECTION" for obj in bpy.data.objects):
        problems += _cleared(before)
    return {"name": f"{scene.name}: {judged.lit:.1f} dB, {judged.own:.1f} is noise", "refusal": outcome,
            "problems": problems}


def _cleared(before: dict) -> list[str]:
    select([], bpy.context.view_layer.objects.active)
    outcome = scene_trial._called("clear")
    if outcome:
        return [f"clear: {outcome}"]
    # any render leaves its result as an image
    return [f"clear: {one}" for one in differences(without(before, "active", "selected", "images"), state())]


def _picture(seed: int) -> np.ndarray:
    """The file's own picture in sRGB."""
    return as_srgb(rendered(seed))


def _psnr(one: np.ndarray, other: np.ndarray, inside: np.ndarray) -> float:
    """Over all pixels of `inside` but the worst: of a lamp's glint a pixel's noise says nothing."""
    squares = np.sort(((one - other)[inside]**2).mean(axis=1))
    squares = squares[: len(squares) - int(np.ceil(WORST * len(squares)))]
    return float(-10.0 * np.log10(1e-12 + squares.mean())) if len(squares) else np.inf
