"""What *Online Manual* opens for the operators and settings of this extension."""
from __future__ import annotations

import bpy

# where the manual lies; the manifest names the same place as the extension's website
MANUAL = "https://extensions.blender.org/add-ons/reflection-mesh/"
PAGES = (
    ("bpy.ops.reflection_mesh.*", "#operators"),
    ("bpy.types.reflectionscene.*", "#settings"),
    ("bpy.types.reflectionobject.*", "#roles"),
)


def pages() -> tuple[str, tuple]:
    """The address of the manual, and what of it tells of which names."""
    return MANUAL, PAGES


def register() -> None:
    bpy.utils.register_manual_map(pages)


def unregister() -> None:
    bpy.utils.unregister_manual_map(pages)
