"""Samples whose light is painted: what mirrors show is emission, so that a reflection can be judged by its colours.

Each scene returns its mirror and the objects that take no part.
"""
from __future__ import annotations

from math import pi, radians

import numpy as np
from sample_parts import (
    BLUE,
    GREEN,
    ORANGE,
    RED,
    TEAL,
    VIOLET,
    WHITE,
    YELLOW,
    add,
    checks,
    eye,
    lit,
    mirror_material,
    moulded,
    picture,
)


def sphere() -> tuple:
    """A convex mirror between shapes, some of them behind the camera."""
    mirror = add("uv_sphere", "Mirror Sphere", (0, 0, 1.25), mirror_material("Mirror"), segments=48, ring_count=24,
                 smooth=True)
    add("grid", "Floor", (0, 0, 0), picture("Floor", checks(512, 14, (0.22, 0.16, 0.14), (0.93, 0.88, 0.78), [
        (0, 0, 1.0), (-2.1, 0.6, 0.9), (1.9, 0.9, 0.8), (1.1, -1.6, 0.5), (-1.1, -1.6, 0.6), (-4.2, -4.2, 1.2),
        (4.2, -4.0, 1.1), (0.6, 3.2, 1.2), (-0.4, -8.0, 1.3)], 9.0)),
        x_subdivisions=18, y_subdivisions=18, size=18)
    add("cube", "Red Cube", (-2.1, 0.6, 0.66), RED, size=1.3, rotation=(0, 0, 0.5))
    add("cone", "Yellow Cone", (1.9, 0.9, 0.91), YELLOW, radius1=0.75, depth=1.8, vertices=32, smooth=False)
    add("torus", "Teal Ring", (1.1, -1.6, 0.31), TEAL, major_radius=0.42, minor_radius=0.16, major_segments=32,
        minor_segments=12, smooth=True, rotation=(0.35, 0.2, 0))
    add("ico_sphere", "Violet Gem", (-1.1, -1.6, 0.46), VIOLET, radius=0.45, subdivisions=2)
    add("cylinder", "Green Column", (-4.2, -4.2, 1.51), GREEN, radius=0.6, depth=3.0, vertices=24)
    add("cylinder", "Blue Column", (4.2, -4.0, 1.51), BLUE, radius=0.6, depth=3.0, vertices=24)
    add("cube", "Orange Wall", (0.6, 3.2, 1.01), ORANGE, size=2, scale=(1.7, 0.12, 1.0))
    add("monkey", "Suzanne", (-0.6, -8.0, 2.2), WHITE, size=3.4, rotation=(0, 0, pi), smooth=True)
    eye((0.7, -5.6, 2.5), (0.0, 0.0, 1.05), 50)
    return mirror, ()


def flat_mirror() -> tuple:
    """A plane mirror of one quad over a floor of one quad: textures must be right inside large triangles."""
    mirror = add("plane", "Flat Mirror", (0, 1.6, 1.55), mirror_material("Mirror"), size=2, scale=(1.9, 1.35, 1),
                 rotation=(pi / 2, 0, 0))
    wood = lit("Wood", (0.16, 0.07, 0.03))
    frame = [add("cube", f"Frame {side}", place, wood, size=1, scale=scale) for side, place, scale in (
        ("left", (-1.99, 1.62, 1.55), (0.18, 0.14, 3.06)), ("right", (1.99, 1.62, 1.55), (0.18, 0.14, 3.06)),
        ("top", (0, 1.62, 2.99), (3.8, 0.14, 0.18)), ("bottom", (0, 1.62, 0.11), (3.8, 0.14, 0.18)))]
    add("plane", "Floor", (0, 0, 0), picture("Floor", checks(512, 16, (0.10, 0.18, 0.24), (0.90, 0.90, 0.86), [
        (-1.1, -0.5, 0.6), (0.9, -0.3, 0.7), (0.1, 0.5, 0.4), (-3.4, -3.4, 1), (3.2, -5.0, 1)], 6.0)), size=12)
    add("monkey", "Suzanne", (0.9, -0.3, 0.66), ORANGE, size=1.3, rotation=(-0.3, 0, pi - 0.7), smooth=True)
    add("cube", "Red Cube", (-1.1, -0.5, 0.46), RED, size=0.9, rotation=(0, 0, 0.6))
    add("ico_sphere", "Teal Ball", (0.1, 0.5, 0.36), TEAL, radius=0.35, subdivisions=4, smooth=True)
    add("cone", "Green Cone", (-3.4, -3.4, 1.51), GREEN, radius1=0.9, depth=3.0, vertices=32)
    add("cylinder", "Violet Column", (3.2, -5.0, 1.51), VIOLET, radius=0.6, depth=3.0, vertices=24)
    eye((-1.7, -4.9, 2.3), (0.0, 0.9, 1.1), 40)
    return mirror, frame


def bowl() -> tuple:
    """A concave mirror: near things upright and enlarged, far things upside down, caustics between."""
    radius, opening = 3.2, radians(34)

    def dish(points: np.ndarray) -> np.ndarray:
        longest = np.abs(points).max(axis=1)
        round_off = longest / np.maximum(np.linalg.norm(points, axis=1), 1e-12)
        angle, turn = longest * opening, points * np.where(longest > 0, round_off, 0.0)[:, None]
        turn /= np.maximum(np.linalg.norm(turn, axis=1, keepdims=True), 1e-12)
        flat = np.sin(angle)[:, None] * turn
        return radius * np.column_stack([flat[:, 0], np.cos(angle), flat[:, 1]])

    mirror = moulded("Bowl", 32, 32, dish, mirror_material("Mirror", metallic=True))
    mirror.location, mirror.rotation_euler = (0, -1.75, 1.55), (radians(-8), 0, 0)
    add("grid", "Floor", (0, -1, 0), picture("Floor", checks(512, 16, (0.20, 0.10, 0.22), (0.92, 0.90, 0.82), [
        (-0.75, 0.2, 0.35), (0.8, 0.3, 0.35), (-3.0, -4.0, 0.9), (3.0, -4.4, 0.9), (0, 2.2, 1.3)], 8.0)),
        x_subdivisions=16, y_subdivisions=16, size=16)
    add("cube", "Red Cube", (-0.75, -0.8, 0.26), RED, size=0.5, rotation=(0, 0, 0.4))
    add("cone", "Yellow Cone", (0.8, -0.7, 0.41), YELLOW, radius1=0.35, depth=0.8, vertices=32)
    add("cylinder", "Green Column", (-3.0, -5.0, 1.51), GREEN, radius=0.5, depth=3.0, vertices=24)
    add("cylinder", "Blue Column", (3.0, -5.4, 1.51), BLUE, radius=0.5, depth=3.0, vertices=24)
    add("torus", "Orange Ring", (0.0, -8.0, 2.2), ORANGE, major_radius=1.0, minor_radius=0.3, major_segments=40,
        minor_segments=14, rotation=(pi / 2, 0, 0), smooth=True)
    eye((0.6, -4.9, 2.1), (0, 0.6, 1.35), 44)
    return mirror, ()


def water() -> tuple:
    """Gentle waves, convex and concave in turn, flat enough that what stands behind stays on one sheet."""
    def waves(points: np.ndarray) -> np.ndarray:
        x, y = 6.2 * points[:, 0], 6.2 * points[:, 1] + 0.7
        height = (0.011 * np.sin(1.1 * x + 2.0 * y) + 0.008 * np.sin(-1.3 * x + 1.9 * y + 1.0)
                  + 0.005 * np.sin(2.6 * x + 0.7 * y + 2.0))
        return np.column_stack([x, y, height])

    mirror = moulded("Water", 40, 40, waves, mirror_material("Water"))
    add("cube", "Jetty", (-2.6, 4.4, 0.62), picture("Planks", checks(256, 12, (0.30, 0.17, 0.09), (0.80, 0.58, 0.34))),
        size=1, scale=(4.0, 1.4, 0.3))
    for k, x in enumerate((-4.2, -2.6, -1.0)):
        add("cylinder", f"Post {k + 1}", (x, 3.6, 0.75), WHITE, radius=0.14, depth=1.3, vertices=20, smooth=False)
    add("cube", "House", (-3.2, 4.5, 1.42), RED, size=1.3)
    add("cone", "Roof", (-3.2, 4.5, 2.47), VIOLET, radius1=1.15, depth=0.8, vertices=4, rotation=(0, 0, pi / 4))
    add("torus", "Gate", (1.9, 3.4, 1.62), ORANGE, major_radius=1.1, minor_radius=0.2, major_segments=40,
        minor_segments=14, rotation=(pi / 2, 0, -0.3), smooth=True)
    add("uv_sphere", "Buoy", (0.2, 1.6, 0.75), YELLOW, radius=0.42, segments=24, ring_count=12, smooth=True)
    add("monkey", "Suzanne", (4.0, 4.9, 1.3), TEAL, size=1.7, rotation=(0, 0, -0.5), smooth=True)
    add("grid", "Hills", (0, 6.95, 1.72), picture("Hills", _hills()), size=1, scale=(22, 3.4, 1), x_subdivisions=16,
        y_subdivisions=3, rotation=(pi / 2, 0, 0))
    eye((0.4, -7.6, 3.6), (0.0, 1.6, 0.75), 42)
    return mirror, ()


def _hills() -> np.ndarray:
    """Ridges in three greens before a sky of the evening."""
    x, y = np.meshgrid(np.linspace(0, 1, 512), np.linspace(0, 1, 128))
    pixels = np.array([0.98, 0.80, 0.62]) + y[..., None] * np.array([-0.45, -0.22, 0.18])
    ridges = ((0.62, (0.38, 0.48, 0.50), 3.1), (0.45, (0.24, 0.38, 0.34), 4.7), (0.25, (0.13, 0.26, 0.18), 7.3))
    for level, colour, f in ridges:
        ridge = level + 0.10 * np.sin(2 * pi * f * x + 9 * level) + 0.05 * np.sin(5 * pi * f * x + 4)
        pixels[y < ridge] = colour
    return pixels


def cylinder() -> tuple:
    """A developable mirror over a painted floor, as in anamorphic pictures."""
    def tube(points: np.ndarray) -> np.ndarray:
        angle = pi * points[:, 0]
        return np.column_stack([np.cos(angle), np.sin(angle), 1.25 * points[:, 1]])

    mirror = moulded("Mirror Cylinder", 64, 12, tube, mirror_material("Mirror", metallic=True))
    mirror.location = (0, 0.6, 1.35)
    lid = add("cylinder", "Lid", (0, 0.6, 2.64), lit("Lid", (0.10, 0.08, 0.07)), radius=1.03, depth=0.08, vertices=64)
    u = (np.arange(1536) + 0.5) / 768 - 1
    x, y = np.meshgrid(u * 6, u * 6 - 0.6)
    distance, angle = np.hypot(x, y), np.arctan2(y, x)
    wheel = np.array([0.50, 0.40, 0.42]) + 0.24 * np.cos(angle[..., None] + np.array([0.3, 2.4, 4.5]))
    ring = ((np.floor(distance / 0.55) + np.floor(angle / (pi / 12))) % 2)[..., None]
    fine = np.where(ring > 0, wheel, np.array([0.94, 0.90, 0.82]))
    soft = fine.reshape(512, 3, 512, 3, 3).mean(axis=(1, 3))
    add("grid", "Floor", (0, 0, 0), picture("Rings", soft), size=12, x_subdivisions=12, y_subdivisions=12)
    add("cube", "Red Cube", (-1.75, -0.5, 0.46), RED, size=0.9, rotation=(0, 0, 0.3))
    add("cone", "Yellow Cone", (1.7, -0.5, 0.71), YELLOW, radius1=0.6, depth=1.4, vertices=32)
    add("ico_sphere", "Teal Ball", (-0.2, -1.6, 0.41), TEAL, radius=0.4, subdivisions=4, smooth=True)
    add("cylinder", "Blue Column", (-3.4, -3.2, 1.51), BLUE, radius=0.5, depth=3.0, vertices=24)
    add("monkey", "Suzanne", (2.9, -4.4, 1.6), ORANGE, size=2.0, rotation=(0, 0, pi + 0.6), smooth=True)
    eye((0.5, -5.6, 3.3), (0.0, 0.2, 1.05), 45)
    return mirror, (lid,)


def suzanne() -> tuple:
    """Suzanne as the mirror, rounded by a modifier: convex, concave and seeing herself."""
    mirror = add("monkey", "Suzanne", (0, 0, 1.3), mirror_material("Mirror"), size=2.4, rotation=(-0.15, 0, 0.35),
                 smooth=True)
    rounding = mirror.modifiers.new("Subdivision", "SUBSURF")
    rounding.levels = rounding.render_levels = 1
    add("grid", "Floor", (0, -1, 0), picture("Floor", checks(512, 14, (0.42, 0.09, 0.07), (0.93, 0.87, 0.74), [
        (0, 1, 1.2), (-1.9, 0.4, 0.8), (1.9, 0.8, 0.8), (-2.8, -4.6, 0.8), (2.8, -4.6, 0.8)], 8.0)), size=16,
        x_subdivisions=16, y_subdivisions=16)
    add("cube", "Blue Cube", (-1.9, -0.6, 0.56), BLUE, size=1.1, rotation=(0, 0, 0.5))
    add("torus", "Green Ring", (1.9, -0.2, 0.92), GREEN, major_radius=0.7, minor_radius=0.2, major_segments=40,
        minor_segments=14, rotation=(pi / 2, 0, 0.6), smooth=True)
    add("cylinder", "Teal Column", (-2.8, -5.6, 1.51), TEAL, radius=0.5, depth=3.0, vertices=24)
    add("cylinder", "Orange Column", (2.8, -5.6, 1.51), ORANGE, radius=0.5, depth=3.0, vertices=24)
    add("plane", "Sky Panel", (0, -5.0, 5.2), picture("Panel", checks(128, 4, (0.55, 0.66, 0.80), (0.98, 0.98, 0.98))),
        size=5, rotation=(pi + 0.6, 0, 0))
    eye((0.7, -4.6, 2.1), (0.0, 0.0, 1.25), 50)
    return mirror, ()


def mirrors() -> tuple:
    """Two walls in a corner and a ball, all mirrors: each is seen in the others, as often as the depth allows."""
    wall = add("plane", "Wall Mirror", (0, 1.8, 1.6), mirror_material("Mirror"), size=2, scale=(2.2, 1.6, 1),
               rotation=(pi / 2, 0, 0))
    add("plane", "Side Mirror", (2.2, -0.2, 1.6), mirror_material("Side Mirror"), size=2, scale=(1.6, 1.9, 1),
        rotation=(0, -pi / 2, 0))
    add("uv_sphere", "Ball Mirror", (-1.0, 0.4, 0.8), mirror_material("Ball Mirror", metallic=True), radius=0.7,
        segments=64, ring_count=32, smooth=True)
    add("plane", "Floor", (0, 0, 0), picture("Floor", checks(512, 16, (0.10, 0.18, 0.24), (0.90, 0.90, 0.86), [
        (-1.0, 0.4, 0.7), (0.7, -0.4, 0.7), (-0.2, -1.6, 0.5), (-3.0, -3.0, 0.9)], 6.0)), size=12)
    add("monkey", "Suzanne", (0.7, -0.4, 0.75), ORANGE, size=1.2, rotation=(-0.3, 0, pi - 0.6), smooth=True)
    add("cube", "Red Cube", (-0.2, -1.6, 0.36), RED, size=0.7, rotation=(0, 0, 0.6))
    add("cone", "Green Cone", (-3.0, -3.0, 1.5), GREEN, radius1=0.8, depth=3.0, vertices=32)
    eye((-2.6, -5.2, 2.6), (0.5, 0.9, 1.1), 36)
    return wall, []
