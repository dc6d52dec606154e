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

THICKNESS = 2e-4  # relative to the mesh's size
SHINE = "Reflection Mesh Shine"
BRING_MATERIALS = {"SET_MATERIAL", "REPLACE_MATERIAL", "SET_MATERIAL_INDEX", "OBJECT_INFO", "COLLECTION_INFO"}
UNSEEN_BY = ("visible_camera", "visible_diffuse", "visible_transmission", "visible_volume_scatter", "visible_shadow")


def has_shell(lamp: bpy.types.Object) -> bool:
    """Return True if a mesh can have a shell. It cannot if nodes assign materials, since its slots do not show its
    emission then.
    """
    groups = [modifier.node_group for modifier in lamp.modifiers if modifier.type == "NODES"]
    return not any(node.type in BRING_MATERIALS for group in groups for node in all_nodes(group))


def shell_of(lamp: bpy.types.Object, name: str, whole: AllOrNothing) -> bpy.types.Object:
    """Return the shell of a mesh, its child, which is not linked to a collection yet."""
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
    """Copy the present brightness of a mesh to its shell if no nodes determine it."""
    for slot, own in zip(lamp.material_slots, shell.material_slots):
        known, shine = _emission(slot.material), own.material and own.material.node_tree.nodes.get(SHINE)
        for now, socket in zip(known, _inputs(shine)) if shine else ():
            if not (now.is_linked or socket.is_linked):
                _take(socket, now)


def forget_materials(materials: list) -> None:
    """Remove materials of shells that have no users any more."""
    for material in dict.fromkeys(materials):
        if material is not None and GLINT in material and material.users == 0:
            bpy.data.materials.remove(material)


def _shining(material: bpy.types.Material | None, name: str) -> bpy.types.Material:
    """Return a new material `name`: a Transparent BSDF plus the emission of `material`, none if that is None."""
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
    """Return a socket that is 1 or more where a shell does not shine: on the side of its mesh, behind diffuse surfaces,
    and for cameras in engines without ray visibility.
    """
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
    """Return the sockets with the colour and the strength of a material's emission; empty if it emits nothing."""
    shader = surface_shader(material.node_tree) if material is not None and compat.uses_nodes(material) else None
    return _inputs(shader) if shader is not None and shader.type in EMISSION else []


def _inputs(shader: bpy.types.Node) -> list[bpy.types.NodeSocket]:
    return [shader.inputs[name] for name in EMISSION[shader.type]]


def _take(socket: bpy.types.NodeSocket, other: bpy.types.NodeSocket) -> None:
    """Copy a socket's value to another socket if it differs."""
    value = np.array(other.default_value)
    if not np.array_equal(np.array(socket.default_value), value):
        socket.default_value = other.default_value


def _size(lamp: bpy.types.Object) -> float:
    return max(float(np.ptp(np.array(lamp.bound_box), axis=0).max()), 1e-6)
