"""Meshes that emit light, as lamps: triangles of one radiance each, both of whose sides shine.

Cycles' Emission of the strength S has the radiance S times its colour in W/m2/sr.
"""
from __future__ import annotations

import bpy
import numpy as np

from ....core import Lamp, TriangleMesh
from ... import compat
from ...reading import is_mirror, read_scene
from ...reading.materials import surface_shader
from .constant_nodes import constant
from .eye import Eye, across

EMISSION = {"EMISSION": ("Color", "Strength"), "BSDF_PRINCIPLED": ("Emission Color", "Emission Strength")}
MANY = 1 << 14  # number of points that represent a whole mesh
GOLDEN = 0.6180339887498949
IN_PLANE = 1e-6  # relative to the lamp's size; tolerance for points in a plane


def is_mesh_lamp(obj: bpy.types.Object) -> bool:
    """Return True for a mesh that emits light, with one colour for each of its materials."""
    materials = [slot.material for slot in obj.material_slots]
    return (obj.type == "MESH" and obj.reflection_mesh.role == "AUTO" and not any(map(is_mirror, materials))
            and any(radiance_of(material).any() for material in materials))


def radiance_of(material: bpy.types.Material | None) -> np.ndarray:
    """Return the radiance (3,) of a material in W/m2/sr; zeros if it emits none or varies over the surface."""
    shader = surface_shader(material.node_tree) if material is not None and compat.uses_nodes(material) else None
    if shader is None or shader.type not in EMISSION:
        return np.zeros(3)
    colour, strength = (constant(shader.inputs[name]) for name in EMISSION[shader.type])
    if colour is None or strength is None:
        return np.zeros(3)
    return np.maximum(colour * strength, 0.0) * np.ones(3)


def eyes_of_mesh(depsgraph: bpy.types.Depsgraph, lamp: bpy.types.Object, count: int,
                 towards: np.ndarray) -> list[Eye]:
    """Return a mesh as `count` points spread evenly over its emitted power. For count 1, return its middle.

    Parameters
    ----------
    towards : (n, 3) float64
        Lit points. A point that lights them from both of its sides is returned twice.
    """
    scene = read_scene(depsgraph, [lamp])
    mesh = scene.mesh
    radiance = np.array([radiance_of(material) for material in scene.materials])[scene.material]
    corners = mesh.positions[mesh.triangles]
    facets = 0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = np.linalg.norm(facets, axis=1)
    weight = weight_of_all = area * radiance.sum(axis=1)
    chosen = np.flatnonzero(weight > 0.0)
    if not len(chosen):
        return []
    corners, facets, area, radiance, weight = (
        values[chosen] for values in (corners, facets, area, radiance, weight))
    if count == 1:
        middle = np.average(corners.mean(axis=1), axis=0, weights=weight)
        mean = np.average(radiance, axis=0, weights=area)
        return [Eye(Lamp(middle), mean, np.eye(3), "MESH", (0.0, 0.0), facets, _of(mesh, weight_of_all == 0.0))]
    corners, facets, area, radiance, weight = (
        values[_along_a_curve(corners.mean(axis=1))] for values in (corners, facets, area, radiance, weight))
    normals = facets / area[:, None]
    triangle, places = _spread(corners, weight, count)
    # equal power for all points, corrected for the light that the few points miss at the middle
    power = weight.sum() / count * _made_up(corners, weight, normals, (triangle, places), towards.mean(axis=0))
    found = []
    for index, place, share in zip(triangle, places, power):
        normal = normals[index]
        height = (towards - place) @ normal
        colour = share * radiance[index] / radiance[index].sum()
        away = np.abs((mesh.positions[mesh.triangles] - place) @ normal).max(axis=1)
        body = _of(mesh, away > IN_PLANE * float(np.ptp(corners.reshape(-1, 3), axis=0).max()))
        for side in (1.0, -1.0):
            if (side * height).max() > 0.0:
                axes = np.column_stack((across(normal), -side * normal))
                found.append(Eye(Lamp(place), colour, axes, "AREA", (0.0, 1.0), body=body))
    return found


def _made_up(corners: np.ndarray, weight: np.ndarray, normals: np.ndarray, chosen: tuple,
             middle: np.ndarray) -> np.ndarray:
    """Return the factor (count,) that corrects the power of the chosen points (triangles, places). Then the points on
    the triangles that face `middle` (3,) light it like all of these triangles do, and the others accordingly.
    """
    def sent(triangle: np.ndarray, places: np.ndarray) -> np.ndarray:
        way = middle - places
        return np.einsum("ij,ij->i", way, normals[triangle]) / np.maximum((way**2).sum(axis=1), 1e-300)**1.5
    some, all_of_it = sent(*chosen), sent(*_spread(corners, weight, MANY))
    factor = np.ones(len(some))
    for facing in (1.0, -1.0):
        few, many = (np.maximum(facing * light, 0.0) for light in (some, all_of_it))
        if few.sum() > 0.0:
            factor[few > 0.0] = many.mean() / few.mean()
    return factor


def _along_a_curve(points: np.ndarray) -> np.ndarray:
    """Return an order (n,) of points in which neighbours are close to each other (Morton's curve)."""
    low = points.min(axis=0)
    cell = ((points - low) / max(float(np.ptp(points, axis=0).max()), 1e-300) * 1023.0).astype(np.int64)
    code = np.zeros(len(points), dtype=np.int64)
    for bit in range(10):
        for axis in range(3):
            code |= ((cell[:, axis] >> bit) & 1) << (3 * bit + axis)
    return np.argsort(code, kind="stable")


def _of(mesh: TriangleMesh, chosen: np.ndarray) -> TriangleMesh | None:
    """Return the triangles of a mesh that are `chosen` (m,) bool; None if there are none."""
    return TriangleMesh(mesh.positions, mesh.triangles[chosen]) if chosen.any() else None


def _spread(corners: np.ndarray, weight: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return triangles (count,) and points (count, 3) on them, spread evenly by weight, from a rank-1 lattice."""
    number = np.arange(count)
    ends = np.cumsum(weight) / weight.sum()
    along = (number + 0.5) / count
    triangle = np.minimum(np.searchsorted(ends, along), len(weight) - 1)
    inside = (along - (ends - weight / weight.sum())[triangle]) / (weight / weight.sum())[triangle]
    beside = (number * GOLDEN + 0.5) % 1.0
    # map the unit square to the triangle, preserving areas
    root = np.sqrt(np.clip(inside, 0.0, 1.0))
    shares = np.stack((1.0 - root, root * (1.0 - beside), root * beside), axis=1)
    return triangle, np.einsum("ij,ijk->ik", shares, corners[triangle])
