"""Light that stays with the objects, where materials ask for what an instance, its object or its instancer has."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from lamp_scenes import SIZE, link, picture, principled, scene_of, shader_of

PLACES = ((-0.6, 0.1, 0.4), (0.2, -0.3, 0.6), (0.9, 0.3, 0.2))


def _asking(kind: str, output: str, **settings) -> bpy.types.Material:
    """A material whose colour is what a node of the kind tells."""
    made = principled("Asking")
    tree = made.node_tree
    node = tree.nodes.new(kind)
    for name, value in settings.items():
        setattr(node, name, value)
    told = node.outputs[output]
    if told.type == "VALUE":
        ramp = tree.nodes.new("ShaderNodeValToRGB")
        for end, colour in zip(ramp.color_ramp.elements, ((0.9, 0.1, 0.1, 1.0), (0.1, 0.3, 0.9, 1.0))):
            end.color = colour
        link(tree, told, ramp.inputs[0])
        told = ramp.outputs[0]
    link(tree, told, shader_of(made).inputs["Base Color"])
    return made


def _carrier(box: bpy.types.Object, material: bpy.types.Material, kind: str) -> bpy.types.Object:
    """What instances a box of that material three times where the box stood."""
    box.data.materials[0] = material
    box.scale = 0.4, 0.4, 0.4
    box["hue"] = [0.2, 0.8, 0.3]
    middle = tuple(box.location)
    box.location = 0.0, 40.0, 0.0
    mesh = bpy.data.meshes.new("Carrier")
    mesh.from_pydata(PLACES, [], [(0, 1, 2)])
    carrier = bpy.data.objects.new("Carrier", mesh)
    carrier.location, carrier["warmth"] = middle, 0.8
    carrier.show_instancer_for_render = carrier.show_instancer_for_viewport = False
    bpy.context.scene.collection.objects.link(carrier)
    if kind == "particles":
        carrier.modifiers.new("Particles", "PARTICLE_SYSTEM")
        settings = carrier.particle_systems[0].settings
        settings.count, settings.frame_start, settings.frame_end, settings.lifetime = 6, -5.0, 1.0, 50.0
        settings.physics_type, settings.render_type, settings.instance_object = "NO", "OBJECT", box
        settings.particle_size, settings.size_random = 1.0, 0.4
        bpy.context.scene.frame_set(1)
    elif kind == "vertices":
        box.location = 0.0, 0.0, 0.0
        box.parent, carrier.instance_type = carrier, "VERTS"
    else:
        _by_nodes(carrier, box)
    return carrier


def _by_nodes(carrier: bpy.types.Object, box: bpy.types.Object) -> None:
    """Instances with a colour each."""
    tree = bpy.data.node_groups.new("Instances", "GeometryNodeTree")
    for side in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=side, socket_type="NodeSocketGeometry")
    given, end, points, info, store, random = (tree.nodes.new(kind) for kind in (
        "NodeGroupInput", "NodeGroupOutput", "GeometryNodeInstanceOnPoints", "GeometryNodeObjectInfo",
        "GeometryNodeStoreNamedAttribute", "FunctionNodeRandomValue"))
    info.inputs["Object"].default_value = box
    store.domain, store.data_type, random.data_type = "INSTANCE", "FLOAT_VECTOR", "FLOAT_VECTOR"
    store.inputs["Name"].default_value = "tint"
    value = next(socket for socket in store.inputs if socket.name == "Value" and socket.enabled)
    for output, socket in ((given.outputs[0], points.inputs["Points"]),
                           (info.outputs["Geometry"], points.inputs["Instance"]),
                           (points.outputs[0], store.inputs["Geometry"]),
                           (next(one for one in random.outputs if one.enabled), value),
                           (store.outputs[0], end.inputs[0])):
        tree.links.new(output, socket)
    carrier.modifiers.new("Instances", "NODES").node_group = tree


@pytest.mark.thorough
@pytest.mark.parametrize(("instances", "kind", "output", "settings"), [
    pytest.param("nodes", "ShaderNodeAttribute", "Vector", {"attribute_type": "INSTANCER", "attribute_name": "tint"},
                 marks=pytest.mark.skipif(bpy.app.version < (4, 5, 0), reason="Blender does not tell")),
    ("particles", "ShaderNodeParticleInfo", "Random", {}),
    *(pytest.param(*case, marks=pytest.mark.slow) for case in (
        ("particles", "ShaderNodeParticleInfo", "Location", {}), ("particles", "ShaderNodeParticleInfo", "Size", {}),
        ("vertices", "ShaderNodeAttribute", "Fac", {"attribute_type": "INSTANCER", "attribute_name": "warmth"}),
        ("vertices", "ShaderNodeAttribute", "Color", {"attribute_type": "OBJECT", "attribute_name": "hue"}),
        ("vertices", "ShaderNodeTexCoord", "Generated", {"from_instancer": True})))])
def test_what_materials_ask_is_answered_as_by_cycles(blank, room, instances, kind, output, settings):
    scene_of(blank)
    box = bpy.data.objects["Box"]
    carrier = _carrier(box, _asking(kind, output, **settings), instances)
    parts.select(carrier, bpy.data.objects["Floor"], bpy.data.objects["Mirror"])
    reference, other = picture(room), picture(room, seed=7)
    shows_it = np.abs(reference - _without(carrier, room)).max(axis=2) > 0.1
    shows_it[:SIZE // 5], shows_it[-SIZE // 5:] = False, False
    parts.generate()
    bpy.ops.reflection_mesh.light(samples=64)
    lit, noise = (np.sqrt(((shown - reference)[shows_it]**2).mean()) for shown in (picture(room), other))
    assert shows_it.sum() > 50 and lit < max(10.0**(-34.0 / 20.0), 1.3 * noise)


def _without(carrier: bpy.types.Object, room) -> np.ndarray:
    carrier.hide_render = True
    try:
        return picture(room)
    finally:
        carrier.hide_render = False
        # particles are forgotten where anything is switched
        bpy.context.scene.frame_set(bpy.context.scene.frame_current)
