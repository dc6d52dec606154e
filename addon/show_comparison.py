"""Shows a comparison in Blender: its pictures in the Image Editor, its numbers in the panel."""
from __future__ import annotations

import json
import os
from pathlib import Path

import bpy

TITLES = {"reference": "Reference", "displacement": "Displacement", "difference": "Difference", "holes": "Holes",
          "result": "Result"}


def load_pictures(folder: str) -> list[bpy.types.Image]:
    """The folder's pictures as images 'Reflection Comparison ...'; those of an earlier comparison are loaded anew."""
    images = []
    for name, title in TITLES.items():
        path = os.path.join(folder, f"{name}.png")
        known = bpy.data.images.get(f"Reflection Comparison {title}")
        if known is not None and known.library is None and known.source == "FILE":
            known.filepath = path
            known.reload()
            images.append(known)
            continue
        image = bpy.data.images.load(path)
        image.name = f"Reflection Comparison {title}"
        images.append(image)
    return images


def show_picture(window_manager: bpy.types.WindowManager, image: bpy.types.Image) -> bool:
    """Show an image in an Image Editor that is open; where none is, nothing is opened. Says whether one was."""
    for window in window_manager.windows:
        for area in window.screen.areas:
            if area.type == "IMAGE_EDITOR" and area.ui_type == "IMAGE_EDITOR" and not area.spaces.active.use_image_pin:
                area.spaces.active.image = image
                return True
    return False


def remember(scene: bpy.types.Scene, report: dict, folder: str) -> None:
    """Keep what the panel shows of a report in the scene."""
    picture = report["picture"]["mirror"]
    scene.reflection_mesh.comparison = json.dumps({
        "results": report["results"], "folder": folder, "resolution": report["resolution"],
        "median": report["displacement_px"]["median"], "p99": report["displacement_px"]["p99"],
        "coverage": report["coverage_percent"]["all"], "psnr": picture["psnr"], "ssim": picture["ssim"],
        "flip": picture["flip"]})


def lines(scene: bpy.types.Scene) -> list[str]:
    """The last comparison in a few short lines; none where nothing was compared."""
    known = json.loads(scene.reflection_mesh.comparison or "{}")
    if not known:
        return []
    width, height = known["resolution"]
    told = [f"Against Cycles at {width} x {height}"]
    if known["p99"] is not None:
        told.append(f"Displacement {known['median']:.3f} px, 99 %: {known['p99']:.3f} px")
    told.append(f"Holes, spill, wrong layer {known['coverage']:.3f} %")
    if known["ssim"] is not None:
        told.append(f"SSIM {known['ssim']:.4f}, FLIP {known['flip']:.4f}"
                    + (f", PSNR {known['psnr']:.1f} dB" if known["psnr"] is not None else ""))
    return told


def page_address(scene: bpy.types.Scene) -> str:
    """The address of the last comparison's page; empty where it is gone."""
    known = json.loads(scene.reflection_mesh.comparison or "{}")
    path = Path(known.get("folder", ""), "report.html")
    return path.as_uri() if known and path.is_file() else ""
