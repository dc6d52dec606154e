"""Scenes: mirrors among objects before a camera, and how the operator is called, all drawn from one seed."""
from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from mathutils import Vector

from core import METHODS, PLACEMENTS
from tests.fuzz.blender.scene_cameras import drawn_camera
from tests.fuzz.blender.scene_changes import changed
from tests.fuzz.blender.scene_shapes import chosen, drawn_object

SMALL = 1000  # seeds below stand for small scenes; of those above every third stands for a large one


@dataclass(frozen=True)
class Scene:
    """What was built in the open file, and what `reflection_mesh.generate` is to be called with."""

    name: str
    options: dict
    mirrors: list


def built(seed: int) -> Scene:
    """Build the scene of a seed, the same every time, in a new empty file."""
    rng, large = np.random.default_rng(seed), seed >= SMALL and seed % 3 == 0
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    way = chosen(rng, ["role", "material", "active"])
    centre = Vector(3 * (chosen(rng, [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1e3, 1e6]),))
    direction = Vector(rng.normal(0.0, 1.0, 3).tolist()).normalized()
    names = [str(seed), way] + ([f"at {centre.x:g}"] if centre.x else [])
    mirrors, diffuse = [], []
    for number in range(1 if way == "active" else chosen(rng, [1, 2, 3] if large else [1, 1, 1, 2])):
        place = centre + _random(rng, 0.2 if number == 0 else chosen(rng, [0.5, 2.0]))
        mirrors.append(_placed(rng, f"Mirror{number}", mirrors, names, place, large))
        if rng.random() < 0.7:
            facing = direction + _random(rng, 0.3)
            mirrors[-1].rotation_euler = facing.to_track_quat("Z", "Y").to_euler()
        if way == "role":
            mirrors[-1].reflection_mesh.role = "MIRROR"
        elif way == "material":
            mirrors[-1].data.materials.append(_mirror_material())
    for number in range(chosen(rng, [2, 3, 5] if large else [1, 2, 3])):
        # before the mirror, or anywhere
        place = direction * float(rng.uniform(0.5, 3.0)) + _random(rng, 1.0) if rng.random() < 0.7 else \
            _random(rng, chosen(rng, [0.3, 3.0, 60.0]))
        diffuse.append(_placed(rng, f"Object{number}", mirrors + diffuse, names, centre + place, large))
        _materials(rng, diffuse[-1])
        if way == "role":
            diffuse[-1].reflection_mesh.role = "AUTO" if number and rng.random() < 0.3 else "DIFFUSE"
    names += _instances(rng, diffuse, centre, way)
    names.append(drawn_camera(rng, centre, direction, mirrors[0], large) + " camera")
    if rng.random() < 0.08:
        setattr(chosen(rng, mirrors + diffuse), chosen(rng, ["hide_render", "hide_viewport"]), True)
        names.append("hidden")
    bpy.context.view_layer.update()
    select(mirrors + diffuse if way != "role" else [], mirrors[0])
    options = _options(rng)
    names += [f"{value:g} px" if name == "tolerance" else str(value) for name, value in options.items()]
    return Scene(", ".join(names), options, mirrors)


def select(objects: list, active: bpy.types.Object | None) -> None:
    """Select these objects alone, as far as they can be."""
    for obj in bpy.context.view_layer.objects:
        obj.select_set(obj in objects and obj.visible_get())
    bpy.context.view_layer.objects.active = active


def _placed(rng: np.random.Generator, name: str, others: list, names: list, place: Vector,
            large: bool) -> bpy.types.Object:
    kind, obj = drawn_object(rng, name, large)
    names.append(" ".join([*changed(rng, obj, others), kind]))
    obj.location = place
    return obj


def _random(rng: np.random.Generator, spread: float) -> Vector:
    return Vector(rng.normal(0.0, spread, 3).tolist())


def _mirror_material() -> bpy.types.Material:
    material = bpy.data.materials.new("Mirror")
    if bpy.app.version < (5, 0, 0):
        material.use_nodes = True
    shader = next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    shader.inputs["Metallic"].default_value, shader.inputs["Roughness"].default_value = 1.0, 0.0
    return material


def _materials(rng: np.random.Generator, obj: bpy.types.Object) -> None:
    """Some slots, some of them empty."""
    for _ in range(chosen(rng, [0, 0, 1, 3])):
        obj.data.materials.append(chosen(rng, [None, bpy.data.materials.new("Colour")]))


def _instances(rng: np.random.Generator, diffuse: list, centre: Vector, way: str) -> list[str]:
    """An instance of a collection, or an object on the vertices or faces of another one."""
    if rng.random() < 0.1:
        _, inner = drawn_object(rng, "Inner", False)
        collection = bpy.data.collections.new("Kit")
        collection.objects.link(inner)
        bpy.context.scene.collection.objects.unlink(inner)
        empty = bpy.data.objects.new("Instance", None)
        empty.instance_type, empty.instance_collection = "COLLECTION", collection
        empty.location = centre + _random(rng, 2.0)
        bpy.context.scene.collection.objects.link(empty)
        diffuse.append(empty)
        if way == "role":
            empty.reflection_mesh.role = "DIFFUSE"
        return ["instance"]
    if rng.random() < 0.1 and len(diffuse) > 1 and all(obj.type == "MESH" for obj in diffuse[:2]) \
            and len(diffuse[0].data.vertices) < 40:
        diffuse[1].parent, diffuse[0].instance_type = diffuse[0], chosen(rng, ["VERTS", "FACES"])
        return ["on its parts"]
    return []


def _options(rng: np.random.Generator) -> dict:
    method = str(rng.choice(METHODS, p=[0.6, 0.2, 0.2]))
    depth = chosen(rng, [1, 1, 1, 2, 3]) if method != "POINTS" or rng.random() < 0.05 else 1
    return {"method": method, "placement": chosen(rng, PLACEMENTS), "depth": depth,
            "tolerance": chosen(rng, [0.5, 0.5, 1.0, 4.0, 0.1, 30.0])}
