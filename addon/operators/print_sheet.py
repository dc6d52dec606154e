"""The operator that saves a sheet with its anamorphic picture as a file to print."""
from __future__ import annotations

import os

import bpy

from ...core import ReflectionError, in_steps
from .. import compat
from ..anamorphosis import UV_MAP, encoded, flat_sheet, load_picture, picture_of, pixels_of, print_size, printed
from ..faults import AllOrNothing, BrowsingOperator, Steps, part, tell
from ..files import check_place, staged
from . import polls

KINDS = (".png", ".svg")
DPI, FEWEST, MOST = 150.0, 10.0, 2400.0


def printing(context: bpy.types.Context, obj: bpy.types.Object | None, path: str, picture: str = "",
             dpi: float = DPI) -> Steps[str]:
    """Save the flat object `obj` as a picture to print at the absolute `path`; returns a sentence on it.

    Parameters
    ----------
    picture : str
        An image of the file that is open or the path of one; empty for what the object shows.

    Raises
    ------
    ReflectionError
        Where there is nothing to print or no place for it; nothing has been written then.
    """
    yield 0.0, "Reading the sheet"
    if obj is None:
        raise ReflectionError(polls.NO_SHEET)
    check_print(path, dpi)
    sheet = flat_sheet(obj, context.scene.unit_settings.scale_length)
    width, height = print_size(sheet, dpi)
    with AllOrNothing() as whole:
        image = load_picture(picture, whole) if picture else picture_of(obj)
        if image is None:
            raise ReflectionError(f"'{obj.name}' shows no picture by its UV map '{UV_MAP}': choose one to print.")
        pixels = yield from part(printed(sheet, pixels_of(image), dpi), 0.05, 0.75)
        svg = path.lower().endswith(".svg")
        data = yield from part(in_steps(lambda: encoded(pixels, sheet, dpi, svg)), 0.8, 0.15, "Packing the picture")
        yield 0.95, "Writing"
        with staged(os.path.dirname(path)) as scratch:
            with open(os.path.join(scratch, os.path.basename(path)), "wb") as file:
                file.write(data)
    size = " x ".join(f"{100.0 * side:.1f}" for side in sheet.size)
    return f"{path}: {size} cm, {width} x {height} pixels; print it at 100 %"


def check_print(path: str, dpi: float) -> None:
    """Check that a sheet can be saved at the absolute `path`, as far as possible in advance.

    Raises
    ------
    ReflectionError
        If it cannot.
    """
    if os.path.splitext(path)[1].lower() not in KINDS:
        raise ReflectionError(f"'{path}' is neither a .png nor a .svg file: name one of them.")
    if not FEWEST <= dpi <= MOST:
        raise ReflectionError(f"A print has {FEWEST:g} to {MOST:g} dots per inch: choose 150 or 300.")
    check_place(path)


class REFLECTION_MESH_OT_print_sheet(BrowsingOperator, bpy.types.Operator):
    """Save the active flat object with its image as a PNG or SVG file, to print at its real size"""

    bl_idname = "reflection_mesh.print_sheet"
    bl_label = "Save Sheet to Print"
    bl_options = {"REGISTER"}

    filepath: bpy.props.StringProperty(name="File", description="PNG or SVG file", default="//sheet.png",
                                       subtype="FILE_PATH", options=compat.RELATIVE_PATH)
    filter_glob: bpy.props.StringProperty(default="*.png;*.svg", options={"HIDDEN"})
    picture: bpy.props.StringProperty(name="Picture", description="Image in this file or image file. Empty uses the "
                                                                  "image that the object shows", options={"SKIP_SAVE"})
    dpi: bpy.props.FloatProperty(name="Dots per Inch", description="Resolution of the print", default=DPI, min=FEWEST,
                                 max=MOST, precision=0, options={"SKIP_SAVE"})

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return polls.passes(cls, context, polls.has_sheet)

    def steps(self, context: bpy.types.Context) -> Steps[None]:
        if not bpy.path.basename(self.filepath):
            raise ReflectionError("No file is named: write the name of a .png or .svg file.")
        if self.filepath.startswith("//") and not bpy.data.filepath:
            raise ReflectionError("The file has not been saved: save it, or choose an absolute path.")
        path = os.path.abspath(bpy.path.abspath(self.filepath))
        told = yield from printing(context, context.view_layer.objects.active, path, self.picture, self.dpi)
        tell(self, {"INFO"}, told)


def register() -> None:
    bpy.utils.register_class(REFLECTION_MESH_OT_print_sheet)


def unregister() -> None:
    bpy.utils.unregister_class(REFLECTION_MESH_OT_print_sheet)
