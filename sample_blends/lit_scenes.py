"""Samples with lamps, and with mirrors of a colour and a Fresnel of their own; and a drawing for a mirror.

Each scene returns its mirror and the objects that take no part.
"""
from __future__ import annotations

from math import pi

import bpy
import numpy as np
from sample_parts import (
    BLUE,
    RED,
    WHITE,
    YELLOW,
    add,
    eye,
    fresnel_water,
    lamp,
    leaf,
    lit,
    mirror_material,
    moulded,
    picture,
    surface,
)


def room() -> tuple:
    """A golden ball in a room with two lamps: shadows, light from wall to wall, textures of every kind."""
    gold = surface("Gold", (0.95, 0.78, 0.48), Metallic=1.0, Roughness=0.0)
    mirror = add("uv_sphere", "Golden Ball", (0, 0, 1.0), gold, radius=1.0, segments=64, ring_count=32, smooth=True)
    add("plane", "Tiles", (0, -1.5, 0), surface("Tiles", (0.80, 0.74, 0.66), "Checker", scale=18.0, Roughness=0.35),
        size=9)
    plaster = surface("Plaster", (0.78, 0.76, 0.70), Roughness=0.9)
    add("plane", "Left Wall", (-4.5, -1.5, 1.75), surface("Red Wall", (0.62, 0.12, 0.08), Roughness=0.9), size=1,
        scale=(3.5, 9, 1), rotation=(0, pi / 2, 0))
    add("plane", "Right Wall", (4.5, -1.5, 1.75), surface("Green Wall", (0.12, 0.42, 0.16), Roughness=0.9), size=1,
        scale=(3.5, 9, 1), rotation=(0, -pi / 2, 0))
    add("plane", "Back Wall", (0, 3.0, 1.75), plaster, size=1, scale=(9, 3.5, 1), rotation=(pi / 2, 0, 0))
    add("plane", "Front Wall", (0, -6.0, 1.75), surface("Bricks", (0.85, 0.48, 0.30), "Brick", scale=4.0,
                                                        Roughness=0.9), size=1, scale=(9, 3.5, 1),
        rotation=(-pi / 2, 0, 0))
    add("monkey", "Suzanne", (-1.9, -1.7, 0.72), surface("Marble", (0.85, 0.80, 0.86), "Noise", "Generated", 5.0),
        size=1.4, rotation=(-0.3, 0, 2.5), smooth=True)
    add("cube", "Crate", (1.9, -1.5, 0.5), surface("Wood", (0.60, 0.34, 0.14), "Wave", "Object", 2.0), size=1.0,
        rotation=(0, 0, 0.5))
    add("torus", "Blue Ring", (0.3, -2.4, 0.2), surface("Glaze", (0.05, 0.14, 0.65), Roughness=0.15),
        major_radius=0.55, minor_radius=0.19, major_segments=40, minor_segments=16, smooth=True)
    lamp("Ceiling Lamp", (1.5, -2.0, 3.4), (0.5, -1.5, 0), 260.0, 1.2)
    lamp("Warm Lamp", (-3.2, -4.6, 2.6), (0, -1, 0.8), 90.0, 0.5, (1.0, 0.62, 0.30))
    eye((0.6, -5.4, 2.0), (0.0, 0.0, 0.95), 48)
    return mirror, ()


def bathroom() -> tuple:
    """A tinted flat mirror over a shelf, before a wall of tiles."""
    silver = surface("Tinted Silver", (0.70, 0.86, 0.80), Metallic=1.0, Roughness=0.0)
    mirror = add("plane", "Mirror", (0, 1.48, 1.75), silver, size=1, scale=(2.6, 1.7, 1), rotation=(pi / 2, 0, 0))
    tiles = surface("Wall Tiles", (0.82, 0.86, 0.88), "Brick", scale=9.0, Roughness=0.2)
    wall = add("plane", "Mirror Wall", (0, 1.5, 1.6), tiles, size=1, scale=(6, 3.2, 1), rotation=(pi / 2, 0, 0))
    add("plane", "Floor", (0, -1.0, 0), surface("Floor", (0.30, 0.33, 0.36), "Checker", scale=24.0, Roughness=0.3),
        size=6, scale=(1, 5 / 6, 1))
    add("plane", "Door Wall", (0, -3.5, 1.6), surface("Paint", (0.80, 0.72, 0.58), Roughness=0.8), size=1,
        scale=(6, 3.2, 1), rotation=(-pi / 2, 0, 0))
    add("cube", "Door", (-1.0, -3.46, 1.05), surface("Door", (0.32, 0.17, 0.08), "Wave", "Object", 3.0,
                                                     Roughness=0.4), size=1, scale=(0.95, 0.06, 2.1))
    add("plane", "Side Wall", (3.0, -1.0, 1.6), tiles, size=1, scale=(3.2, 5, 1), rotation=(0, -pi / 2, 0))
    add("cube", "Shelf", (0, 1.2, 0.80), surface("Shelf", (0.55, 0.42, 0.28), "Noise", "Generated", 8.0), size=1,
        scale=(2.6, 0.5, 0.06))
    add("uv_sphere", "Soap", (-0.75, 1.12, 0.90), surface("Soap", (0.90, 0.45, 0.55), Roughness=0.25), radius=0.13,
        scale=(1.4, 1.0, 0.6), segments=32, ring_count=16, smooth=True)
    add("cylinder", "Bottle", (0.55, 1.15, 1.03), surface("Bottle", (0.06, 0.30, 0.34), Roughness=0.1), radius=0.1,
        depth=0.4, vertices=40, smooth=False)
    add("monkey", "Suzanne", (0.3, -0.6, 1.45), surface("Skin", (0.75, 0.45, 0.30), Roughness=0.5), size=1.0,
        rotation=(-0.1, 0, pi + 0.25), smooth=True)
    add("cube", "Towel", (2.9, -0.5, 1.5), surface("Towel", (0.10, 0.20, 0.55), "Checker", "Object", 8.0,
                                                   Roughness=1.0), size=1, scale=(0.08, 0.7, 1.0))
    lamp("Mirror Lamp", (0, 0.9, 2.9), (0, 0.4, 1.0), 60.0, 0.9, (1.0, 0.92, 0.80))
    lamp("Window", (-2.8, -1.5, 2.0), (0, -1.0, 1.0), 90.0, 1.2, (0.70, 0.85, 1.0))
    eye((-1.0, -2.6, 1.85), (0.15, 1.4, 1.55), 35)
    return mirror, (wall,)


def pond() -> tuple:
    """Water that mirrors by Fresnel, under a wall with posts and hanging leaves."""
    def waves(points: np.ndarray) -> np.ndarray:
        x, y = 6.0 * points[:, 0], 6.0 * points[:, 1]
        return np.column_stack([x, y, 0.010 * np.sin(1.2 * x + 1.9 * y) + 0.007 * np.sin(-1.5 * x + 2.1 * y + 1.0)])

    mirror = moulded("Pond", 40, 40, waves, fresnel_water("Water", (0.02, 0.05, 0.05)))
    add("cube", "Wall", (0, 5.2, 0.9), surface("Stone", (0.55, 0.50, 0.44), "Voronoi", "Object", 2.2, Roughness=0.9),
        size=1, scale=(12, 0.6, 2.2))
    for k, x in enumerate((-3.6, -1.2, 1.4, 3.8)):
        add("cylinder", f"Post {k + 1}", (x, 4.1, 0.9), surface(f"Post {k + 1}", (RED, YELLOW, BLUE, WHITE)[k],
                                                                Roughness=0.5), radius=0.18, depth=2.2, vertices=24)
    add("uv_sphere", "Buoy", (0.4, 1.9, 0.75), surface("Buoy", (0.90, 0.30, 0.03), Roughness=0.3), radius=0.4,
        segments=24, ring_count=12, smooth=True)
    leaves = [leaf("Green Leaf", (0.10, 0.42, 0.06)), leaf("Yellow Leaf", (0.80, 0.55, 0.05))]
    places = np.random.default_rng(5).uniform((-4.0, 2.2, 1.2), (4.5, 4.0, 2.6), (26, 3))
    for k, place in enumerate(places):
        turn = tuple(np.random.default_rng(k).uniform(-0.7, 0.7, 3) + (pi / 2, 0, 0))
        add("plane", f"Leaf {k + 1}", tuple(place), leaves[k % 2], size=0.55, rotation=turn)
    eye((0.5, -6.6, 2.6), (0.0, 2.0, 0.75), 42)
    return mirror, ()


def anamorphosis() -> tuple:
    """A tube of 7 cm on a sheet of A3: *Write Mirror UVs* puts the picture `Compass` of this file on it."""
    def tube(points: np.ndarray) -> np.ndarray:
        angle = pi * points[:, 0]
        return np.column_stack([0.035 * np.cos(angle), 0.035 * np.sin(angle), 0.07 + 0.065 * points[:, 1]])

    mirror = moulded("Mirror Tube", 64, 2, tube, mirror_material("Mirror"))
    mirror.location = (0, 0.085, 0)
    lid = add("cylinder", "Lid", (0, 0.085, 0.1375), lit("Lid", (0.10, 0.08, 0.07)), radius=0.036, depth=0.004,
              vertices=64)
    table = add("plane", "Table", (0, 0, -0.001), surface("Table", (0.20, 0.09, 0.04), "Wave", "Object", 6.0), size=1.4)
    add("plane", "Sheet", (0, 0, 0), surface("Paper", (0.8, 0.8, 0.8), Roughness=1.0), size=1, scale=(0.42, 0.297, 1))
    soft = _compass(1536).reshape(512, 3, 512, 3, 3).mean(axis=(1, 3))
    image = picture("Compass", soft).node_tree.nodes["Image Texture"].image
    image.use_fake_user = True
    bpy.data.materials.remove(bpy.data.materials["Compass"])
    eye((0, -0.38, 0.50), (0, 0.06, 0.05), 90)
    return mirror, (lid, table)


def _compass(size: int) -> np.ndarray:
    """A compass rose within a ring of checks, its north red: a picture that is neither symmetric nor plain."""
    u = (np.arange(size) + 0.5) / (0.5 * size) - 1.0
    x, y = np.meshgrid(u, u)
    distance, angle = np.hypot(x, y), np.arctan2(x, y)
    pixels = np.full((size, size, 3), (0.96, 0.92, 0.82))
    ring = np.floor(angle / (pi / 36)) % 2 == np.floor((distance - 0.72) / 0.06) % 2
    pixels[(0.72 < distance) & (distance < 0.84) & ring] = (0.12, 0.16, 0.30)
    for points, reach, turn, colours in ((4, 0.45, pi / 4, ((0.30, 0.50, 0.52), (0.62, 0.76, 0.74))),
                                         (4, 0.68, 0.0, ((0.12, 0.16, 0.30), (0.55, 0.60, 0.74)))):
        off = (angle - turn + pi / points) % (2 * pi / points) - pi / points
        along, across = distance * np.cos(off), distance * np.abs(np.sin(off))
        star = across < 0.32 * (reach - along)
        star &= along > 0.0
        for side, colour in zip((off < 0, off >= 0), colours):
            pixels[star & side] = colour
    north = (np.abs(angle) < pi / 4) & (np.abs(x) < 0.32 * (0.68 - y)) & (y > np.abs(x))
    pixels[north & (x < 0)], pixels[north & (x >= 0)] = (0.72, 0.10, 0.08), (0.92, 0.45, 0.36)
    # an N above it
    n = (np.abs(y - 0.915) < 0.06) & (np.abs(x) < 0.05)
    pixels[n & ((np.abs(x) > 0.032) | (np.abs(x + (y - 0.915) * 0.75) < 0.014))] = (0.72, 0.10, 0.08)
    return pixels
