"""A temporary scene in which Cycles bakes the light on objects, by stand-ins whose triangles have room of their own."""
from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass

import bpy
import numpy as np
from mathutils import Matrix

from ...core import ReflectionError
from ..blender_data import compat
from ..blender_data.read_meshes import LocalMesh, Placed
from ..faults import interrupt_held, still_there
from ..rendering import with_cycles
from .opacity import show_opacity, without_openings

MAP = "Reflection Light"
UNTOUCHED = -1.0  # of a texel that nothing was baked into; light is never below zero


@dataclass(frozen=True)
class StandIn:
    """One place of a mesh: whose it is, where, and what of the map is its own.

    Attributes
    ----------
    owner : int
        Index of the participant.
    mesh : LocalMesh
    matrix : (4, 4) float64
    uv : (m, 3, 2) float32
        Of the corners of its triangles.
    turned : bool
        Whether its back is asked for: a bake shades the front.
    own : bool
        Whether it is the participant itself, and not an instance.
    """

    owner: int
    mesh: LocalMesh
    matrix: np.ndarray
    uv: np.ndarray
    turned: bool
    own: bool


@dataclass(frozen=True)
class BakeScene:
    """The scene, the stand-ins of each participant, and what their materials (None where there is none) become while
    they are baked."""

    scene: bpy.types.Scene
    objects: list
    targets: dict
    camera: bpy.types.Object

    def bake(self, owner: int, size: int, seen_from: np.ndarray, gloss: bool, samples: int) -> np.ndarray:
        """One participant's picture, (size, size, 4) float32, `UNTOUCHED` where it is not, as seen from a place, or
        without what goes by that."""
        objects = [obj for number, obj in self.objects if number == owner]
        scene = self.scene
        scene.cycles.samples = samples
        scene.render.bake.use_pass_glossy = gloss
        self.camera.matrix_world = Matrix.Translation(seen_from)
        image = bpy.data.images.new(MAP, size, size, float_buffer=True, is_data=True, alpha=True)
        values = np.full((size, size, 4), UNTOUCHED, dtype=np.float32)
        try:
            image.pixels.foreach_set(values.reshape(-1))
            for target in self.targets.values():
                target.node_tree.nodes.active.image = image
            self._show(objects, as_target=True)
            with bpy.context.temp_override(scene=scene, view_layer=scene.view_layers[0], selected_objects=objects,
                                           active_object=objects[0], object=objects[0]), interrupt_held():
                done = bpy.ops.object.bake(type="COMBINED", use_clear=False, margin=0, save_mode="INTERNAL",
                                           target="IMAGE_TEXTURES", use_selected_to_active=False, uv_layer=MAP)
            if done != {"FINISHED"}:
                raise ReflectionError("Baking was cancelled: nothing has changed.")
            image.pixels.foreach_get(values.reshape(-1))
        finally:
            self._show(objects, as_target=False)
            bpy.data.images.remove(image)
        return values

    def _show(self, objects: list, as_target: bool) -> None:
        """Only what is baked shows a target: on all else its shadows fall as they do."""
        for slot in (slot for obj in objects for slot in obj.material_slots):
            slot.link = "DATA"
            if as_target:
                target = self.targets[slot.material]
                slot.link, slot.material = "OBJECT", target


def stand_ins(placed: list[Placed], uv: dict, turned: set) -> list[StandIn]:
    """Every place of every mesh; `uv` by owner, in the order in which a joined scene counts triangles, and the owners
    that are `turned`."""
    counted, made = dict.fromkeys(uv, 0), []
    for item in placed:
        count = len(item.mesh.triangles)
        for owner, matrix, instance in zip(item.owners.tolist(), item.matrices, item.instances.tolist(), strict=True):
            part = slice(counted[owner], counted[owner] + count)
            counted[owner] += count
            made.append(StandIn(owner, item.mesh, matrix, uv[owner][part], owner in turned, not instance))
    return made


@contextmanager
def bake_scene(context: bpy.types.Context, sources: list, stands: list[StandIn], *,
               opacity: bool) -> Iterator[BakeScene]:
    """The user's scene as a copy, with stand-ins in place of `sources`; with `opacity` they glow by how opaque they
    are."""
    scene = context.scene.copy()
    with ExitStack() as back:
        back.callback(bpy.data.scenes.remove, scene)
        scene.name = MAP
        _prepare(scene, context.view_layer.name)
        camera = bpy.data.objects.new(MAP, bpy.data.cameras.new(MAP))
        back.callback(bpy.data.cameras.remove, camera.data)
        scene.collection.objects.link(camera)
        scene.camera = camera
        for source in sources:
            back.callback(setattr, source, "hide_render", source.hide_render)
            source.hide_render = True
        made: list = []
        back.callback(lambda: bpy.data.batch_remove(still_there(made)))
        materials = dict.fromkeys(material for stand in stands for material in stand.mesh.materials or (None,))
        targets = {material: _target(material, opacity) for material in materials}
        made += targets.values()
        objects = []
        for stand in stands:
            mesh = _mesh(stand)
            obj = _object(sources[stand.owner], stand, mesh)
            made += [obj, mesh]
            scene.collection.objects.link(obj)
            objects.append((stand.owner, obj))
            if stand.own:
                # what is random by an object goes by its name
                _swap_names(sources[stand.owner], obj)
                back.callback(_swap_names, sources[stand.owner], obj)
        yield BakeScene(scene, objects, targets, camera)


def _prepare(scene: bpy.types.Scene, layer: str) -> None:
    with_cycles(scene)
    for other in [other for other in scene.view_layers if other.name != layer]:
        scene.view_layers.remove(other)
    bake = scene.render.bake
    for name in ("use_pass_direct", "use_pass_indirect", "use_pass_diffuse", "use_pass_glossy", "use_pass_transmission",
                 "use_pass_emit"):
        setattr(bake, name, True)
    bake.view_from = "ACTIVE_CAMERA"
    # a noise of its own
    scene.cycles.seed = scene.cycles.seed + 1
    scene.cycles.use_adaptive_sampling = False
    # triangles that lie side by side in the picture do not in the scene
    scene.cycles.use_denoising = False


def _mesh(stand: StandIn) -> bpy.types.Mesh:
    """The mesh as triangles, each with room of its own in the picture."""
    local = stand.mesh
    # a transform that turns space inside out turns triangles over, in Blender as in the joined scene
    inside_out = np.linalg.det(stand.matrix[:3, :3]) < 0.0
    uv = stand.uv[:, (0, 2, 1)] if inside_out else stand.uv
    order = (0, 2, 1) if stand.turned else (0, 1, 2)
    triangles, corners = local.triangles[:, order], local.corners[:, order]
    mesh = bpy.data.meshes.new(MAP)
    mesh.vertices.add(len(local.positions))
    mesh.attributes["position"].data.foreach_set("vector", local.positions.reshape(-1))
    mesh.loops.add(triangles.size)
    mesh.polygons.add(len(triangles))
    mesh.attributes[".corner_vert"].data.foreach_set("value", triangles.reshape(-1).astype(np.int32))
    mesh.polygons.foreach_set("loop_start", np.arange(0, triangles.size, 3, dtype=np.int32))
    mesh.polygons.foreach_set("material_index", local.material_index)
    mesh.polygons.foreach_set("use_smooth", np.ones(len(triangles), dtype=bool))
    for material in local.materials or (None,):
        mesh.materials.append(material)
    for name, values in list(local.uv_maps.items())[:7]:
        layer = mesh.uv_layers.new(name=name, do_init=False)
        layer.uv.foreach_set("vector", values[corners].reshape(-1))
        layer.active_render = layer.active_render or name == local.active_uv
    layer = mesh.uv_layers.new(name=MAP, do_init=False)
    layer.uv.foreach_set("vector", uv[:, order].reshape(-1))
    layer.active = True
    for name, (kind, values) in local.colours.items():
        colour = mesh.color_attributes.new(name, kind, "CORNER")
        colour.data.foreach_set("color", values[corners].reshape(-1))
        if name == local.active_colour:
            mesh.color_attributes.render_color_index = list(mesh.color_attributes).index(colour)
    mesh.update(calc_edges=True)
    normals = -local.normals[:, order] if stand.turned else local.normals
    mesh.normals_split_custom_set(normals.reshape(-1, 3))
    mesh.use_auto_texspace = False
    mesh.texspace_location, mesh.texspace_size = local.texture_space
    return mesh


def _object(source: bpy.types.Object, stand: StandIn, mesh: bpy.types.Mesh) -> bpy.types.Object:
    if stand.own and source.type == "MESH":
        obj = source.copy()
        obj.animation_data_clear()
        obj.modifiers.clear()
        obj.constraints.clear()
        obj.parent = None
        obj.data = mesh
        for slot in obj.material_slots:
            slot.link = "DATA"
        obj.instance_type = "NONE"
        obj.hide_render = False
    else:
        obj = bpy.data.objects.new(MAP, mesh)
        obj.pass_index, obj.color = source.pass_index, source.color
    obj.matrix_world = Matrix(stand.matrix.tolist())
    return obj


def _target(material: bpy.types.Material | None, opacity: bool) -> bpy.types.Material:
    """A copy of a material that bakes into the image: its light, as if nothing went through, or how opaque it is."""
    made = bpy.data.materials.new(MAP) if material is None else material.copy()
    if not compat.uses_nodes(made):
        compat.use_nodes(made)
    tree = made.node_tree
    (show_opacity if opacity else without_openings)(tree)
    node = tree.nodes.new("ShaderNodeTexImage")
    for other in tree.nodes:
        other.select = other == node
    tree.nodes.active = node
    return made


def _swap_names(one: bpy.types.Object, other: bpy.types.Object) -> None:
    first, second = one.name, other.name
    one.name = f"{MAP} {second}"
    other.name, one.name = first, second
