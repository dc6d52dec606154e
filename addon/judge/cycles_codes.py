"""Materials that emit numbers instead of light: a render in them says what each pixel shows."""
from __future__ import annotations

from collections import Counter

import bpy
import numpy as np

from .. import compat
from .cycles_scene import CopiedScene
from .see_through import NEVER, SeeThrough

MIRROR_NORMAL = "reflection_mesh_normal"
NO_LENGTH = 1e-6


class CodedMaterials:
    """Makes coded materials for a copied scene, which deletes them in the end.

    Positions are emitted relative to `origin`, the lowest corner of all that is shown, so that they are never negative.
    """

    def __init__(self, copied: CopiedScene, origin: tuple[float, float, float]) -> None:
        self._copied = copied
        self.origin = origin
        self._groups: dict = {}
        self._dressed: dict = {}

    def dress(self, part: list, code: bpy.types.Material, textures: str = NEVER) -> None:
        """Put one code on every face of the copies, except where their own materials are open."""
        for copy, _ in part:
            for index, slot in enumerate(copy.material_slots):
                slot.material = self.on(self._copied.own[copy][index], code, textures)

    def on(self, material: bpy.types.Material | None, code: bpy.types.Material, textures: str = NEVER,
           by_side_alone: bool = False) -> bpy.types.Material:
        """Return a material that shows `code` in place of `material`; arguments as in `SeeThrough`."""
        # a code that somebody has removed raises ReferenceError here
        key = (material, code.session_uid, textures, by_side_alone)
        if key not in self._dressed:
            see_through = SeeThrough(self._groups[code.session_uid], textures, by_side_alone, self._copied.owned)
            self._dressed[key] = see_through.dressed(material) or code
        return self._dressed[key]

    def black(self) -> bpy.types.Material:
        """Return a material that occludes and emits nothing."""
        return self._material("Black")[0]

    def position(self) -> bpy.types.Material:
        """Emits the world position of the point."""
        material, tree, emission = self._material("Position")
        self._from_origin(tree, tree.nodes.new("ShaderNodeNewGeometry").outputs["Position"], emission)
        return material

    def identity(self) -> bpy.types.Material:
        """Emits the object's pass index and the face's number."""
        material, tree, emission = self._material("Identity")
        combine = tree.nodes.new("ShaderNodeCombineXYZ")
        tree.links.new(tree.nodes.new("ShaderNodeObjectInfo").outputs["Object Index"], combine.inputs["X"])
        tree.links.new(self._attribute(tree, "polygon_code").outputs["Fac"], combine.inputs["Y"])
        tree.links.new(combine.outputs["Vector"], emission.inputs["Color"])
        return material

    def attribute_position(self, name: str) -> bpy.types.Material:
        """Emits a position that the mesh carries as the attribute `name`."""
        material, tree, emission = self._material("Attribute Position")
        self._from_origin(tree, self._attribute(tree, name).outputs["Vector"], emission)
        return material

    def attribute(self, name: str) -> bpy.types.Material:
        """Emits the vector attribute `name` as it is."""
        material, tree, emission = self._material("Attribute")
        tree.links.new(self._attribute(tree, name).outputs["Vector"], emission.inputs["Color"])
        return material

    def mirror(self, depth: int, normal: str = "") -> bpy.types.Material:
        """Reflects perfectly `depth` times; a mirror seen in the last of these emits 1 in the first channel.

        Where `normal` names an attribute, in the object's space, it takes the place of Cycles' own shading normals.
        """
        material, tree, emission = self._material("Mirror")
        emission.inputs["Color"].default_value = (1.0, 0.0, 0.0, 1.0)
        glossy = _glossy(tree)
        if normal:
            tree.links.new(self._world_normal(tree, normal), glossy.inputs["Normal"])
        mix = tree.nodes.new("ShaderNodeMixShader")
        reached = tree.nodes.new("ShaderNodeMath")
        reached.operation = "GREATER_THAN"
        reached.inputs[1].default_value = depth - 0.5
        tree.links.new(tree.nodes.new("ShaderNodeLightPath").outputs["Glossy Depth"], reached.inputs[0])
        tree.links.new(reached.outputs["Value"], mix.inputs[0])
        tree.links.new(glossy.outputs["BSDF"], mix.inputs[1])
        tree.links.new(emission.outputs["Emission"], mix.inputs[2])
        tree.links.new(mix.outputs["Shader"], tree.nodes["Output"].inputs["Surface"])
        return material

    def plain_mirror(self) -> bpy.types.Material:
        """Reflects perfectly, and codes nothing."""
        material, tree, _ = self._material("Plain Mirror")
        tree.links.new(_glossy(tree).outputs["BSDF"], tree.nodes["Output"].inputs["Surface"])
        return material

    def mirror_facing(self) -> bpy.types.Material:
        """Emits 2 + R.Ng, 2 + I.Ng and 1: how steeply the reflected ray and the eye stand on the flat face."""
        material, tree, emission = self._material("Mirror Facing")
        geometry = tree.nodes.new("ShaderNodeNewGeometry")
        reflect = tree.nodes.new("ShaderNodeVectorMath")
        reflect.operation = "REFLECT"
        tree.links.new(geometry.outputs["Incoming"], reflect.inputs[0])
        tree.links.new(geometry.outputs["Normal"], reflect.inputs[1])
        combine = tree.nodes.new("ShaderNodeCombineXYZ")
        combine.inputs["Z"].default_value = 1.0
        # Incoming points to the eye, so its mirror image about the normal is the reflected ray turned round
        for source, sign, channel in ((reflect.outputs["Vector"], -1.0, "X"), (geometry.outputs["Incoming"], 1.0, "Y")):
            dot = tree.nodes.new("ShaderNodeVectorMath")
            dot.operation = "DOT_PRODUCT"
            tree.links.new(source, dot.inputs[0])
            tree.links.new(geometry.outputs["True Normal"], dot.inputs[1])
            shift = tree.nodes.new("ShaderNodeMath")
            shift.operation = "MULTIPLY_ADD"
            tree.links.new(dot.outputs["Value"], shift.inputs[0])
            shift.inputs[1].default_value, shift.inputs[2].default_value = sign, 2.0
            tree.links.new(shift.outputs["Value"], combine.inputs[channel])
        tree.links.new(combine.outputs["Vector"], emission.inputs["Color"])
        return material

    def _material(self, name: str):
        """Return a material that emits black, the tree of its node group, and its emission node."""
        group = bpy.data.node_groups.new(f"Code: {name}", "ShaderNodeTree")
        group.interface.new_socket("Surface", in_out="OUTPUT", socket_type="NodeSocketShader")
        emission, output = group.nodes.new("ShaderNodeEmission"), group.nodes.new("NodeGroupOutput")
        output.name = "Output"
        emission.inputs["Color"].default_value = (0.0, 0.0, 0.0, 1.0)
        group.links.new(emission.outputs["Emission"], output.inputs["Surface"])
        material = bpy.data.materials.new(f"Code: {name}")
        self._copied.owned += [group, material]
        self._groups[material.session_uid] = group
        # codes are no lights: nothing is to be sampled from them
        material.cycles.emission_sampling = "NONE"
        tree = compat.use_nodes(material)
        tree.nodes.clear()
        code, end = tree.nodes.new("ShaderNodeGroup"), tree.nodes.new("ShaderNodeOutputMaterial")
        code.node_tree = group
        tree.links.new(code.outputs["Surface"], end.inputs["Surface"])
        return material, group, emission

    def _attribute(self, tree: bpy.types.NodeTree, name: str) -> bpy.types.Node:
        node = tree.nodes.new("ShaderNodeAttribute")
        node.attribute_type, node.attribute_name = "GEOMETRY", name
        return node

    def _world_normal(self, tree: bpy.types.NodeTree, name: str) -> bpy.types.NodeSocket:
        """Return the attribute `name` of the mesh as a normal in world space, flipped to the visible side. Use the
        triangle's normal if the attribute has no length.
        """
        carried, seen = self._attribute(tree, name).outputs["Vector"], tree.nodes.new("ShaderNodeNewGeometry")
        none = tree.nodes.new("ShaderNodeMath")
        none.operation, none.inputs[1].default_value = "LESS_THAN", NO_LENGTH
        tree.links.new(_vector(tree, "LENGTH", carried).outputs["Value"], none.inputs[0])
        # a vector of zero length becomes NaN in world space
        some = _vector(tree, "ADD", carried, none.outputs["Value"])
        transform = tree.nodes.new("ShaderNodeVectorTransform")
        transform.vector_type, transform.convert_from, transform.convert_to = "NORMAL", "OBJECT", "WORLD"
        tree.links.new(some.outputs["Vector"], transform.inputs["Vector"])
        side = tree.nodes.new("ShaderNodeMath")
        side.operation = "MULTIPLY_ADD"
        tree.links.new(seen.outputs["Backfacing"], side.inputs[0])
        side.inputs[1].default_value, side.inputs[2].default_value = -2.0, 1.0
        turned = _vector(tree, "SCALE", transform.outputs["Vector"])
        tree.links.new(side.outputs["Value"], turned.inputs["Scale"])
        both = tree.nodes.new("ShaderNodeMix")
        both.data_type = "VECTOR"
        given = {socket.identifier: socket for socket in both.inputs}
        for source, socket in ((none.outputs["Value"], "Factor_Float"), (turned.outputs["Vector"], "A_Vector"),
                               (seen.outputs["Normal"], "B_Vector")):
            tree.links.new(source, given[socket])
        return next(socket for socket in both.outputs if socket.identifier == "Result_Vector")

    def _from_origin(self, tree: bpy.types.NodeTree, socket, emission: bpy.types.Node) -> None:
        subtract = tree.nodes.new("ShaderNodeVectorMath")
        subtract.operation = "SUBTRACT"
        subtract.inputs[1].default_value = self.origin
        tree.links.new(socket, subtract.inputs[0])
        tree.links.new(subtract.outputs["Vector"], emission.inputs["Color"])


def carry_normals(copied: CopiedScene) -> None:
    """Write the mirrors' shading normals into the attribute `MIRROR_NORMAL`, which Cycles does not round.

    Cycles interpolates them as unit vectors in world space, or in the object's where several objects share a mesh.
    Those of meshes that are flat all over are their triangles', be a face bent or not, and are not rounded.
    """
    places = {copy.data: np.array(copy.matrix_world, dtype=np.float64)[:3, :3] for copy, _ in copied.mirrors}
    users = Counter(copy.data for copy in copied.everything)
    for mesh, place in places.items():
        if mesh.normals_domain == "FACE":
            continue
        normals = np.empty((len(mesh.loops), 3), dtype=np.float32)
        mesh.corner_normals.foreach_get("vector", normals.reshape(-1))
        if users[mesh] == 1 and abs(np.linalg.det(place)) > 0.0:
            length = np.linalg.norm(normals @ np.linalg.inv(place), axis=1, keepdims=True)
            normals = (normals / np.where(length > 0.0, length, 1.0)).astype(np.float32)
        mesh.attributes.new(MIRROR_NORMAL, "FLOAT_VECTOR", "CORNER").data.foreach_set("vector", normals.reshape(-1))


def _vector(tree: bpy.types.NodeTree, operation: str, *sources: bpy.types.NodeSocket) -> bpy.types.Node:
    """Return a vector math node with `sources` as inputs."""
    node = tree.nodes.new("ShaderNodeVectorMath")
    node.operation = operation
    for source, socket in zip(sources, node.inputs):
        tree.links.new(source, socket)
    return node


def _glossy(tree: bpy.types.NodeTree) -> bpy.types.Node:
    """Add a perfect mirror, a white Glossy BSDF of roughness 0, to a node tree and return the node."""
    glossy = tree.nodes.new("ShaderNodeBsdfAnisotropic")
    glossy.distribution = "GGX"
    glossy.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    glossy.inputs["Roughness"].default_value = 0.0
    return glossy
