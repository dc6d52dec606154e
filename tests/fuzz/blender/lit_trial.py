"""One lit scene tried: reflected, lit, and its picture compared with what Cycles shows of the mirror; then cleared."""
from __future__ import annotations

import contextlib
import os
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import bpy
import numpy as np
from mathutils import Vector

from tests.fuzz.blender import scene_trial
from tests.fuzz.blender.lit_scenes import SIZE, lit_scene
from tests.fuzz.blender.scene_state import differences, state, without
from tests.fuzz.blender.scenes import select

SECONDS = 120.0  # of processor time
WANTED = 38.0    # dB over the mirror's pixels
NEARLY = 1.5     # dB that Cycles may be nearer to itself, where its noise is more than that
WORST = 0.005    # of the pixels, which are left out
FEW = 60         # pixels: a mirror of which less is seen says nothing
TOLD = "Light: Picture"  # where a result is told to lack what this has


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
    before, reference, again, inside = state(), _picture(0), _picture(1), _mirror_pixels(scene.mirrors)
    problems: list[str] = []
    with _heard() as words:
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
            _save(keep / f"{seed}_{name}.png", picture)
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
    """The file's own picture in sRGB, (height, width, 3), from the lowest row up."""
    scene = bpy.context.scene
    kept = scene.cycles.seed, scene.render.filepath
    with tempfile.TemporaryDirectory() as folder:
        path = str(Path(folder) / "picture.exr")
        scene.cycles.seed, scene.render.filepath = seed, path
        try:
            bpy.ops.render.render(write_still=True)
        finally:
            scene.cycles.seed, scene.render.filepath = kept
        image = bpy.data.images.load(path)
        pixels = np.empty(len(image.pixels), dtype=np.float32)
        image.pixels.foreach_get(pixels)
        bpy.data.images.remove(image)
    linear = np.clip(pixels.reshape(SIZE, SIZE, -1)[..., :3], 0.0, 1.0).astype(np.float64)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 1e-9)**(1.0 / 2.4) - 0.055)


def _mirror_pixels(mirrors: list) -> np.ndarray:
    """Where the camera sees a mirror at a pixel's middle, (SIZE, SIZE) bool, the lowest row first."""
    scene, camera = bpy.context.scene, bpy.context.scene.camera
    depsgraph, eye = bpy.context.evaluated_depsgraph_get(), camera.matrix_world.translation
    right_top, right, left, _ = (camera.matrix_world @ corner for corner in camera.data.view_frame(scene=scene))
    ahead = camera.matrix_world.to_3x3() @ Vector((0.0, 0.0, -1.0))
    steps = ((np.arange(SIZE) + 0.5) / SIZE).tolist()

    def seen(x: float, y: float) -> bool:
        place = left + x * (right - left) + y * (right_top - right)
        start, way = (place, ahead) if camera.data.type == "ORTHO" else (eye, place - eye)
        return scene.ray_cast(depsgraph, start, way)[4] in mirrors
    return np.array([[seen(x, y) for x in steps] for y in steps])


def _psnr(one: np.ndarray, other: np.ndarray, inside: np.ndarray) -> float:
    """Over all pixels of `inside` but the worst: of a lamp's glint a pixel's noise says nothing."""
    squares = np.sort(((one - other)[inside]**2).mean(axis=1))
    squares = squares[: len(squares) - int(np.ceil(WORST * len(squares)))]
    return float(-10.0 * np.log10(1e-12 + squares.mean())) if len(squares) else np.inf


@contextlib.contextmanager
def _heard() -> Iterator[list[str]]:
    """Collect what Blender prints, where the sentences of operators go in the background."""
    words: list[str] = []
    with tempfile.TemporaryFile("w+b") as file:
        kept = os.dup(1)
        os.dup2(file.fileno(), 1)
        try:
            yield words
        finally:
            os.dup2(kept, 1)
            os.close(kept)
            file.seek(0)
            words.append(file.read().decode(errors="replace"))


def _save(path: Path, picture: np.ndarray) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    image = bpy.data.images.new("Kept", SIZE, SIZE)
    pixels = np.ones((SIZE, SIZE, 4), dtype=np.float32)
    pixels[..., :3] = picture
    image.pixels.foreach_set(pixels.ravel())
    image.filepath_raw, image.file_format = str(path), "PNG"
    image.save()
    bpy.data.images.remove(image)
