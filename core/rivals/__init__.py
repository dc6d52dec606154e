"""Baselines that the method is compared with, one module each, on the primary hits that all of them share.

The method does not depend on its baselines: only the tools, the benchmark and the comparisons of `addon` may import
them. In come a view, meshes and a value of the baseline's parameter; out come the point seen at each pixel's centre,
and the cost.
"""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, TypeVar

from ..geometry import TriangleMesh
from ..views import View
from .billboards import billboarded
from .clustering import clustered
from .environment import boxed, mapped
from .forward import drawn_mesh, parallel, points, refined, unrefined
from .morphing import morphed
from .pixel_blocks import cast_by_blocks
from .primary_hits import PrimaryHits, eye_depths, primary_hits
from .ray_tracing import traced
from .rival_picture import ITSELF, NOTHING, RivalPicture, Work

Knob = TypeVar("Knob", int, float)


@dataclass(frozen=True)
class Rival(Generic[Knob]):
    """One method of the comparison.

    Attributes
    ----------
    title : str
    knob : str
        What trades error for time.
    values : tuple
        Of the knob, from the coarsest to the finest.
    run : callable
        (view, mirror, scene, value of the knob, primary hits) -> RivalPicture
    """

    title: str
    knob: str
    values: tuple[Knob, ...]
    run: Callable[[View, TriangleMesh, TriangleMesh, Knob, PrimaryHits], RivalPicture]


METHODS: dict[str, Rival[int] | Rival[float]] = {
    "RAYS": Rival("Ray tracing", "pixels across a ray's block", (8, 4, 2, 1), traced),
    "CLUSTERS": Rival("Ray tracing with clustering", "pixels across a tile, 0: none", (0, 64, 32, 16), clustered),
    "ENVIRONMENT": Rival("Environment map", "texels across a side", (64, 128, 256, 512), mapped),
    "ENVIRONMENT_BOX": Rival("Environment map with a box", "texels across a side", (64, 128, 256, 512), boxed),
    "MORPHING": Rival("Reflection morphing", "rays", (250, 1000, 4000, 16000), morphed),
    "BILLBOARDS": Rival("Billboard impostors", "texels across a side", (32, 64, 128, 256), billboarded),
    "POINTS": Rival("Points", "points of the surface", (10_000, 30_000, 100_000), points),
    "PARALLEL": Rival("Parallel three-ray camera", "times the mirror is quartered", (0, 1, 2), parallel),
    "UNREFINED": Rival("General three-ray camera, not refined", "times the mirror is quartered", (0, 1, 2), unrefined),
    "GENERAL": Rival("General three-ray camera, refined", "tolerance in pixels", (2.0, 1.0, 0.5, 0.25), refined),
}

__all__ = ["ITSELF", "METHODS", "NOTHING", "PrimaryHits", "Rival", "RivalPicture", "Work", "cast_by_blocks",
           "drawn_mesh", "eye_depths", "morphed", "primary_hits"]
