"""The active object's part in reflections, drawn in the sidebar and in the object's properties alike."""
from __future__ import annotations

import bpy
from bpy.app.translations import pgettext_iface

from ...core.result import filled_share
from ..reading import is_gone, known_results, result_of
from ..writing import mesh_bytes, records, size_text
from .draw_lines import draw_sentence
from .menus import REFLECTION_MESH_MT_role

NAMED = 2   # so many sources are all named; of more the first
ICONS = {"REFLECTION": "MOD_MIRROR", "CAUSTICS": "LIGHT_POINT"}


def draw_object(layout: bpy.types.UILayout, context: bpy.types.Context, obj: bpy.types.Object | None) -> None:
    """Draw three rows, whatever the object is: its name, its role or its mirror, and its lamp or the way to its
    reflection."""
    if obj is None:
        layout.label(text="No Active Object", icon="OBJECT_DATA")
        layout.label(text="")
        _draw_select(layout, None)
        return
    record = obj.reflection_mesh
    layout.label(text=obj.name, icon=ICONS.get(record.role, "OBJECT_DATA"), translate=False)
    if record.role in ICONS:
        _draw_fact(layout, pgettext_iface("Reflected By"), _name(record.mirror))
    else:
        _draw_role(layout, record)
    if record.role == "CAUSTICS":
        _draw_fact(layout, pgettext_iface("Lamp"), _name(record.lamp))
    else:
        _draw_select(layout, shown_result(context, obj))


def shown_result(context: bpy.types.Context, obj: bpy.types.Object | None) -> bpy.types.Object | None:
    """Return the result that the panels tell of: an active one, or the reflection in an active mirror."""
    if obj is not None and obj.reflection_mesh.role == "CAUSTICS":
        return obj
    return result_of(context, obj, known_results(context.scene, context.view_layer))


def _draw_role(layout: bpy.types.UILayout, record: bpy.types.PropertyGroup) -> None:
    role = record.bl_rna.properties["role"].enum_items[record.role]
    _split(layout, pgettext_iface("Role")).menu(REFLECTION_MESH_MT_role.__name__, text=role.name)


def _draw_fact(layout: bpy.types.UILayout, name: str, value: str) -> None:
    _split(layout, name).label(text=value, translate=False)


def _split(layout: bpy.types.UILayout, name: str) -> bpy.types.UILayout:
    """Draw a name as Blender does beside a property, and return the place of its value."""
    split = layout.split(factor=0.4)
    left = split.row()
    left.alignment = "RIGHT"
    left.label(text=name, translate=False)
    return split


def _draw_select(layout: bpy.types.UILayout, result: bpy.types.Object | None) -> None:
    """Draw the button that selects the reflection, and the switch that lets clicks in the viewport do so."""
    row = layout.row(align=True)
    row.operator("reflection_mesh.select", icon="RESTRICT_SELECT_OFF")
    if result is not None and result.library is None:
        row.prop(result, "hide_select", text="", emboss=True)


def _name(obj: bpy.types.Object | None) -> str:
    return pgettext_iface("Gone") if is_gone(obj) else obj.name


def draw_figures(layout: bpy.types.UILayout, context: bpy.types.Context, obj: bpy.types.Object) -> None:
    """Draw what a result shows, and the numbers that engineers ask of it."""
    for line in _figures(obj):
        draw_sentence(layout, context, line, icon="NONE")


def _figures(obj: bpy.types.Object) -> list[str]:
    record, counts = obj.reflection_mesh, records.counts(obj)
    told = [pgettext_iface("Shows {names}").format(names=_names(record.sources))] if len(record.sources) else []
    if obj.type == "MESH":
        told.append(_size(obj))
    if record.role == "CAUSTICS":
        return told
    width, height = record.resolution
    told += [pgettext_iface("Made for {width} x {height} px").format(width=width, height=height),
             pgettext_iface("Error about {error:.2f} px").format(error=record.estimated_error),
             pgettext_iface("Made in {seconds:.2f} s").format(seconds=record.seconds)]
    if "filled_pixels" in counts and "mirror_pixels" in counts:
        told.append(pgettext_iface("{share:.3f} % filled by rays").format(share=filled_share(counts)))
    return told


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
