"""What *Online Manual* opens for the operators and settings of this extension."""
from __future__ import annotations

from pathlib import Path

import bpy

# the zip carries the manual's pages; who installs the sources themselves has the extension's website, which the
# manifest names too
CARRIED = Path(__file__).resolve().parents[2] / "manual" / "manual.html"
WEBSITE = "https://extensions.blender.org/add-ons/reflection-mesh/"
PAGES = (
    ("bpy.ops.reflection_mesh.*", "#operators"),
    ("bpy.types.reflectionscene.*", "#settings"),
    ("bpy.types.reflectionlive.*", "#operators"),
    ("bpy.types.reflectionobject.role", "#roles"),
    # of a mirror's own
    ("bpy.types.reflectionobject.*", "#settings"),
)


def pages() -> tuple[str, tuple]:
    """The address of the manual, and what of it tells of which names."""
    return CARRIED.as_uri() if CARRIED.is_file() else WEBSITE, PAGES


def register() -> None:
    bpy.utils.register_manual_map(pages)


def unregister() -> None:
    bpy.utils.unregister_manual_map(pages)
