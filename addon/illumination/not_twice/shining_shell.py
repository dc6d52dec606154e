"""A thin shell round a mesh that emits, which shines as it does, for the mirrors alone that the mesh does not light.

The shell is a copy of the object that shares its mesh. A face of it lies before each side of the mesh's own, lets all
light through and adds what the material emits, on the side that is turned away from the mesh.
"""
from __future__ import annotations

import bpy
import numpy as np
from mathutils import Matrix

from ... import compat
from ...faults import AllOrNothing
from ...reading.materials import all_nodes, one_output, surface_shader
from ..light_sources import EMISSION, GLINT

THICKNESS = 2e-4  # of the mesh's size
SHINE = "Reflection Mesh Shine"
BRING_MATERIALS = {"SET_MATERIAL", "REPLACE_MATERIAL", "SET_MATERIAL_INDEX", "OBJECT_INFO", "COLLECTION_INFO"}
UNSEEN_BY = ("visible_camera", "visible_diffuse", "visible_transmission", "visible_volume_scatter", "visible_shadow")


def has_shell(lamp: bpy.types.Object) -> bool:
    """Whether a mesh can have a shell: where nodes bring materials of their own, not its slots say how it shines."""
    groups = [modifier.node_group for modifier in lamp.modifiers if modifier.type == "NODES"]
    return not any(node.type in BRING_MATERIALS for group in groups for node in all_nodes(group))


def shell_of(lamp: bpy.types.Object, name: str, whole: AllOrNothing) -> bpy.types.Object:
    """The shell of a mesh, its child, in no collection yet."""
    materials = []
    for slot in lamp.material_slots:
        materials.append(_shining(slot.material, name))
        whole.undo(bpy.data.materials.remove, materials[-1])
    shell = lamp.copy()
    whole.undo(bpy.data.objects.remove, shell)
    shell.name = name
    shell.animation_data_clear()
    for each in [*shell.constraints]:
        shell.constraints.remove(each)
    for modifier in [*shell.modifiers]:
        if modifier.type == "PARTICLE_SYSTEM":
            shell.modifiers.remove(modifier)
    solid = shell.modifiers.new(name, "SOLIDIFY")
    solid.offset, solid.use_rim, solid.thickness = 0.0, False, THICKNESS * _size(lamp)
    shell.parent, shell.parent_type = lamp, "OBJECT"
    shell.matrix_parent_inverse.identity()
    shell.delta_location, shell.delta_scale = (0.0, 0.0, 0.0), (1.0, 1.0, 1.0)
    shell.delta_rotation_euler, shell.delta_rotation_quaternion = (0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0)
    shell.matrix_basis = Matrix.Identity(4)
    shell.instance_type, shell.reflection_mesh.role = "NONE", "IGNORE"
    for rays in UNSEEN_BY:
        setattr(shell, rays, False)
    for slot, material in zip(shell.material_slots, materials):
        slot.link, slot.material = "OBJECT", material
    return shell


def follow_materials(lamp: bpy.types.Object, shell: bpy.types.Object) -> None:
    """Let a shell shine as bright as its mesh does now, where no nodes say how bright."""
    for slot, own in zip(lamp.material_slots, shell.material_slots):
        known, shine = _emission(slot.material), own.material and own.material.node_tree.nodes.get(SHINE)
        for now, socket in zip(known, _inputs(shine)) if shine else ():
            if not (now.is_linked or socket.is_linked):
                _take(socket, now)


def forget_materials(materials: list) -> None:
    """Remove those of shells that nothing uses any more."""
    for material in dict.fromkeys(materials):
        if material is not None and GLINT in material and material.users == 0:
            bpy.data.materials.remove(material)


def _shining(material: bpy.types.Material | None, name: str) -> bpy.types.Material:
    """A copy of a material that lets all light through, and adds what it emits where its mirrors see it."""
    made = material.copy() if _emission(material) else bpy.data.materials.new(name)
    made.name, made[GLINT] = name, True
    made.cycles.emission_sampling = "NONE"
    tree = compat.use_nodes(made)
    found = _emission(made)
    add, join = tree.nodes.new, tree.links.new
    if not found:
        tree.nodes.clear()
        add("ShaderNodeOutputMaterial")
    output = one_output(tree)
    for link in [link for socket in output.inputs for link in socket.links]:
        tree.links.remove(link)
    through, added = add("ShaderNodeBsdfTransparent"), add("ShaderNodeAddShader")
    join(through.outputs[0], added.inputs[0])
    join(added.outputs[0], output.inputs["Surface"])
    if found:
        shine, mix = add("ShaderNodeEmission"), add("ShaderNodeMixShader")
        shine.name = SHINE
        for socket, known in zip(_inputs(shine), found):
            _take(socket, known)
            if known.is_linked:
                join(known.links[0].from_socket, socket)
        join(_dark(tree), mix.inputs["Fac"])
        join(shine.outputs[0], mix.inputs[1])
        join(mix.outputs[0], added.inputs[1])
    return made


def _dark(tree: bpy.types.NodeTree) -> bpy.types.NodeSocket:
    """1 or more where a shell shines not: on the side of its mesh, behind diffuse surfaces, and for cameras, which
    engines show it to that know of no visibility to rays."""
    path, side = tree.nodes.new("ShaderNodeLightPath"), tree.nodes.new("ShaderNodeNewGeometry")
    dark = path.outputs["Diffuse Depth"]
    for more in (path.outputs["Is Camera Ray"], side.outputs["Backfacing"]):
        largest = tree.nodes.new("ShaderNodeMath")
        largest.operation = "MAXIMUM"
        tree.links.new(dark, largest.inputs[0])
        tree.links.new(more, largest.inputs[1])
        dark = largest.outputs[0]
    return dark


def _emission(material: bpy.types.Material | None) -> list[bpy.types.NodeSocket]:
    """The sockets of a material that tell the colour and the strength of what it emits; none where none does."""
    shader = surface_shader(material.node_tree) if material is not None and compat.uses_nodes(material) else None
    return _inputs(shader) if shader is not None and shader.type in EMISSION else []


def _inputs(shader: bpy.types.Node) -> list[bpy.types.NodeSocket]:
    return [shader.inputs[name] for name in EMISSION[shader.type]]


def _take(socket: bpy.types.NodeSocket, other: bpy.types.NodeSocket) -> None:
    """Give a socket another's value, if it has not got it."""
    value = np.array(other.default_value)
    if not np.array_equal(np.array(socket.default_value), value):
        socket.default_value = other.default_value


def _size(lamp: bpy.types.Object) -> float:
    return max(float(np.ptp(np.array(lamp.bound_box), axis=0).max()), 1e-6)
