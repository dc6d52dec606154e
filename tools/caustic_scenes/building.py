"""What the scenes are built of by which caustics are measured: lamps, metal, plaster, sheets."""
from __future__ import annotations

import numpy as np


def empty(eye: tuple, target: tuple) -> None:
    """An empty file with a camera and without a world."""
    import bpy
    from mathutils import Vector
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    scene = bpy.context.scene
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.collection.objects.link(camera)
    scene.camera, camera.location = camera, eye
    camera.rotation_euler = (Vector(target) - camera.location).to_track_quat("-Z", "Y").to_euler()


def lamp(kind: str, place: tuple, target: tuple, **values):
    """A lamp; the target of a sun is where it stands."""
    import bpy
    from mathutils import Vector
    data = bpy.data.lights.new("Lamp", kind)
    for name, value in values.items():
        setattr(data, name, value)
    made = bpy.data.objects.new("Lamp", data)
    bpy.context.scene.collection.objects.link(made)
    made.location = place
    way = Vector(target) - made.location if kind != "SUN" else -Vector(target)
    made.rotation_euler = way.to_track_quat("-Z", "Y").to_euler()
    return made


def material(name: str, kind: str, colour: tuple):
    """One shader alone."""
    import bpy
    made = bpy.data.materials.new(name)
    if bpy.app.version < (5, 0, 0):
        made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    shader, output = tree.nodes.new(kind), tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(shader.outputs[0], output.inputs["Surface"])
    shader.inputs["Color"].default_value = (*colour, 1.0)
    shader.inputs["Roughness"].default_value = 0.0
    return made


def metal(obj):
    """The object, smooth and a mirror."""
    obj.data.polygons.foreach_set("use_smooth", [True] * len(obj.data.polygons))
    return faceted(obj)


def faceted(obj):
    """The object, a mirror whose faces are as smooth as they are."""
    obj.data.materials.append(material("Metal", "ShaderNodeBsdfGlossy", (0.9, 0.9, 0.9)))
    return obj


def plain(kind: str, **values):
    """One of Blender's primitives, of plaster."""
    import bpy
    getattr(bpy.ops.mesh, f"primitive_{kind}_add")(**values)
    return plaster(bpy.context.object)


def plaster(obj):
    """The object, white and dull."""
    obj.data.materials.append(material("Plaster", "ShaderNodeBsdfDiffuse", (0.8, 0.8, 0.8)))
    return obj


def take_part(mirror, receivers: list, light) -> None:
    """Select what a run of *Generate Caustics* shall take."""
    import bpy
    bpy.context.view_layer.update()
    for obj in bpy.context.scene.objects:
        obj.select_set(obj in (mirror, *receivers, light))
    bpy.context.view_layer.objects.active = mirror


def sheet(name: str, points: np.ndarray, closed: bool = False):
    """A mesh of quads through points (rows, columns, 3); `closed`, its last column goes on with the first."""
    import bpy
    rows, columns = points.shape[:2]
    index = np.arange(rows * columns).reshape(rows, columns)
    if closed:
        index = np.concatenate((index, index[:, :1]), axis=1)
    quads = np.stack((index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]), axis=-1).reshape(-1, 4)
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(points.reshape(-1, 3).tolist(), [], quads.tolist())
    made = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(made)
    return made
