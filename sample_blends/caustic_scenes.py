"""Samples whose mirrors throw light: *Generate Caustics* shows it.

Each scene returns its mirror and the objects that take no part; of its lamps the `Sun` or the `Lamp` is meant.
"""
from __future__ import annotations

from math import pi, radians

import bpy
import numpy as np
from mathutils import Vector
from sample_parts import RED, TEAL, add, eye, fresnel_water, lamp, moulded, surface

LOOP = 48  # frames after which the water is as it was


def ring() -> tuple:
    """A gold ring on a table, by one lamp: the curve of light inside of it."""
    def tube(points: np.ndarray) -> np.ndarray:
        angle = pi * points[:, 0]
        return np.column_stack([np.cos(angle), np.sin(angle), 0.001 + 0.25 * (points[:, 1] + 1.0)])

    mirror = moulded("Ring", 192, 2, tube, surface("Gold", (0.95, 0.74, 0.38), Metallic=1.0, Roughness=0.0))
    add("plane", "Table", (0, 0, 0), surface("Walnut", (0.62, 0.48, 0.36), "Wave", "UV", 3.0, Roughness=1.0,
                                             Specular_IOR_Level=0.0), size=8)
    add("cube", "Dice", (-1.45, -0.75, 0.16), surface("Dice", RED, Roughness=0.6), size=0.32, rotation=(0, 0, 0.5))
    data = bpy.data.lights.new("Lamp", "POINT")
    data.energy, data.shadow_soft_size, data.color = 260.0, 0.02, (1.0, 0.86, 0.68)
    made = bpy.data.objects.new("Lamp", data)
    made.location = (3.0, 0.5, 1.7)
    bpy.context.scene.collection.objects.link(made)
    eye((0.5, -3.3, 2.6), (-0.1, 0.0, 0.1), 45)
    return mirror, ()


def pool() -> tuple:
    """An indoor pool in the morning sun: the water's waves throw their glitter on the walls and on the ceiling, and
    move through 48 frames."""
    water = moulded("Water", 48, 48, lambda points: np.column_stack([2.6 * points[:, 0], 3.0 * points[:, 1] - 1.6,
                                                                     np.full(len(points), -0.12)]),
                    fresnel_water("Water", (0.01, 0.085, 0.10)))
    _wave(water)
    smooth = water.modifiers.new("Subdivision", "SUBSURF")
    smooth.levels = smooth.render_levels = 1
    plaster, stone, wood, basin = (surface(name, colour, *texture, Roughness=1.0, Specular_IOR_Level=0.0)
                                   for name, colour, *texture in (
        ("Plaster", (0.80, 0.68, 0.54)), ("Stone", (0.50, 0.45, 0.38)),
        ("Wood", (0.40, 0.25, 0.14), "Wave", "UV", 36.0), ("Basin", (0.10, 0.42, 0.46), "Checker", "UV", 40.0)))
    _frame("Terrace", 0.0, (-4.0, -5.5, 4.0, 3.5), (-2.6, -4.6, 2.6, 1.4), stone)
    for name, place, scale, turn in (("Basin North", (0, 1.4, -0.15), (5.2, 0.3, 1), (pi / 2, 0, 0)),
                                     ("Basin East", (2.6, -1.6, -0.15), (0.3, 6.0, 1), (0, -pi / 2, 0))):
        add("plane", name, place, basin, size=1, scale=scale, rotation=turn)
    add("plane", "Back Wall", (0, 3.5, 1.8), plaster, size=1, scale=(8, 3.6, 1), rotation=(pi / 2, 0, 0))
    add("plane", "Right Wall", (4.0, -1.0, 1.8), plaster, size=1, scale=(3.6, 9, 1), rotation=(0, -pi / 2, 0))
    add("plane", "Ceiling", (0, -1.0, 3.6), wood, size=1, scale=(8, 9, 1), rotation=(pi, 0, 0))
    for k, y in enumerate((-3.6, -1.6, 0.4, 2.4)):
        add("cube", f"Beam {k + 1}", (0, y, 3.48), wood, size=1, scale=(8, 0.2, 0.24))
    add("torus", "Lifebuoy", (3.9, 0.9, 1.25), surface("Lifebuoy", (0.80, 0.10, 0.05), Roughness=0.5),
        major_radius=0.36, minor_radius=0.09, rotation=(0, pi / 2, 0), major_segments=40, minor_segments=12,
        smooth=True)
    add("uv_sphere", "Ball", (0.2, -0.6, 0.06), surface("Ball", (0.90, 0.55, 0.05), Roughness=0.4), radius=0.25,
        segments=24, ring_count=12, smooth=True)
    windows = _windows("Window Wall", -4.0, (-5.5, 3.5), [(-5.3, -2.9), (-2.7, -0.3), (-0.1, 2.3)], (0.3, 3.3, 3.6),
                       plaster)
    behind = add("plane", "Wall Behind", (0, -5.5, 1.8), plaster, size=1, scale=(8, 3.6, 1), rotation=(-pi / 2, 0, 0))
    _sun((0.85, 0.14, -0.40), 24.0, (1.0, 0.84, 0.62))
    lamp("Daylight", (-3.7, -2.0, 2.0), (1.0, 0.0, 1.2), 60.0, 3.0, (0.62, 0.78, 1.0))
    bpy.data.objects["Daylight"].visible_glossy = False
    eye((-2.9, -4.6, 1.75), (2.6, 0.2, 1.2), 24)
    scene = bpy.context.scene
    # the water is lit by the sun that it throws, so that Cycles' own caustics go by this switch alone
    scene.cycles.caustics_reflective = False
    scene.frame_start, scene.frame_end = 1, LOOP
    return water, (windows, behind)


def _wave(water: bpy.types.Object) -> None:
    """Trains of waves as shape keys, two for those of each period, whose values go round like the hand of a clock."""
    rng = np.random.default_rng(3)
    place = np.empty(3 * len(water.data.vertices))
    water.data.vertices.foreach_get("co", place)
    place = place.reshape(-1, 3)
    water.shape_key_add(name="Basis")
    for turns, length, height, count in ((1, 1.5, 0.0022, 4), (2, 0.9, 0.0008, 5), (3, 0.62, 0.00032, 5)):
        angle, start = rng.uniform(-1.1, 1.1, count) + 0.5 * pi * (np.arange(count) % 2), rng.uniform(0, 2 * pi, count)
        numbers = 2.0 * pi / (length * rng.uniform(0.85, 1.15, count))
        phase = place[:, :2] @ (numbers * np.stack((np.cos(angle), np.sin(angle)))) + start
        for name, values, offset in (("sin", np.sin(phase), 0.5 * pi), ("cos", np.cos(phase), pi)):
            key = water.shape_key_add(name=f"Waves {turns} {name}")
            key.slider_min = -1.0
            moved = place.copy()
            moved[:, 2] += height * values.sum(axis=1)
            key.data.foreach_set("co", moved.ravel())
            key.keyframe_insert("value", frame=1)
            curve = next(one for one in key.id_data.animation_data.action.fcurves if f'"{key.name}"' in one.data_path)
            made = curve.modifiers.new("FNGENERATOR")
            made.function_type, made.amplitude = "SIN", 1.0
            made.phase_multiplier = 2.0 * pi * turns / LOOP
            made.phase_offset = offset - made.phase_multiplier


def sunlight() -> tuple:
    """A bathroom under the roof: the sun comes in by a skylight and meets a round mirror, which throws it on the
    floor."""
    silver = surface("Silver", (0.93, 0.94, 0.92), Metallic=1.0, Roughness=0.0)
    place = (0.15, 1.46, 1.62)
    mirror = add("circle", "Round Mirror", place, silver, radius=0.72, vertices=96, fill_type="NGON",
                 rotation=(pi / 2, 0, 0))
    brass = surface("Brass", (0.45, 0.28, 0.10), Metallic=0.6, Roughness=0.4)
    add("torus", "Frame", place, brass, major_radius=0.745, minor_radius=0.03, major_segments=96, minor_segments=12,
        rotation=(pi / 2, 0, 0), smooth=True)
    paint, floor = (surface(name, colour, *texture, Roughness=1.0, Specular_IOR_Level=0.0)
                    for name, colour, *texture in (("Paint", (0.30, 0.40, 0.40)),
                                                   ("Floor", (0.62, 0.56, 0.48), "Checker", "UV", 16.0)))
    add("plane", "Floor", (0, -0.5, 0), floor, size=4)
    wall = add("plane", "Mirror Wall", (0, 1.5, 1.4), paint, size=1, scale=(4, 2.8, 1), rotation=(pi / 2, 0, 0))
    add("plane", "Left Wall", (-2.0, -0.5, 1.4), paint, size=1, scale=(2.8, 4, 1), rotation=(0, pi / 2, 0))
    add("plane", "Right Wall", (2.0, -0.5, 1.4), paint, size=1, scale=(2.8, 4, 1), rotation=(0, -pi / 2, 0))
    # behind the camera: what the mirror shows
    add("plane", "Back Wall", (0, -2.5, 1.4), paint, size=1, scale=(4, 2.8, 1), rotation=(-pi / 2, 0, 0))
    add("cube", "Door", (0.72, -2.48, 1.02), surface("Door", (0.42, 0.27, 0.15), "Wave", "UV", 3.0, Roughness=0.8),
        size=1, scale=(0.85, 0.05, 2.04))
    add("cube", "Towel", (1.55, -2.47, 1.35), surface("Towel", (0.75, 0.30, 0.22), Roughness=1.0), size=1,
        scale=(0.45, 0.04, 0.8))
    add("cube", "Shelf", (0.15, 1.36, 0.72), surface("Shelf", (0.50, 0.36, 0.22), "Noise", "UV", 8.0, Roughness=0.7),
        size=1, scale=(1.5, 0.26, 0.05))
    add("cylinder", "Bottle", (0.52, 1.33, 0.93), surface("Bottle", (0.06, 0.30, 0.34), Roughness=0.3), radius=0.055,
        depth=0.37, vertices=32)
    add("uv_sphere", "Soap", (-0.25, 1.32, 0.785), surface("Soap", (0.90, 0.45, 0.55), Roughness=0.4), radius=0.07,
        scale=(1.4, 1.0, 0.6), segments=24, ring_count=12, smooth=True)
    add("cylinder", "Stool", (1.15, 0.75, 0.22), surface("Stool", (0.72, 0.50, 0.28), Roughness=0.6), radius=0.26,
        depth=0.44, vertices=40)
    roof = _frame("Roof", 2.8, (-2.0, -2.5, 2.0, 1.5), (-0.45, 0.25, 1.75, 1.35), paint, True)
    _sun((-0.30, 0.45, -0.84), 9.0, (1.0, 0.90, 0.74))
    lamp("Daylight", (0.6, 0.6, 2.7), (0.3, 0.2, 0.0), 7.0, 1.0, (0.70, 0.84, 1.0))
    bpy.data.objects["Daylight"].visible_glossy = False
    eye((-0.85, -1.75, 1.75), (-0.06, 0.9, 1.0), 30)
    return mirror, (wall, roof)


def dish() -> tuple:
    """A concave mirror in the sun throws its focus on a table: curves, since the sun does not stand on its axis."""
    opening = radians(26)

    def cap(points: np.ndarray) -> np.ndarray:
        longest = np.abs(points).max(axis=1)
        turn = points * np.where(longest > 0, longest / np.maximum(np.linalg.norm(points, axis=1), 1e-12), 0.0)[:, None]
        angle = opening * np.linalg.norm(turn, axis=1)
        turn /= np.maximum(np.linalg.norm(turn, axis=1, keepdims=True), 1e-12)
        return 2.0 * np.column_stack([np.sin(angle) * turn[:, 0], np.cos(angle) - 1.0, np.sin(angle) * turn[:, 1]])

    mirror = moulded("Dish", 64, 64, cap, surface("Chrome", (0.92, 0.92, 0.94), Metallic=1.0, Roughness=0.0))
    mirror.location, mirror.rotation_euler = (0.45, 0.9, 1.02), (radians(12.5), 0, radians(-20.4))
    brass = surface("Brass", (0.45, 0.28, 0.10), Metallic=0.6, Roughness=0.4)
    foot = add("cylinder", "Foot", (0.55, 1.20, 0.03), brass, radius=0.42, depth=0.06, vertices=48)
    stem = add("cylinder", "Stem", (0.55, 1.20, 0.5), brass, radius=0.05, depth=1.0, vertices=24)
    add("plane", "Table", (0, 0, 0), surface("Table", (0.42, 0.36, 0.30), "Wave", "UV", 4.0, Roughness=1.0,
                                             Specular_IOR_Level=0.0), size=7)
    add("cube", "Dice", (-0.35, -0.25, 0.11), surface("Dice", RED, Roughness=0.6), size=0.22, rotation=(0, 0, 0.5))
    add("ico_sphere", "Marble", (0.75, -0.45, 0.1), surface("Marble", TEAL, Roughness=0.4), radius=0.1, subdivisions=4,
        smooth=True)
    _sun((0.45, 0.80, -0.32), 2.0, (1.0, 0.90, 0.74))
    eye((-1.3, -3.0, 2.1), (0.15, 0.3, 0.5), 48)
    return mirror, (foot, stem)


def _sun(direction: tuple, strength: float, colour: tuple) -> None:
    """A sun as wide as ours."""
    data = bpy.data.lights.new("Sun", "SUN")
    data.energy, data.color, data.angle = strength, colour, radians(0.53)
    made = bpy.data.objects.new("Sun", data)
    made.rotation_euler = Vector(direction).to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.collection.objects.link(made)


def _frame(name: str, height: float, box: tuple, hole: tuple, material: bpy.types.Material,
           down: bool = False) -> bpy.types.Object:
    """A level rectangle `box` round a rectangular `hole` (both x, y, x, y), with UVs as a plane has them."""
    x, y = (np.array((box[k], hole[k], hole[k + 2], box[k + 2])) for k in (0, 1))
    points = np.array([(a, b, 0.0) for b in y for a in x])
    quads = [(4 * j + i, 4 * j + i + 1, 4 * j + i + 5, 4 * j + i + 4) for j in range(3) for i in range(3)
             if (i, j) != (1, 1)]
    points[:, 2] = height
    return _sheet(name, points, [quad[::-1] if down else quad for quad in quads], (0, 1), material)


def _windows(name: str, x: float, depth: tuple, holes: list, heights: tuple,
             material: bpy.types.Material) -> bpy.types.Object:
    """An upright wall across x, facing +x, with windows from y to y; `heights` where these begin, and end, and the
    wall does."""
    y = [depth[0], *(value for hole in holes for value in hole), depth[1]]
    z = [0.0, *heights]
    points = np.array([(x, b, c) for c in z for b in y])
    count = len(y)
    quads = [(count * k + j, count * k + j + 1, count * k + count + j + 1, count * k + count + j) for k in range(3)
             for j in range(count - 1) if not (k == 1 and j % 2 == 1)]
    return _sheet(name, points, quads, (1, 2), material)


def _sheet(name: str, points: np.ndarray, quads: list, axes: tuple, material: bpy.types.Material) -> bpy.types.Object:
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(points.tolist(), [], quads)
    flat = points[:, axes]
    flat = (flat - flat.min(axis=0)) / np.ptp(flat, axis=0).max()
    mesh.uv_layers.new(name="UVMap").uv.foreach_set("vector", flat[np.ravel(quads)].astype(np.float32).ravel())
    mesh.materials.append(material)
    made = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(made)
    return made
