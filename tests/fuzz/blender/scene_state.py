"""What an open file holds, as plain values to compare: data, objects, selection, settings; and what differs."""
from __future__ import annotations

import hashlib

import bpy
import numpy as np

FIELDS = {"FLOAT": ("value", 1, np.float32), "FLOAT_VECTOR": ("vector", 3, np.float32),
          "FLOAT2": ("vector", 2, np.float32), "FLOAT_COLOR": ("color", 4, np.float32),
          "BYTE_COLOR": ("color", 4, np.float32), "QUATERNION": ("value", 4, np.float32), "INT": ("value", 1, np.int32),
          "INT32_2D": ("value", 2, np.int32), "BOOLEAN": ("value", 1, bool), "INT8": ("value", 1, np.int32)}
OF_OBJECTS = ("hide_render", "hide_viewport", "hide_select", "display_type", "instance_type", "visible_camera",
              "visible_diffuse", "visible_glossy", "visible_transmission", "visible_volume_scatter", "visible_shadow")


def state() -> dict:
    """All that an operator could change in the open file, by name."""
    scene, layer = bpy.context.scene, bpy.context.view_layer
    found = {f"data {kind.identifier}": sorted(item.name_full for item in getattr(bpy.data, kind.identifier))
             for kind in bpy.data.bl_rna.properties if kind.type == "COLLECTION" and kind.identifier != "all_ids"}
    for obj in bpy.data.objects:
        found |= {f"object {obj.name_full} {name}": value for name, value in _object(obj).items()}
        if obj.name in layer.objects:
            found[f"object {obj.name_full} selected"] = obj.select_get()
            found[f"object {obj.name_full} hidden"] = obj.hide_get()
    for mesh in bpy.data.meshes:
        found[f"mesh {mesh.name_full}"] = digest(mesh)
    for owner, name in ((scene.render, "render"), (scene.render.image_settings, "image"),
                        (scene.view_settings, "view"), (scene.reflection_mesh, "settings"), (scene, "scene")):
        found |= {f"{name} {key}": value for key, value in _plain(owner).items()}
    return found | {"active": getattr(layer.objects.active, "name_full", None), "mode": bpy.context.mode,
                    "camera": getattr(scene.camera, "name_full", None)}


def differences(before: dict, after: dict) -> list[str]:
    """What two states differ in, "name: value -> value", where both know the name; of lists what they do not share."""
    found = []
    for name in before:
        old, new = before[name], after.get(name, before[name])
        if old != new and isinstance(old, list) and set(old) != set(new):
            old, new = sorted(set(old) - set(new)), sorted(set(new) - set(old))
        if old != new:
            found.append(f"{name}: {old!r:.80} -> {new!r:.80}")
    return found


def without(found: dict, *endings: str) -> dict:
    """The state without what is named so at its end."""
    return {name: value for name, value in found.items() if not name.endswith(endings)}


def digest(mesh: bpy.types.Mesh) -> str:
    """A word for all attributes of a mesh and their values, and its materials."""
    whole = hashlib.sha256(repr([getattr(material, "name_full", None) for material in mesh.materials]).encode())
    for name, values in sorted(arrays(mesh).items()):
        whole.update(f"{name} {values.dtype} {values.shape}".encode() + values.tobytes())
    return whole.hexdigest()[:16]


def arrays(mesh: bpy.types.Mesh) -> dict[str, np.ndarray]:
    """The values of every attribute whose type holds numbers, by its name and what it belongs to."""
    found = {}
    for attribute in mesh.attributes:
        if attribute.data_type in FIELDS:
            field, width, kind = FIELDS[attribute.data_type]
            values = np.empty(len(attribute.data) * width, dtype=kind)
            attribute.data.foreach_get(field, values)
            found[f"{attribute.name}|{attribute.domain}"] = values.reshape(-1, width)
    return found


def _object(obj: bpy.types.Object) -> dict:
    record = obj.reflection_mesh
    return {name: getattr(obj, name) for name in OF_OBJECTS} | {
        "place": np.array(obj.matrix_world).tobytes(), "own place": np.array(obj.matrix_basis).tobytes(),
        "data": getattr(obj.data, "name_full", None), "parent": getattr(obj.parent, "name_full", None),
        "modifiers": [(one.name, one.type, one.show_viewport, one.show_render) for one in obj.modifiers],
        "materials": [getattr(slot.material, "name_full", None) for slot in obj.material_slots],
        "collections": sorted(collection.name_full for collection in obj.users_collection),
        "role": (record.role, record.camera_hidden, getattr(record.mirror, "name_full", None), len(record.sources))}


def _plain(owner) -> dict:
    """The properties that are numbers, words or choices."""
    values = {name: getattr(owner, name) for name in owner.bl_rna.properties.keys() if name != "use_nodes"}
    return {name: value for name, value in values.items() if isinstance(value, int | float | str | bool)}
