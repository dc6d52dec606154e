"""What is done to an object drawn at random: shading, layers, materials, shape keys, modifiers, transforms, parents."""
from __future__ import annotations

import bpy
import numpy as np

from tests.fuzz.blender.scene_shapes import chosen

MODIFIERS = ("SUBSURF", "ARRAY", "SOLIDIFY", "BOOLEAN", "WIREFRAME", "DISPLACE", "MIRROR", "SCREW", "BEVEL",
             "TRIANGULATE", "WELD", "DECIMATE", "REMESH", "EDGE_SPLIT", "NODES")
FEW_FACES = 40  # below which a modifier that multiplies them may be used
LARGEST = 100.0  # coordinate that a modifier is asked to work on
TRANSFORMS = (*16 * ("plain",), *3 * ("uneven",), "flat", "tiny", "huge", "drawn out")
NAMES = ("UVMap", "path_length", "position", "a b", "µ")  # of layers: some are names of the result's own attributes


def changed(rng: np.random.Generator, obj: bpy.types.Object, others: list) -> list[str]:
    """Change the object in some ways; what was done."""
    done = []
    if obj.type == "MESH" and len(obj.data.polygons):
        for change, share in ((_shading, 1.0), (_own_normals, 0.1), (_layers, 0.3), (_odd_material_index, 0.1),
                              (_shape_keys, 0.12)):
            if rng.random() < share:
                done += change(rng, obj)
        if rng.random() < 0.25:
            done += _modifier(rng, obj, others)
    done += _transform(rng, obj)
    if rng.random() < 0.1:
        parent = bpy.data.objects.new("Parent", None)
        bpy.context.scene.collection.objects.link(parent)
        parent.scale, parent.rotation_euler = (1.0, chosen(rng, [2.0, -1.0, 0.1]), 1.0), rng.random(3).tolist()
        obj.parent = parent
        done.append("parented")
    return done


def _shading(rng: np.random.Generator, obj: bpy.types.Object) -> list[str]:
    smooth = rng.random(len(obj.data.polygons)) < chosen(rng, [0.0, 0.5, 1.0])
    obj.data.polygons.foreach_set("use_smooth", smooth)
    return []


def _own_normals(rng: np.random.Generator, obj: bpy.types.Object) -> list[str]:
    normals = rng.normal(0.0, 1.0, (len(obj.data.loops), 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    if rng.random() < 0.2:
        normals[::3] = 0.0
    obj.data.normals_split_custom_set(normals.tolist())
    return ["own normals"]


def _layers(rng: np.random.Generator, obj: bpy.types.Object) -> list[str]:
    for _ in range(chosen(rng, [1, 2, 9])):
        if len(obj.data.uv_layers) < 8:
            obj.data.uv_layers.new(name=chosen(rng, NAMES))
    for name in ("Col", "mirror_face"):
        kind, domain = chosen(rng, ["FLOAT_COLOR", "BYTE_COLOR"]), chosen(rng, ["POINT", "CORNER"])
        obj.data.color_attributes.new(name, kind, domain)
    return ["layers"]


def _odd_material_index(rng: np.random.Generator, obj: bpy.types.Object) -> list[str]:
    """An attribute of the name that Blender uses, of a type that it does not."""
    if "material_index" in obj.data.attributes:
        return []
    obj.data.attributes.new("material_index", chosen(rng, ["FLOAT", "INT", "BOOLEAN"]), chosen(rng, ["POINT", "FACE"]))
    return ["odd material index"]


def _shape_keys(rng: np.random.Generator, obj: bpy.types.Object) -> list[str]:
    obj.shape_key_add(name="Basis")
    key = obj.shape_key_add(name="Bent")
    key.value = chosen(rng, [0.5, 1.0])
    for point in key.data:
        point.co = [value + float(rng.normal(0.0, 0.3)) for value in point.co]
    return ["shape keys"]


def _modifier(rng: np.random.Generator, obj: bpy.types.Object, others: list) -> list[str]:
    kind = chosen(rng, MODIFIERS)
    if len(obj.data.polygons) > FEW_FACES and kind in ("SUBSURF", "SCREW", "ARRAY", "WIREFRAME", "BEVEL", "NODES"):
        kind = "TRIANGULATE"
    if not _ordinary(obj):
        kind = "TRIANGULATE"
    modifier = obj.modifiers.new("Modifier", kind)
    meshes = [other for other in others if _ordinary(other)]
    if kind == "BOOLEAN" and meshes:
        modifier.object = chosen(rng, meshes)
    elif kind == "SOLIDIFY":
        modifier.thickness = chosen(rng, [0.0, 0.1, -1.0])
    elif kind == "ARRAY":
        modifier.count = 3
    elif kind == "REMESH":
        modifier.mode, modifier.voxel_size = "VOXEL", 0.5
    elif kind == "SCREW":
        modifier.steps = modifier.render_steps = 5
    elif kind == "NODES":
        modifier.node_group = _instancing(rng)
    return [kind]


def _ordinary(obj: bpy.types.Object) -> bool:
    """Whether Blender's own modifiers can work on it: on numbers that are none they crash."""
    return obj.type == "MESH" and all(abs(value) < LARGEST for vertex in obj.data.vertices for value in vertex.co)


def _instancing(rng: np.random.Generator) -> bpy.types.NodeTree:
    """Nodes that put a cube on every vertex, some of them flat or inside out."""
    group = bpy.data.node_groups.new("Instances", "GeometryNodeTree")
    for way in ("INPUT", "OUTPUT"):
        group.interface.new_socket("Geometry", in_out=way, socket_type="NodeSocketGeometry")
    start, cube, points, end = (group.nodes.new(kind) for kind in (
        "NodeGroupInput", "GeometryNodeMeshCube", "GeometryNodeInstanceOnPoints", "NodeGroupOutput"))
    cube.inputs["Size"].default_value = (0.2, 0.2, 0.2)
    points.inputs["Scale"].default_value = chosen(rng, [(1.0, 1.0, 1.0), (0.0, 1.0, 1.0), (-1.0, 1.0, 1.0)])
    for output, socket in ((start.outputs[0], points.inputs["Points"]), (cube.outputs[0], points.inputs["Instance"]),
                           (points.outputs[0], end.inputs[0])):
        group.links.new(output, socket)
    return group


def _transform(rng: np.random.Generator, obj: bpy.types.Object) -> list[str]:
    """A rotation and a scale, sometimes one that leaves little of the object."""
    kind, size = chosen(rng, TRANSFORMS), chosen(rng, [0.5, 1.0, 2.0])
    if kind == "uneven":
        obj.scale = (rng.choice([-1.0, 1.0], 3) * rng.uniform(0.3, 3.0, 3)).tolist()
    else:
        obj.scale = {"plain": 3 * (size,), "flat": chosen(rng, [(1.0, 1.0, 0.0), (0.0, 0.0, 0.0), (1.0, 0.0, 0.0)]),
                     "tiny": 3 * (chosen(rng, [1e-4, 1e-6, 1e-10]),), "huge": 3 * (chosen(rng, [1e3, 1e5, 1e10]),),
                     "drawn out": (1.0, chosen(rng, [1e-3, 1e3]), 1.0)}[kind]
    if rng.random() < 0.7:
        obj.rotation_euler = rng.uniform(-3.2, 3.2, 3).tolist()
    return [] if kind == "plain" else [kind]
