"""Small scenes for the tests, and pictures of a file's state to compare."""
from __future__ import annotations

import re

import bpy
import numpy as np


def material(name: str, kind: str = "EMISSION", roughness: float = 0.0, metallic: float = 1.0) -> bpy.types.Material:
    """A material with one shader: EMISSION, GLOSSY, DIFFUSE or PRINCIPLED."""
    made = bpy.data.materials.new(name)
    if bpy.app.version < (5, 0, 0):
        made.use_nodes = True
    nodes = made.node_tree.nodes
    nodes.clear()
    shader = nodes.new({"EMISSION": "ShaderNodeEmission", "GLOSSY": "ShaderNodeBsdfAnisotropic",
                        "DIFFUSE": "ShaderNodeBsdfDiffuse", "PRINCIPLED": "ShaderNodeBsdfPrincipled"}[kind])
    if kind in {"GLOSSY", "PRINCIPLED"}:
        shader.inputs["Roughness"].default_value = roughness
    if kind == "PRINCIPLED":
        shader.inputs["Metallic"].default_value = metallic
    made.node_tree.links.new(shader.outputs[0], nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    return made


def add(kind: str, name: str, **options) -> bpy.types.Object:
    """A primitive, not selected: add("cube", "Box", location=(1, 0, 0))."""
    getattr(bpy.ops.mesh, f"primitive_{kind}_add")(**options)
    obj = bpy.context.object
    obj.name = name
    obj.select_set(False)
    return obj


def add_wall_mirror(name: str = "Mirror") -> bpy.types.Object:
    """A flat mirror of 4 x 4 at y = 1 that faces the camera of the fixture `blank`."""
    return add("plane", name, size=4.0, location=(0.0, 1.0, 1.0), rotation=(np.pi / 2, 0.0, 0.0))


def add_triangle(name: str, corners, uv=((0, 0), (1, 0), (0, 1))) -> bpy.types.Object:
    """One triangle with a UV map, linked to the scene."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(corners, [], [(0, 1, 2)])
    mesh.uv_layers.new(name="UVMap").uv.foreach_set("vector", np.array(uv, dtype=np.float32).ravel())
    obj = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(obj)
    bpy.context.view_layer.update()
    return obj


def select(*objects: bpy.types.Object) -> None:
    """Select these objects alone; the last is active."""
    bpy.ops.object.select_all(action="DESELECT")
    for obj in objects:
        obj.select_set(True)
    bpy.context.view_layer.objects.active = objects[-1] if objects else None


def generate(**options) -> bpy.types.Object:
    """Generate and return the active result."""
    assert bpy.ops.reflection_mesh.generate("EXEC_DEFAULT", **options) == {"FINISHED"}
    return bpy.context.view_layer.objects.active


def refusal(operator=None, **options) -> str:
    """The one sentence with which the operator refuses; the file's state must stay as it was."""
    before = state()
    try:
        (operator or bpy.ops.reflection_mesh.generate)("EXEC_DEFAULT", **options)
    except RuntimeError as error:
        message = str(error)
    else:
        raise AssertionError("The operator did not refuse.")
    assert state() == before
    # the operator says it as it runs, or, where that is cheap to tell, before, beside its grey button
    told = re.fullmatch(r"(?:Error: |Operator bpy\.ops\.reflection_mesh\.\w+\.poll\(\) )(.*)", message.strip())
    assert told and "Traceback" not in message
    sentence = told[1]
    assert "\n" not in sentence and sentence.endswith(".")
    return sentence


def attribute(obj: bpy.types.Object, name: str) -> np.ndarray:
    """Values of a mesh attribute as an array."""
    data = obj.data.attributes[name]
    field, width = {"FLOAT_VECTOR": ("vector", 3), "FLOAT2": ("vector", 2), "FLOAT_COLOR": ("color", 4),
                    "BYTE_COLOR": ("color", 4), "INT": ("value", 1), "FLOAT": ("value", 1)}[data.data_type]
    values = np.empty(len(data.data) * width, dtype=np.int32 if data.data_type == "INT" else np.float32)
    data.data.foreach_get(field, values)
    return values.reshape(-1, width) if width > 1 else values


def corners(obj: bpy.types.Object) -> np.ndarray:
    """Vertex of each face corner, (m, 3)."""
    values = np.empty(len(obj.data.loops), dtype=np.int32)
    obj.data.attributes[".corner_vert"].data.foreach_get("value", values)
    return values.reshape(-1, 3)


def state() -> dict:
    """What a refused or cancelled operator must leave as it is: data, objects' settings, selection, render settings."""
    scene, layer = bpy.context.scene, bpy.context.view_layer
    kinds = ("objects", "meshes", "materials", "collections", "images", "scenes", "cameras", "lights",
             "node_groups", "worlds")
    objects = {
        obj.name: (obj.select_get(), obj.hide_get(), obj.hide_viewport, obj.hide_render, obj.visible_camera,
                   obj.visible_glossy, obj.visible_shadow, obj.mode, obj.reflection_mesh.role,
                   obj.data.name if obj.data else None, _finite_text(obj.matrix_world),
                   len(obj.data.vertices) if obj.type == "MESH" else 0)
        for obj in layer.objects}
    render = {name: getattr(scene.render, name) for name in scene.render.bl_rna.properties.keys()
              if isinstance(getattr(scene.render, name), int | float | str | bool)}
    # any render leaves its result as an image
    return {"data": {kind: sorted(item.name for item in getattr(bpy.data, kind)
                                  if getattr(item, "type", "") != "RENDER_RESULT") for kind in kinds},
            "objects": objects, "active": getattr(layer.objects.active, "name", None), "render": render,
            "frame": scene.frame_current, "camera": getattr(scene.camera, "name", None)}


def _finite_text(matrix) -> str:
    return " ".join(f"{value:.6g}" for row in matrix for value in row)
