"""One scene tried whose mirror throws a lamp's light: the light as a mesh beside what Cycles finds; then cleared."""
from __future__ import annotations

import contextlib
from collections.abc import Iterator
from pathlib import Path

import bpy
import numpy as np

from tests.fuzz.blender import scene_trial
from tests.fuzz.blender.pictures import as_srgb, heard, mirror_pixels, rendered, save
from tests.fuzz.blender.scene_state import differences, state, without
from tests.fuzz.blender.scenes import select
from tests.fuzz.blender.thrown_scenes import SIZE, thrown_scene

SECONDS = 120.0  # of processor time
CELLS = 4        # across the picture, in which the light is told apart
WHOLE, EACH = 0.05, 0.15  # of the light in all of the picture, and in one cell, by which it may be off
NEXT = 0.03      # of the mean of all cells besides: places on the lamp are few, and light ends in steps
NOISE = 5.0      # times the standard error of Cycles' pictures
FOUND = 3        # of the brightest pixels of its noise: where a lamp is found by so few of its rays they tell nothing
BESIDE = 2       # pixels round the mirror, in which it still shows the lamp
# where a result is told to lack what this has
TOLD = ("counts as one", "not known all over", "Light ends at", "is coarse and shaded smooth",
        "of the light that the mirror throws is missing")
DARK = "throws none of the lamp's light"


def tried_thrown(seed: int, keep: Path | None = None) -> dict:
    """What the scene of a seed is called, how it was refused, and all that is wrong, each "what: how".

    Parameters
    ----------
    keep : Path, optional
        A folder for three pictures, as PNG: Cycles' own, the result, and the lamp's light alone.
    """
    scene = thrown_scene(seed)
    cycles = bpy.context.scene.cycles
    cycles.caustics_reflective = False  # so that nothing of Cycles' own is left out
    before, inside = state(), mirror_pixels(scene.mirrors)
    with heard() as words:
        outcome = scene_trial._called("caustics", SECONDS, **scene.options)
    dark, told = DARK in outcome, any(sentence in "".join(words) for sentence in TOLD)
    if outcome and not dark:
        return {"name": scene.name, "refusal": outcome, "problems": scene_trial._refusal_problems(outcome)}
    results = [obj for obj in bpy.data.objects if obj.reflection_mesh.role == "CAUSTICS"]
    cycles.caustics_reflective = True
    with _lamps_leave(scene.mirrors):
        shown = rendered(0)
        for result in results:
            result.hide_render = True
        alone = rendered(1)
    pair = rendered(2), rendered(3)
    cycles.caustics_reflective = False
    if keep is not None:
        for name, picture in (("cycles", pair[0]), ("result", shown), ("alone", alone)):
            save(keep / f"{seed}_{name}.png", as_srgb(picture))
    ratio, found = compared(shown, pair, alone, ~_widened(inside))
    problems = [] if told else found
    for result in results:
        result.hide_render = False
    if results:
        select([], bpy.context.view_layer.objects.active)
        outcome = scene_trial._called("clear")
        # any render leaves its result as an image
        problems += [f"clear: {outcome}"] if outcome else [
            f"clear: {one}" for one in differences(without(before, "active", "selected", "images"), state())]
    return {"name": f"{scene.name}: {ratio:.2f} of Cycles' light{', told' * told}", "refusal": "",
            "problems": problems}


def compared(shown: np.ndarray, pair: tuple[np.ndarray, np.ndarray], alone: np.ndarray,
             asked: np.ndarray) -> tuple[float, list[str]]:
    """How much of Cycles' light a picture shows, and where that is not as much: as its own pictures, a `pair` with
    different noise, in the pixels `asked` (SIZE, SIZE); `alone` is the lamp's light without the mirror's."""
    true = 0.5 * (pair[0] + pair[1])
    side = SIZE // CELLS

    def cells(values: np.ndarray) -> np.ndarray:
        return (values * asked[..., None]).reshape(CELLS, side, CELLS, side, 3).sum(axis=(1, 3))
    off, light, variance = cells(shown - true), cells(true - alone), cells((0.5 * (pair[0] - pair[1]))**2)
    # the result and the light alone are as noisy as Cycles is where the mirror throws none
    spark = (np.abs(pair[0] - pair[1]) * asked[..., None]).max(axis=(0, 1))
    found, mean = [], np.abs(light.sum(axis=(0, 1))) / CELLS**2
    astray = np.abs(off) - (EACH * np.abs(light) + NEXT * CELLS**2 * mean / 2.0 + FOUND * spark
                            + NOISE * np.sqrt(2.0 * variance))
    whole = np.abs(off.sum(axis=(0, 1))) - (WHOLE * CELLS**2 * mean + FOUND * spark
                                            + NOISE * np.sqrt(2.0 * variance.sum(axis=(0, 1))))
    ratio = 1.0 + off.sum() / max(light.sum(), 1e-9)
    if (whole > 0.0).any():
        found.append(f"thrown: {ratio:.2f} of Cycles' light, by colour "
                     + ", ".join(f"{one:.2f}" for one in 1.0 + off.sum(axis=(0, 1)) / light.sum(axis=(0, 1))))
    if (astray > 0.0).any():
        row, column, colour = np.unravel_index(np.argmax(astray), astray.shape)
        found.append(f"thrown in a cell: {light[row, column, colour] + off[row, column, colour]:.3g} in cell {row}, "
                     f"{column} of colour {colour}, where Cycles has {light[row, column, colour]:.3g}")
    return float(ratio), found


def _widened(inside: np.ndarray) -> np.ndarray:
    """With the pixels beside those (SIZE, SIZE)."""
    wide = np.pad(inside, BESIDE)
    return np.any([np.roll(wide, (row, column), (0, 1)) for row in range(-BESIDE, BESIDE + 1)
                   for column in range(-BESIDE, BESIDE + 1)], axis=0)[BESIDE:-BESIDE, BESIDE:-BESIDE]


@contextlib.contextmanager
def _lamps_leave(mirrors: list) -> Iterator[None]:
    """Lamps do not light mirrors, so that Cycles finds no caustics of these."""
    left = bpy.data.collections.new("Left Out")
    for mirror in mirrors:
        left.objects.link(mirror)
    for entry in left.collection_objects:
        entry.light_linking.link_state = "EXCLUDE"
    lamps = [obj for obj in bpy.context.scene.objects if obj.type == "LIGHT"]
    for lamp in lamps:
        lamp.light_linking.receiver_collection = left
    try:
        yield
    finally:
        for lamp in lamps:
            lamp.light_linking.receiver_collection = None
        bpy.data.collections.remove(left)
