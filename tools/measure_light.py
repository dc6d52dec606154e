"""One table of the errors of lit reflections beside Cycles tracing the mirrors. tools.timing.light_ratio has the times.

    python -m tools.measure_light [name or path of a .blend ...] [--side 144] [--samples 128] [--folder FOLDER]

Errors are PSNR in sRGB over the mirrors' pixels, beside Cycles tracing the mirrors: of Cycles with other noise, of the
lit file in Cycles and in EEVEE, and of these two beside each other. The lit file is rendered with its mirrors
invisible to camera and glossy rays.
"""
from __future__ import annotations

import argparse
import sys
from functools import partial
from pathlib import Path

import numpy as np

from tools import extension_zip
from tools.quietly import quietly

ROWS = ("sample", "noise dB", "lit dB", "EEVEE dB", "EEVEE beside Cycles, lit dB")
NAMES = ("room", "bathroom", "pond", "anamorphosis", "water", "sphere")
EEVEE_SAMPLES = 32


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenes", nargs="*", default=NAMES)
    parser.add_argument("--side", type=int, default=144, help="pixels along the longer side of the picture")
    parser.add_argument("--samples", type=int, default=128)
    parser.add_argument("--folder", type=Path, help="keep pictures here: Cycles, Cycles lit, EEVEE lit")
    options = parser.parse_args(arguments)
    print(f"| {' | '.join(ROWS)} |\n|{'---|' * len(ROWS)}", flush=True)
    with extension_zip.installed():
        for scene in options.scenes:
            path = Path(scene) if scene.endswith(".blend") else extension_zip.ROOT / "sample_blends" / f"{scene}.blend"
            name, *numbers = quietly(partial(measured, path.resolve(), options))
            print(f"| {name} | {' | '.join(f'{number:.2f}' for number in numbers)} |", flush=True)
    return 0


def measured(path: Path, options: argparse.Namespace) -> list:
    """Return one row of the table."""
    import bpy
    from bl_ext.user_default.reflection_mesh.addon.reading import mirrors_of
    bpy.ops.wm.open_mainfile(filepath=str(path))
    scene = bpy.context.scene
    size = scene.render.resolution_x, scene.render.resolution_y
    scene.render.resolution_x, scene.render.resolution_y = (round(options.side * one / max(size)) for one in size)
    scene.render.resolution_percentage = 100
    traced = _picture(options.samples)
    other = _picture(options.samples, seed=1)
    bpy.ops.reflection_mesh.generate()
    bpy.ops.reflection_mesh.light(samples=options.samples)
    results = [obj for obj in scene.objects if obj.reflection_mesh.role == "REFLECTION"]
    mirrors = {mirror for result in results for mirror in mirrors_of(result)}
    for mirror in mirrors:
        mirror.visible_camera = mirror.visible_glossy = False
    lit = _picture(options.samples, seed=2)
    eevee = _picture(EEVEE_SAMPLES, engine="BLENDER_EEVEE_NEXT" if bpy.app.version < (5, 0, 0) else "BLENDER_EEVEE")
    inside = _pixels_of(mirrors, results)
    if options.folder:
        _save(options.folder / f"{path.stem}.png", np.concatenate((traced, lit, eevee), axis=1))
    pairs = (other, traced), (lit, traced), (eevee, traced), (eevee, lit)
    return [path.stem, *(psnr(one[inside], another[inside]) for one, another in pairs)]


def psnr(one: np.ndarray, other: np.ndarray) -> float:
    """Return the peak signal-to-noise ratio in dB of pictures with a peak of 1."""
    return float(-10.0 * np.log10(((one - other)**2).mean()))


def _picture(samples: int, seed: int = 0, engine: str = "CYCLES") -> np.ndarray:
    """Render the open file, (height, width, 3) in sRGB, lowest row first."""
    return _srgb(_render(samples, seed, engine)[..., :3])


def _pixels_of(mirrors: set, results: list) -> np.ndarray:
    """Return True for pixels in which the camera sees mirrors, (height, width); these are holdouts from then on."""
    for result in results:
        result.hide_render = True
    for mirror in mirrors:
        mirror.visible_camera = mirror.is_holdout = True
    return _render(4, 0, "CYCLES")[..., 3] < 0.5


def _render(samples: int, seed: int, engine: str) -> np.ndarray:
    """Render a copy of the scene without denoising, (height, width, 4) in linear light."""
    import bpy
    from bl_ext.user_default.reflection_mesh.addon.rendering import rendered, with_cycles
    scene = bpy.context.scene.copy()
    try:
        with_cycles(scene)
        scene.render.engine, scene.cycles.samples, scene.cycles.seed = engine, samples, seed
        scene.cycles.use_denoising = scene.cycles.use_adaptive_sampling = False
        scene.eevee.taa_render_samples = samples
        return rendered(scene)
    finally:
        bpy.data.scenes.remove(scene)


def _srgb(linear: np.ndarray) -> np.ndarray:
    linear = np.clip(linear, 0.0, 1.0)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 1e-9)**(1 / 2.4) - 0.055)


def _save(path: Path, picture: np.ndarray) -> None:
    from PIL import Image
    path.parent.mkdir(parents=True, exist_ok=True)
    Image.fromarray(np.round(255.0 * picture[::-1]).astype(np.uint8)).save(path)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
