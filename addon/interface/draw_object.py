"""What an object is in reflections, as it is drawn in the sidebar and in the object's properties alike."""
from __future__ import annotations

import bpy
from bpy.app.translations import pgettext_iface

from ...core.result import filled_share
from ..frames import plays
from ..lighting import light_lines
from ..reading import is_gone, is_result, lost_mirror, render_size
from ..writing import mesh_bytes, records, size_text
from .menus import REFLECTION_MESH_MT_role

NAMED = 2   # so many sources are all named; of more the first


def draw_object(layout: bpy.types.UILayout, context: bpy.types.Context, obj: bpy.types.Object | None) -> None:
    """The role of an object, or what there is to know of a reflection."""
    if obj is None:
        layout.label(text="Select a mirror and what it shall show", icon="INFO")
    elif is_result(obj):
        _draw_result(layout, context, obj)
    elif obj.reflection_mesh.role == "CAUSTICS":
        _draw_light(layout, obj)
    else:
        layout.label(text=obj.name, icon="OBJECT_DATA", translate=False)
        _draw_role(layout, obj.reflection_mesh)


def _draw_role(layout: bpy.types.UILayout, record: bpy.types.PropertyGroup) -> None:
    role = record.bl_rna.properties["role"].enum_items[record.role]
    split = layout.split(factor=0.4)
    name = split.row()
    name.alignment = "RIGHT"
    name.label(text="Role")
    split.menu(REFLECTION_MESH_MT_role.__name__, text=role.name)


def draw_figures(layout: bpy.types.UILayout, obj: bpy.types.Object) -> None:
    """What engineers ask of a reflection."""
    record, counts = obj.reflection_mesh, records.counts(obj)
    width, height = record.resolution
    told = [pgettext_iface("Made for {width} x {height} px").format(width=width, height=height),
            pgettext_iface("Error about {error:.2f} px").format(error=record.estimated_error),
            pgettext_iface("Made in {seconds:.2f} s").format(seconds=record.seconds)]
    if "filled_pixels" in counts and "mirror_pixels" in counts:
        told.append(pgettext_iface("{share:.3f} % filled by rays").format(share=filled_share(counts)))
    for line in told:
        layout.label(text=line, translate=False)


def _draw_light(layout: bpy.types.UILayout, obj: bpy.types.Object) -> None:
    record = obj.reflection_mesh
    layout.label(text=obj.name, icon="LIGHT_POINT", translate=False)
    lamp = pgettext_iface("a lamp that is gone") if is_gone(record.lamp) else f"'{record.lamp.name}'"
    mirror = pgettext_iface("a mirror that is gone") if is_gone(record.mirror) else f"'{record.mirror.name}'"
    layout.label(text=pgettext_iface("Light of {lamp}, thrown by {mirror}").format(lamp=lamp, mirror=mirror),
                 translate=False)
    if obj.type == "MESH":
        layout.label(text=_size(obj), translate=False)


def _draw_result(layout: bpy.types.UILayout, context: bpy.types.Context, obj: bpy.types.Object) -> None:
    record = obj.reflection_mesh
    layout.label(text=obj.name, icon="MOD_MIRROR", translate=False)
    mirror = pgettext_iface("a mirror that is gone") if lost_mirror(obj) else f"'{record.mirror.name}'"
    layout.label(text=pgettext_iface("Reflection in {mirror}").format(mirror=mirror), translate=False)
    layout.label(text=pgettext_iface("Shows {names}").format(names=_names(record.sources)), translate=False)
    if plays(obj):
        layout.label(text="Plays baked frames")
        return
    if obj.type != "MESH":
        # Object > Convert
        layout.label(text="It is no mesh any more: Generate", icon="ERROR")
        layout.label(text="makes a new one.", icon="BLANK1")
        return
    layout.label(text=_size(obj), translate=False)
    if obj.library is not None:
        layout.label(text="It is linked from another file:", icon="LINKED")
        layout.label(text="there it is updated and lit.", icon="BLANK1")
        return
    if lost_mirror(obj):
        return
    if tuple(record.resolution) != render_size(context.scene):
        layout.label(text="The render has another size now:", icon="ERROR")
        layout.label(text="press Generate Reflection again.", icon="BLANK1")
    for number, line in enumerate(light_lines(obj)):
        layout.label(text=line, icon="BLANK1" if number else "LIGHT")


def _names(sources) -> str:
    named = sources[:NAMED if len(sources) <= NAMED else 1]
    names = [f"'{source.object.name}'" for source in named if source.object is not None]
    more = len(sources) - len(names)
    if not names:
        return pgettext_iface("1 object" if more == 1 else "{count} objects").format(count=more)
    listed = ", ".join(names)
    return pgettext_iface("{names} and {count} more").format(names=listed, count=more) if more else listed


def _size(obj: bpy.types.Object) -> str:
    record = obj.reflection_mesh
    count = record.points or record.faces
    points = pgettext_iface("1 point, {size}" if count == 1 else "{count:,} points, {size}")
    faces = pgettext_iface("1 face, {size}" if count == 1 else "{count:,} faces, {size}")
    return (points if record.points else faces).format(count=count, size=size_text(mesh_bytes(obj.data)))
