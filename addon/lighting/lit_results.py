"""Results that show light: where on them the picture of light lies, the material that shows it, and the way back."""
from __future__ import annotations

import json

import bpy
import numpy as np

from ...core import View
from ..baking import KeptMap, can_be_baked, lay_out
from ..faults import AllOrNothing, Steps, finished, keep_data, keep_object, still_there
from ..reading import DiffuseScene
from ..writing import LONGEST_RECORD, forget_mesh, forget_unblurred, images_of, show_own_materials, unblurred_in
from .light_material import texels_shown
from .needs_light import needs_light
from .picture import Window, record_of, window_of
from .picture import lay_out as lay_out_picture
from .preview import MARK, forget_previews


def show_light(result: bpy.types.Object, material: bpy.types.Material, view: View, window: Window,
               whole: AllOrNothing) -> Steps[None]:
    """Let a result show the light in a window of the picture; its mesh keeps the materials of what it shows."""
    yield from _show(result, material, record_of(view, window), None,
                     lay_out_picture(result, view, window, texels_shown(material)), whole)


def show_object_light(result: bpy.types.Object, material: bpy.types.Material, view: View, scene: DiffuseScene,
                      light_map: KeptMap, whole: AllOrNothing) -> Steps[None]:
    """Let a result show light that stays with the objects of `scene`."""
    told = json.dumps({"kind": "OBJECTS", **_identity(scene), "sheets": light_map.sheets, "dull": light_map.dull})
    yield from _show(result, material, told, light_map.mesh, lay_out(result, view, scene, light_map, material), whole)


def keep_light(result: bpy.types.Object, view: View, scene: DiffuseScene) -> None:
    """After a result's mesh was written anew: it goes on showing its light where that stays with the same objects, or
    was made for the same view and nothing has changed since; else the light counts as stale."""
    record = result.reflection_mesh
    material, light_map = record.light_material, record.light_map
    if light_map is not None:
        kept = _kept_map(record, scene)
        if material is not None and kept is not None and can_be_baked([result]):
            finished(lay_out(result, view, scene, kept, material))
            _put_on(result, material)
        else:
            record.light_stale = True
        return
    window = None if record.light_stale or material is None else window_of(record.light, view)
    if window is None:
        record.light_stale = bool(record.light)
    else:
        finished(lay_out_picture(result, view, window, texels_shown(material)))
        _put_on(result, material)


def is_lit(result: bpy.types.Object) -> bool:
    """Whether a result shows its light."""
    light = result.reflection_mesh.light_material
    return light is not None and any(slot.material == light for slot in result.material_slots)


def forget_light(material: bpy.types.Material) -> None:
    """Remove a material of light, its groups of nodes and its images, where nothing else uses them."""
    if not still_there([material]) or material.users or material.library is not None:
        return
    images, groups = set(images_of(material)), unblurred_in(material.node_tree)
    bpy.data.materials.remove(material)
    forget_unblurred(groups)
    for image in images:
        if image.users == 0 and image.library is None:
            bpy.data.images.remove(image)


def dull_objects(result: bpy.types.Object) -> list[str]:
    """The names of the objects whose gloss a result shows as from elsewhere."""
    try:
        names = json.loads(result.reflection_mesh.light[:LONGEST_RECORD] or "{}").get("dull", [])
    except (ValueError, RecursionError, AttributeError):
        return []
    return [name for name in names if isinstance(name, str)] if isinstance(names, list) else []


def light_sentence(result: bpy.types.Object) -> str:
    """Return what there is to say of a result's light; nothing of one that needs none."""
    record = result.reflection_mesh
    if record.light_stale:
        return "The scene has changed since the reflection was lit. Click Light Reflection."
    if record.light_material is not None:
        return "Lit, with gloss as seen from one place. Light: Picture shows it exactly." if dull_objects(result) else (
            "Lit.")
    return "Not lit yet. Click Light Reflection." if needs_light(result) else ""


def _show(result: bpy.types.Object, material: bpy.types.Material, told: str, light_map: bpy.types.Mesh | None,
          lay: Steps[None], whole: AllOrNothing) -> Steps[None]:
    record = result.reflection_mesh
    keep_object(result, whole)
    keep_data(result, whole)
    earlier, earlier_map = record.light_material, record.light_map
    yield from lay
    _keep_users_materials(result)
    show_own_materials(result)
    whole.after(forget_previews)
    _put_on(result, material)
    record.light, record.light_stale = told, False
    record.light_material, record.light_map = material, light_map
    if earlier is not None and earlier != material:
        whole.after(forget_light, earlier)
    if earlier_map is not None and earlier_map != light_map:
        whole.after(forget_mesh, earlier_map)


def _keep_users_materials(result: bpy.types.Object) -> None:
    """Let the mesh have the materials that the user has put in place of previews, so that they outlast the light."""
    for number, slot in enumerate(result.material_slots):
        material = slot.material
        if (slot.link == "OBJECT" and material not in (None, result.reflection_mesh.light_material)
                and MARK not in material):
            result.data.materials[number] = material


def _identity(scene: DiffuseScene) -> dict:
    """What a map of light is for: these sources, with so many triangles."""
    return {"sources": [source.name for source in scene.sources],
            "triangles": np.bincount(scene.source_object, minlength=len(scene.sources)).tolist()}


def _kept_map(record: bpy.types.PropertyGroup, scene: DiffuseScene) -> KeptMap | None:
    """The map of light that a result keeps; None where it is not of this scene."""
    try:
        known, own = json.loads(record.light[:LONGEST_RECORD]), _identity(scene)
        kept = KeptMap(record.light_map, [(int(number), bool(back)) for number, back in known["sheets"]])
        count = sum(own["triangles"][number] for number, _ in kept.sheets)
        same = all(known[name] == value for name, value in own.items())
    except (ValueError, TypeError, KeyError, IndexError, RecursionError):
        return None
    whole = {number for number, _ in kept.sheets} == set(range(len(scene.sources)))
    return kept if same and whole and 3 * count == len(kept.mesh.vertices) else None


def _put_on(result: bpy.types.Object, material: bpy.types.Material) -> None:
    for slot in result.material_slots:
        slot.link, slot.material = "OBJECT", material
