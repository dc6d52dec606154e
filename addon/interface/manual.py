"""Links of *Online Manual* for the operators and settings of this extension."""
from __future__ import annotations

from pathlib import Path

import bpy

# `make zip` puts the manual's pages into the zip; an extension that Blender built itself has none
CARRIED = Path(__file__).resolve().parents[2] / "manual" / "manual.html"
PAGES = (
    ("bpy.ops.reflection_mesh.*", "#operators"),
    ("bpy.types.reflectionscene.*", "#settings"),
    ("bpy.types.reflectionlive.*", "#operators"),
    ("bpy.types.reflectionobject.role", "#roles"),
    # other properties of a mirror
    ("bpy.types.reflectionobject.*", "#settings"),
)


def pages() -> tuple[str, tuple]:
    """Return the address of the manual, and its places by the names that they explain; nothing without its pages."""
    return (CARRIED.as_uri(), PAGES) if CARRIED.is_file() else ("", ())


def register() -> None:
    bpy.utils.register_manual_map(pages)


def unregister() -> None:
    bpy.utils.unregister_manual_map(pages)
