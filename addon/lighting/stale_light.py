"""Tells when light is no longer that of the scene: something has changed that it may depend on."""
from __future__ import annotations

import bpy
from bpy.app.handlers import persistent

from ..illumination import is_glint
from ..reading import is_result, mirrors_of, rendered_collections
from ..registration import Handlers
from .preview import MARK

# what may change light; all else, such as pictures that are only looked at, does not
KINDS = (bpy.types.Object, bpy.types.Material, bpy.types.World, bpy.types.Light, bpy.types.Mesh, bpy.types.Curve,
         bpy.types.MetaBall, bpy.types.Camera, bpy.types.NodeTree)
_shown: dict = {}  # of each scene, what took part when Blender last told of a change
# objects that neither send light nor stop it
UNSEEN = {"CAMERA", "EMPTY", "ARMATURE", "LATTICE", "SPEAKER"}


@persistent
def _mark(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    """Mark the lit results of a scene in which something has changed."""
    # in the depsgraph of a render all is new
    if depsgraph.mode != "VIEWPORT":
        return
    own = _own(scene)
    before, now = _shown.get(scene.session_uid), _taking_part(scene, own)
    _shown[scene.session_uid] = now
    # what plays baked frames has light that was made for each of them, and no record of one view
    lit = [obj for obj in scene.objects if obj.reflection_mesh.light_material is not None
           and obj.reflection_mesh.light and not obj.reflection_mesh.light_stale]
    if not lit:
        return
    # nothing tells of what is gone, or hidden from renders
    other = before is not None and before != now
    told = [update.id.original for update in depsgraph.updates if _tells(update, own)]
    # light that stays with the objects is the same from everywhere
    lasting = [changed for changed in told if not _only_moves_the_view(changed, lit)]
    for obj in lit:
        if other or (told if obj.reflection_mesh.light_map is None else lasting):
            obj.reflection_mesh.light_stale = True


@persistent
def _remember(*_) -> None:
    """Know what takes part in the scenes of a file that has been opened."""
    _shown.clear()
    _shown.update((scene.session_uid, _taking_part(scene, _own(scene))) for scene in bpy.data.scenes)


def _taking_part(scene: bpy.types.Scene, own: set) -> frozenset:
    """Numbers of the objects that send light in renders of a scene, or may stop it."""
    shown = set().union(*(rendered_collections(layer.layer_collection) for layer in scene.view_layers))
    return frozenset(obj.session_uid for collection in shown for obj in collection.objects
                     if not obj.hide_render and obj.type not in UNSEEN and obj not in own and not is_glint(obj))


def _own(scene: bpy.types.Scene) -> set:
    """Reflections, and what makes them; caustics are light that mirrors show."""
    results = {obj for obj in scene.objects if is_result(obj)}
    materials = {obj.reflection_mesh.light_material for obj in results} - {None}
    # previews come and go
    materials |= {slot.material for obj in results for slot in obj.material_slots if slot.material is not None
                  and MARK in slot.material}
    meshes = {obj.data for obj in results} | {obj.reflection_mesh.light_map for obj in results}
    return results | materials | meshes | {material.node_tree for material in materials}


def _only_moves_the_view(changed: bpy.types.ID, lit: list) -> bool:
    """Whether a change of it leaves the light on the objects: it is a camera, one of the mirrors, or nothing that is
    seen."""
    if isinstance(changed, bpy.types.Object):
        return changed.type in UNSEEN or any(changed in mirrors_of(obj) for obj in lit)
    return isinstance(changed, bpy.types.Camera)


def _tells(update: bpy.types.DepsgraphUpdate, own: set) -> bool:
    changed = update.is_updated_transform or update.is_updated_geometry
    # an object's shading counts as updated whenever anything is added to the scene
    if not isinstance(update.id, bpy.types.Object):
        changed |= update.is_updated_shading
    return changed and isinstance(update.id, KINDS) and update.id.original not in own


HANDLERS = Handlers((_mark, "depsgraph_update_post", "frame_change_post"), (_remember, "load_post"))
register, unregister = HANDLERS.register, HANDLERS.unregister
