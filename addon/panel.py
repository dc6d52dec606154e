"""The tab "Reflection" of the 3D viewport's sidebar."""
from __future__ import annotations

import bpy

from ..core.result.reflection_mesh import filled_share
from .comparison import show_comparison
from .frames import plays
from .lighting import light_lines
from .properties import SETTINGS
from .writing import records


class REFLECTION_MESH_PT_main(bpy.types.Panel):
    """Roles, settings and the operators"""

    bl_idname = "REFLECTION_MESH_PT_main"
    bl_label = "Reflection Mesh"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Reflection"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        if context.object is not None:
            _draw_object(layout, context.object)
        settings = context.scene.reflection_mesh
        column = layout.column()
        for name in SETTINGS:
            column.prop(settings, name)
        column = layout.column(align=True)
        generate = column.operator("reflection_mesh.generate", icon="MOD_MIRROR")
        column.operator("reflection_mesh.light", icon="LIGHT")
        caustics = column.operator("reflection_mesh.caustics", icon="LIGHT_POINT")
        caustics.tolerance, caustics.depth, caustics.memory = settings.tolerance, settings.depth, settings.memory
        bake = column.operator("reflection_mesh.bake", icon="FILE_CACHE")
        compare = column.operator("reflection_mesh.compare", icon="IMAGE_DATA")
        for operator in (generate, bake, compare):
            for name in SETTINGS:
                setattr(operator, name, getattr(settings, name))
        column.operator("reflection_mesh.clear", icon="TRASH")
        column = layout.column(align=True)
        maps = column.operator("reflection_mesh.mirror_uvs", icon="UV")
        maps.tolerance, maps.memory = settings.tolerance, settings.memory
        column.operator("reflection_mesh.print_sheet", icon="IMAGE_DATA")
        _draw_comparison(layout, context.scene)


def _draw_object(layout: bpy.types.UILayout, obj: bpy.types.Object) -> None:
    record = obj.reflection_mesh
    box = layout.box()
    box.label(text=obj.name, icon="OBJECT_DATA", translate=False)
    if record.role == "CAUSTICS":
        for what, thing in (("Mirror", record.mirror), ("Lamp", record.lamp)):
            box.label(text=f"{what}: {thing.name if thing else 'removed'}", translate=False)
        box.label(text=f"{record.faces} faces of light")
        return
    if record.role != "REFLECTION":
        box.prop(record, "role")
        return
    mirror = record.mirror.name if record.mirror else "removed"
    count = len(record.sources)
    box.label(text=f"Mirror: {mirror}", translate=False)
    if plays(obj):
        box.label(text=f"{count} source{'' if count == 1 else 's'}, plays baked frames")
        return
    size = f"{record.points} points" if record.points else f"{record.faces} faces"
    box.label(text=f"{count} source{'' if count == 1 else 's'}, {size}")
    counts = records.counts(obj)
    if "filled_pixels" in counts and "mirror_pixels" in counts:
        box.label(text=f"{filled_share(counts):.3f} % filled by rays")
    for line in light_lines(obj):
        box.label(text=line, icon="LIGHT")
    box.label(text=f"Error about {record.estimated_error:.2f} px at {record.resolution[0]} x {record.resolution[1]}")


def _draw_comparison(layout: bpy.types.UILayout, scene: bpy.types.Scene) -> None:
    """The numbers of the last comparison, and the way to its page."""
    told = show_comparison.lines(scene)
    if not told:
        return
    box = layout.box()
    for line in told:
        box.label(text=line, translate=False)
    address = show_comparison.page_address(scene)
    if address:
        box.operator("wm.url_open", text="Open the Report", icon="URL").url = address


def register() -> None:
    bpy.utils.register_class(REFLECTION_MESH_PT_main)


def unregister() -> None:
    bpy.utils.unregister_class(REFLECTION_MESH_PT_main)
