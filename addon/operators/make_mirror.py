"""The operator that makes the active object a mirror: by its role, and by a material where it has none of a mirror."""
from __future__ import annotations

import bpy

from .. import compat
from ..faults import in_one_sentence, tell
from ..reading import can_take_part
from ..reading.materials import materials_on_faces, mirror_roughness, mirrors_in_part
from . import polls

NO_OBJECT = "No object to make a mirror of: make one with faces the active object."
LINKED_OBJECT = "The active object is linked from another file: make a library override of it, or open that file."
NAME = "Mirror"
SILVER = (0.9, 0.9, 0.9, 1.0)


class REFLECTION_MESH_OT_make_mirror(bpy.types.Operator):
    """Give the active object the role Mirror, and a mirror's material where it has none; its mesh keeps its own"""

    bl_idname = "reflection_mesh.make_mirror"
    bl_label = "Make It a Mirror"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return polls.passes(cls, context, _obstacle)

    @in_one_sentence
    def execute(self, context: bpy.types.Context) -> set:
        obj = context.view_layer.objects.active
        shown = materials_on_faces(obj)
        obj.reflection_mesh.role = "MIRROR"
        if any(mirror_roughness(one) is not None or mirrors_in_part(one) for one in shown):
            tell(self, {"INFO"}, f"'{obj.name}' is a mirror now, by its own material.")
        elif not _takes_materials(obj):
            tell(self, {"INFO"}, f"'{obj.name}' has the role Mirror now: give what it consists of a mirror's material.")
        else:
            _dress(obj, _silver())
            if any(shown):
                tell(self, {"INFO"}, f"'{obj.name}' is a mirror now, and its mesh keeps its materials: set the Link of "
                     "the material slots to Data to have them back.")
            else:
                tell(self, {"INFO"}, f"'{obj.name}' is a mirror now, by a new material.")
        return {"FINISHED"}


def _obstacle(context: bpy.types.Context) -> str:
    obj = context.view_layer.objects.active
    if obj is None or not can_take_part(obj):
        return NO_OBJECT
    return LINKED_OBJECT if obj.library is not None else ""


def _takes_materials(obj: bpy.types.Object) -> bool:
    """Return True for an object that can have material slots of its own."""
    return hasattr(obj.data, "materials") and (obj.data.library is None or bool(obj.material_slots))


def _silver() -> bpy.types.Material:
    material = bpy.data.materials.new(NAME)
    tree = compat.use_nodes(material)
    shader = next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED")
    for name, value in (("Base Color", SILVER), ("Metallic", 1.0), ("Roughness", 0.0)):
        shader.inputs[name].default_value = value
    return material


def _dress(obj: bpy.types.Object, material: bpy.types.Material) -> None:
    """Let all of an object show a material, by slots of the object: its data keep their own materials."""
    if not obj.material_slots:
        obj.data.materials.append(None)
    for slot in obj.material_slots:
        if slot.link == "OBJECT" and slot.material is not None:
            # nothing else may use it, and a file does not keep what nothing uses
            slot.material.use_fake_user = True
        slot.link = "OBJECT"
        slot.material = material


def register() -> None:
    bpy.utils.register_class(REFLECTION_MESH_OT_make_mirror)


def unregister() -> None:
    bpy.utils.unregister_class(REFLECTION_MESH_OT_make_mirror)
