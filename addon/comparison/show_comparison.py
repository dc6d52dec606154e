"""Shows a comparison in Blender: its pictures in the Image Editor, its numbers in the panel."""
from __future__ import annotations

import os
from pathlib import Path

import bpy
from bpy.app.translations import pgettext_iface

from ..writing import records

REFLECTION_PICTURES = ("reference", "displacement", "difference", "holes", "result")
"""The pictures of a comparison of reflections, the result last."""
# by scene and record, so that undo leads back to the page of the numbers that are shown
_pages: dict[tuple[int, str], str] = {}


def load_pictures(folder: str, names: tuple[str, ...]) -> list[bpy.types.Image]:
    """Return the folder's pictures of these names as images 'Reflection Comparison ...'. Those of an earlier comparison
    are reloaded.
    """
    images = []
    for name in names:
        title = name.replace("_", " ").title()
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
    """Keep what the panel shows of a report in the scene; where its page lies, this session alone knows."""
    text = records.light_text(report) if "light" in report else records.comparison_text(report)
    scene.reflection_mesh.comparison = text
    _pages[scene.session_uid, text] = Path(folder, "report.html").as_uri()


def lines(scene: bpy.types.Scene) -> list[str]:
    """Return the last comparison in a few short lines; empty if there was none."""
    text = scene.reflection_mesh.comparison
    known, light = records.comparison(text), records.light_comparison(text)
    if light is not None:
        return _of_light(light)
    if known is None:
        return []
    width, height = known.resolution
    told = [pgettext_iface("Against Cycles at {width} x {height}").format(width=width, height=height)]
    if known.p99 is not None:
        told.append(pgettext_iface("Displacement {median:.3f} px, 99 %: {most:.3f} px").format(median=known.median,
                                                                                               most=known.p99))
    told.append(pgettext_iface("No mirror pixels to judge") if known.coverage is None else pgettext_iface(
        "Holes, spill, wrong layer {share:.3f} %").format(share=known.coverage))
    if known.ssim is not None:
        told.append(f"SSIM {known.ssim:.4f}, FLIP {known.flip:.4f}"
                    + (f", PSNR {known.psnr:.1f} dB" if known.psnr is not None else ""))
    return told


def _of_light(known: records.LightComparison) -> list[str]:
    width, height = known.resolution
    told = [pgettext_iface("Against Cycles at {width} x {height}").format(width=width, height=height)]
    if known.psnr is not None and known.psnr_own is not None:
        told.append(pgettext_iface("Caustics PSNR {mesh:.1f} dB; Cycles' own, {samples} samples: {own:.1f} dB").format(
            mesh=known.psnr, samples=known.samples, own=known.psnr_own))
    if known.flux is not None:
        told.append(pgettext_iface("Flux {flux:+.3f} % from rays").format(flux=known.flux))
    return told


def page_address(scene: bpy.types.Scene) -> str:
    """The address of the page of the comparison that `lines` tells of; empty where it was not made in this session.

    An address that a file brings might lead anywhere, and looking for it at every redraw would ask there.
    """
    return _pages.get((scene.session_uid, scene.reflection_mesh.comparison), "")
