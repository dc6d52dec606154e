"""The pictures of docs/caustics.md: light that mirrors throw, by Cycles and by *Generate Caustics*.

    python -m tools.pictures.caustics [folder]

Leaves `caustics.jpg` in the folder, docs/pictures/ by default: above the sample `pool`, left by Cycles' own caustics,
right by meshes of light; below by meshes the samples `ring`, `sunlight` and `dish`. All have as many samples per
pixel, and are denoised.
"""
from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from PIL import Image

from tools import extension_zip

LARGE, SMALL, SAMPLES, GAP = 540, 356, 64, 6


def main(folder: Path) -> None:
    with extension_zip.installed() as scratch:
        above = [_rendered("pool", LARGE, own, scratch) for own in (True, False)]
        below = [_rendered(name, SMALL, False, scratch) for name in ("ring", "sunlight", "dish")]
    Image.fromarray(_stacked([_beside(above), _beside(below)])).save(folder / "caustics.jpg", quality=88)


def _rendered(name: str, size: int, own: bool, scratch: Path) -> np.ndarray:
    """A sample with Cycles' own caustics or with ours, (size, size, 3) bytes."""
    import bpy
    bpy.ops.wm.open_mainfile(filepath=str(extension_zip.ROOT / "sample_blends" / f"{name}.blend"))
    scene = bpy.context.scene
    scene.render.resolution_x = scene.render.resolution_y = size
    scene.cycles.samples, scene.cycles.use_denoising = SAMPLES, True
    if own:
        # nothing that keeps Cycles from finding them
        scene.cycles.caustics_reflective = True
        scene.cycles.blur_glossy = scene.cycles.sample_clamp_indirect = 0.0
    else:
        bpy.ops.reflection_mesh.caustics()
    scene.render.filepath = str(scratch / "seen.png")
    bpy.ops.render.render(write_still=True)
    return np.asarray(Image.open(scene.render.filepath).convert("RGB"))


def _beside(pictures: list[np.ndarray]) -> np.ndarray:
    """Pictures of one height, with white gaps between them."""
    gap = np.full((len(pictures[0]), GAP, 3), 255, dtype=np.uint8)
    return np.concatenate([part for picture in pictures for part in (gap, picture)][1:], axis=1)


def _stacked(rows: list[np.ndarray]) -> np.ndarray:
    """Rows as wide as the widest, with white gaps between them."""
    width = max(row.shape[1] for row in rows)
    padded = [np.pad(row, ((0, GAP), (0, width - row.shape[1]), (0, 0)), constant_values=255) for row in rows]
    return np.concatenate(padded)[:-GAP]


if __name__ == "__main__":
    main(Path(sys.argv[1]) if sys.argv[1:] else extension_zip.ROOT / "docs" / "pictures")
