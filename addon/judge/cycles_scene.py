"""A temporary scene of copies, in which everything may be changed and nothing of the user's is."""
from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

import bpy
import numpy as np

from ..faults import still_there
from ..reading import is_rendered, is_result, takes_part

RAYS = ("camera", "diffuse", "glossy", "transmission", "volume_scatter", "shadow")


@dataclass
class CopiedScene:
    """Copies of what the view layer renders, sorted by the part that they play.

    Attributes
    ----------
    scene : bpy.types.Scene
    mirrors, diffuse, results, bystanders : list of (copy, index)
        Copied objects; index is that of the mirror, diffuse object or result that a copy belongs to.
    own : dict of bpy.types.Object to list of bpy.types.Material or None
        The materials of each copy by slot; of a result those of its sources, which its light hides.
    lights : list of bpy.types.Object
        The user's own, which are lit in pictures alone: codes show nothing but faces.
    owned : list of bpy.types.ID
        What is deleted in the end; whoever adds data to the scene adds it here.
    """

    scene: bpy.types.Scene
    mirrors: list = field(default_factory=list)
    diffuse: list = field(default_factory=list)
    results: list = field(default_factory=list)
    bystanders: list = field(default_factory=list)
    own: dict = field(default_factory=dict)
    lights: list = field(default_factory=list)
    owned: list = field(default_factory=list)

    def light_up(self, world: bpy.types.World | None) -> None:
        """Add the lights and the world."""
        self.scene.world = world
        for light in set(still_there(self.lights)) - set(self.scene.collection.objects):
            self.scene.collection.objects.link(light)

    @property
    def everything(self) -> list:
        """All copied objects."""
        return [copy for part in (self.mirrors, self.diffuse, self.results, self.bystanders) for copy, _ in part]


@contextmanager
def copied_scene(context: bpy.types.Context, mirrors: list, diffuse: list, results: list) -> Iterator[CopiedScene]:
    """Copy the evaluated meshes, the camera and the lights into a scene of their own, and delete it in the end."""
    copied = CopiedScene(bpy.data.scenes.new("Reflection Comparison"))
    try:
        _copy_settings(context.scene, copied.scene)
        _copy_objects(context, copied, mirrors, diffuse, results)
        yield copied
    finally:
        # between two steps others may have deleted some of it
        for scene in still_there([copied.scene]):
            bpy.data.scenes.remove(scene)
        bpy.data.batch_remove(still_there(copied.owned))


def _copy_settings(user: bpy.types.Scene, scene: bpy.types.Scene) -> None:
    for name in ("resolution_x", "resolution_y", "resolution_percentage", "pixel_aspect_x", "pixel_aspect_y",
                 "threads_mode"):
        setattr(scene.render, name, getattr(user.render, name))
    if user.render.threads_mode == "FIXED":
        scene.render.threads = user.render.threads
    scene.display_settings.display_device = user.display_settings.display_device
    for name in ("view_transform", "look", "exposure", "gamma"):
        setattr(scene.view_settings, name, getattr(user.view_settings, name))
    scene.render.use_compositing = scene.render.use_sequencer = False
    scene.frame_set(user.frame_current, subframe=user.frame_subframe)


def _copy_objects(context: bpy.types.Context, copied: CopiedScene, mirrors: list, diffuse: list, results: list) -> None:
    anchor = bpy.data.objects.new("Anchor", None)
    copied.owned.append(anchor)
    copied.scene.collection.objects.link(anchor)
    depsgraph = context.evaluated_depsgraph_get()
    part_of = {obj: (part, index) for part, objects in
               ((copied.mirrors, mirrors), (copied.diffuse, diffuse), (copied.results, results))
               for index, obj in enumerate(objects)}
    by = (copied.bystanders, -1)
    seen = _rendered(context)
    old_results = {obj for obj in context.view_layer.objects if is_result(obj)} - set(results)
    meshes: dict = {}
    given: dict = {}
    for instance in depsgraph.object_instances:
        evaluated = instance.object
        original = evaluated.original
        owner = instance.parent.original if instance.is_instance else original
        if owner not in seen or owner in old_results or not is_rendered(instance, given) or not instance.show_self:
            continue
        if original.type == "LIGHT" and not instance.is_instance:
            copied.lights.append(original)
        # text and similar objects appear as generated meshes too
        if evaluated.type != "MESH":
            continue
        # instances that may not take part themselves are bystanders
        there = not instance.is_instance or takes_part(original)
        part, index = part_of.get(owner, by) if there else by
        key = (evaluated.data.as_pointer(), part is copied.results)
        if key not in meshes:
            meshes[key] = _mesh(evaluated, depsgraph)
            copied.owned.append(meshes[key])
        slots = [slot.material.original if slot.material else None for slot in evaluated.material_slots]
        copy = _placed(copied, anchor, meshes[key], instance.matrix_world.copy(), slots)
        copied.own[copy] = _own_materials(copy, original if part is copied.results else None)
        for ray in RAYS:
            setattr(copy, f"visible_{ray}", getattr(original, f"visible_{ray}"))
        part.append((copy, index))
    _copy_camera(context, copied, anchor, depsgraph)


def _own_materials(copy: bpy.types.Object, result: bpy.types.Object | None) -> list:
    """Return the materials of a copy by slot. For a `result`, return those of its sources, which its light hides."""
    shown = [slot.material for slot in copy.material_slots] if result is None else list(result.data.materials)
    return shown + [None] * (len(copy.material_slots) - len(shown))


def _rendered(context: bpy.types.Context) -> set:
    """Return the objects of the view layer that are rendered: neither they nor their collections are hidden."""
    found, waiting = set(), [context.view_layer.layer_collection]
    while waiting:
        branch = waiting.pop()
        if not branch.collection.hide_render:
            waiting.extend(branch.children)
            if not branch.exclude:
                found.update(obj for obj in branch.collection.objects if not obj.hide_render)
    return found


def _mesh(evaluated: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> bpy.types.Mesh:
    """Return a separate mesh with modifiers applied; an attribute holds each face's number."""
    # with all layers Blender would evaluate the object anew, and of instances of raw geometry their instancer
    mesh = bpy.data.meshes.new_from_object(evaluated, preserve_all_data_layers=False, depsgraph=depsgraph)
    stale = mesh.attributes.get("polygon_code")
    if stale is not None:
        mesh.attributes.remove(stale)
    code = mesh.attributes.new("polygon_code", "FLOAT", "FACE")
    code.data.foreach_set("value", np.arange(len(mesh.polygons), dtype=np.float32))
    return mesh


def _placed(copied: CopiedScene, anchor: bpy.types.Object, data, matrix, slots: list) -> bpy.types.Object:
    """Create an object in the copied scene with exactly the world transform `matrix`, and return it.

    The matrix is stored as the parent's inverse, since location, rotation and scale cannot represent shear.

    Parameters
    ----------
    copied : CopiedScene
        Its scene and its list of owned data get the object.
    anchor : bpy.types.Object
        Parent of the object: an empty without a transform of its own.
    data : bpy.types.Mesh or bpy.types.Camera
    matrix : mathutils.Matrix
    slots : list of bpy.types.Material or None
        Materials of the object by slot. A mesh gets at least one slot.
    """
    copy = bpy.data.objects.new("Copy", data)
    copied.owned.append(copy)
    copied.scene.collection.objects.link(copy)
    copy.parent = anchor
    copy.matrix_parent_inverse = matrix
    # every mesh has a slot, so that materials can be exchanged
    wanted = max(len(slots), 1) if copy.type == "MESH" else 0
    for _ in range(wanted - len(copy.material_slots)):
        data.materials.append(None)
    for slot, material in zip(copy.material_slots, slots, strict=False):
        slot.link = "OBJECT"
        slot.material = material
    return copy


def _copy_camera(context: bpy.types.Context, copied: CopiedScene, anchor, depsgraph) -> None:
    camera = context.scene.camera
    data = camera.data.copy()
    data.dof.use_dof = False
    copied.owned.append(data)
    matrix = camera.evaluated_get(depsgraph).matrix_world.copy()
    copied.scene.camera = _placed(copied, anchor, data, matrix, [])
