"""Scenes that caustics were not made with, to see how they do: a goblet, crumpled foil, a curved front, a spoon, a
bridge."""
from __future__ import annotations

import numpy as np

from tools.caustic_scenes.building import empty, lamp, metal, plain, plaster, sheet, take_part


def _goblet() -> None:
    """A goblet of metal on a table, lit by an area lamp."""
    empty((1.6, -4.6, 3.2), (0.0, 0.0, 0.6))
    z = np.linspace(0.0, 1.8, 49)[:, None]
    angle = np.linspace(0.0, 2.0 * np.pi, 96, endpoint=False)
    radius = 0.06 + 0.4 * np.exp(-(z / 0.08)**2) + 0.5 * np.sin(2.2 * np.clip((z - 0.8) / 1.0, 0.0, 1.0))
    lathe = np.stack((radius * np.cos(angle), radius * np.sin(angle), np.broadcast_to(z + 0.002, (49, 96))), axis=-1)
    take_part(metal(sheet("Goblet", lathe, True)), [plain("plane", size=7.0)],
              lamp("AREA", (2.2, -1.2, 2.6), (0.0, 0.0, 1.0), energy=150.0, size=0.12))


def _foil() -> None:
    """Crumpled foil on the ground, in the sun before a wall: folds in all directions, from coarse to fine."""
    empty((-1.2, -4.8, 2.2), (0.0, 0.8, 1.0))
    rng, side = np.random.default_rng(7), np.linspace(-0.8, 0.8, 64)
    x, y = np.meshgrid(side, side, indexing="ij")
    z = 0.12 + 0.0 * x
    for wave in range(1, 13):
        way = rng.uniform(0.0, 2.0 * np.pi)
        phase = 3.0 * wave * (x * np.cos(way) + y * np.sin(way)) + rng.uniform(0.0, 2.0 * np.pi)
        # rounded ridges, as folds are
        z = z + 0.05 / wave * (2.0 / np.pi * np.arcsin(0.97 * np.sin(phase)))
    take_part(metal(sheet("Foil", np.stack((x, y, z), axis=-1))),
              [plain("plane", size=6.0, location=(0.0, 1.6, 2.0), rotation=(np.pi / 2, 0.0, 0.0))],
              lamp("SUN", (0.0, 0.0, 4.0), (0.2, -1.0, 0.9), energy=3.0, angle=0.009))


def _front() -> None:
    """A curved front of glass that throws the sun on a street with steps."""
    empty((-9.0, -16.0, 9.0), (0.0, 0.0, 0.5))
    angle = np.radians(np.linspace(-38.0, 38.0, 49))
    height = np.linspace(0.6, 6.0, 7)[:, None]
    curve = np.stack([np.broadcast_to(values, (7, 49)) for values in (
        9.0 * np.sin(angle), 9.0 * np.cos(angle) - 3.0, height)], axis=-1)
    steps = [plain("cube", size=1.0, location=(0.0, -6.0 + 0.7 * k, 0.15 + 0.15 * k),
                   scale=(7.0, 1.4 - 0.4 * k, 0.3)) for k in range(3)]
    take_part(metal(sheet("Front", curve)), [plain("plane", size=36.0), *steps],
              lamp("SUN", (0.0, 0.0, 12.0), (0.25, -1.0, 0.8), energy=3.0, angle=0.009))


def _spoon() -> None:
    """A spoon that leans over a napkin, before a lamp: its bowl throws a bent spot before it."""
    empty((-1.3, -2.6, 1.6), (0.0, -0.1, 0.1))
    round_, out = np.linspace(0.0, 2.0 * np.pi, 72, endpoint=False), np.linspace(0.02, 1.0, 24)[:, None]
    bowl = np.stack((0.34 * out * np.cos(round_), 0.5 * out * np.sin(round_) * (1.0 + 0.15 * np.sin(round_)),
                     np.broadcast_to(0.16 * out**2 - 0.1, (24, 72))), axis=-1)
    spoon = metal(sheet("Spoon", bowl, True))
    spoon.location, spoon.rotation_euler = (0.0, 0.3, 0.5), (1.75, 0.1, 0.25)
    take_part(spoon, [plain("plane", size=4.0), plain("plane", size=4.0, location=(0.0, 1.6, 1.0),
                                                      rotation=(np.pi / 2, 0.0, 0.0))],
              lamp("POINT", (0.5, -1.3, 1.1), (0.0, 0.0, 0.0), energy=60.0, shadow_soft_size=0.02))


def _bridge() -> None:
    """A river that throws the low sun under a bridge, on its vault and its pillars."""
    empty((0.6, -9.0, 1.7), (0.0, 0.0, 1.4))
    x, y = np.meshgrid(np.linspace(-2.6, 2.6, 80), np.linspace(-7.0, 2.0, 120), indexing="ij")
    z = sum(height * np.sin(a * x + b * y + c) for height, a, b, c in (
        (0.010, 1.9, 2.6, 0.0), (0.007, -3.7, 2.1, 1.0), (0.004, 5.3, 4.4, 2.0), (0.003, -1.2, 6.7, 0.5)))
    angle = np.linspace(0.0, np.pi, 41)[:, None]
    depth = np.linspace(-1.8, 1.8, 2)
    vault = np.stack((np.broadcast_to(2.6 * np.cos(angle), (41, 2)), np.broadcast_to(depth, (41, 2)),
                      np.broadcast_to(1.0 + 1.6 * np.sin(angle), (41, 2))), axis=-1)
    pillars = [plain("plane", size=1.0, location=(side * 2.6, 0.0, 0.4), scale=(1.2, 3.6, 1.0),
                     rotation=(0.0, -side * np.pi / 2, 0.0)) for side in (-1.0, 1.0)]
    take_part(metal(sheet("River", np.stack((x, y, z), axis=-1))), [plaster(sheet("Vault", vault)), *pillars],
              lamp("SUN", (0.0, 0.0, 5.0), (-0.2, -1.0, 0.42), energy=3.0, angle=0.009))


SCENES = {"goblet": _goblet, "foil": _foil, "front": _front, "spoon": _spoon, "bridge": _bridge}
