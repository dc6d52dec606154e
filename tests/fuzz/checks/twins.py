"""Twins: a configuration listed in another order, moved, scaled or turned, which must give the same reflection."""
from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields, replace

import numpy as np

from core import ReflectionMesh, TriangleMesh
from tests.fuzz.drawing.configurations import Configuration
from tests.fuzz.drawing.placing import random_rotation
from tests.oracles.raster import rasterise
from tests.oracles.ray_hits import first_hits

SAME_AREA, PIXELS = 0.01, 4  # by which the pixels that are covered may differ: of the larger number, and pixels
COUNT = 100  # faces or points by which their numbers may differ, beside a share
LENGTHS = {"positions", "reflected_position", "mirror_position", "path_length"}
NOWHERE = np.zeros(3)
OF_TRIANGLES = ("source_face", "source_weights", "mirror_face", "later_mirrors")  # compared by where those lie


@dataclass(frozen=True)
class Twin:
    """A configuration, and how its reflection compares.

    Attributes
    ----------
    configuration : Configuration
    factor : float or None
        Of its lengths, where all numbers must agree to the last bit.
    share : float
        Else, by which the numbers of faces may differ.
    """

    configuration: Configuration
    factor: float | None = None
    share: float = 0.1


def listed_anew(rng: np.random.Generator, mesh: TriangleMesh, with_normals: bool) -> TriangleMesh:
    """The mesh with vertices and triangles in another order, each triangle begun at any corner."""
    vertex, triangle = rng.permutation(len(mesh.positions)), rng.permutation(len(mesh.triangles))
    turn = (rng.integers(0, 3, len(triangle))[:, None] + np.arange(3)) % 3
    named = np.take_along_axis(np.argsort(vertex)[mesh.triangles[triangle]], turn, axis=1)
    normals = np.take_along_axis(mesh.corner_normals[triangle], turn[:, :, None], axis=1) if with_normals else None
    return TriangleMesh(mesh.positions[vertex], named, normals)


def in_another_order(rng: np.random.Generator, one: Configuration) -> Twin:
    others = None if one.others is None else listed_anew(rng, one.others, True)
    return Twin(replace(one, mirror=listed_anew(rng, one.mirror, not one.flat),
                        scene=listed_anew(rng, one.scene, False), others=others), 1.0)


def again(rng: np.random.Generator, one: Configuration) -> Twin:
    return Twin(one, 1.0)


def scaled_exactly(rng: np.random.Generator, one: Configuration) -> Twin:
    """By a power of two, which changes no digit."""
    factor = 2.0 ** int(rng.choice([-40, -20, -3, 5, 20, 40]))
    return Twin(one.placed(np.eye(3), factor, NOWHERE), factor)


def scaled(rng: np.random.Generator, one: Configuration) -> Twin:
    return Twin(one.placed(np.eye(3), float(rng.choice([1e-6, 1e-3, 0.3, 7.0, 1e3, 1e6])), NOWHERE))


def moved(rng: np.random.Generator, one: Configuration) -> Twin:
    return Twin(one.placed(np.eye(3), 1.0, rng.normal(0.0, 1.0, 3) * rng.choice([1.0, 100.0, 1e4])))


def turned(rng: np.random.Generator, one: Configuration) -> Twin:
    """Among equals the order along the axes decides, and with it how much is split."""
    return Twin(one.placed(random_rotation(rng), 1.0, NOWHERE), share=0.5)


TWINS: dict[str, Callable[[np.random.Generator, Configuration], Twin]] = {
    "in another order": in_another_order, "again": again, "scaled exactly": scaled_exactly, "scaled": scaled,
    "moved": moved, "turned": turned}


def same_to_the_bit(mesh: ReflectionMesh, twin: ReflectionMesh, factor: float, one: Configuration,
                    other: Configuration) -> Iterator[str]:
    """Both meshes are one, lengths of the twin's `factor` times as large; numbers of source triangles aside."""
    for field in fields(mesh):
        values, found = getattr(mesh, field.name), getattr(twin, field.name)
        if field.name in OF_TRIANGLES or not isinstance(values, np.ndarray):
            continue
        if values.shape != found.shape:
            yield f"{field.name} is {values.shape} and {found.shape}"
            return
        if (values * (factor if field.name in LENGTHS else 1) != found).any():
            yield f"{field.name} differs"
    if mesh.counts != twin.counts:
        differing = sorted(name for name in mesh.counts if mesh.counts[name] != twin.counts.get(name))
        yield f"the counts {', '.join(differing)} differ"
    if (np.sort(mesh.source_weights, axis=2) != np.sort(twin.source_weights, axis=2)).any():
        yield "source_weights differs"
    for name, given, others in (("source_face", one.scene, other.scene), ("mirror_face", one.mirror, other.mirror),
                                 ("later_mirrors", one.mirrors, other.mirrors)):
        if not _same_triangles(given, getattr(mesh, name), others, getattr(twin, name), factor):
            yield f"{name} names other triangles"


def _same_triangles(mesh: TriangleMesh, faces: np.ndarray | None, other: TriangleMesh, others: np.ndarray | None,
                    factor: float) -> bool:
    """Both name the same triangles, -1 none, those of the other mesh `factor` times as large."""
    if faces is None or others is None:
        return faces is None and others is None
    known = faces >= 0
    return faces.shape == others.shape and bool((known == (others >= 0)).all()) and bool((
        _named(mesh, faces[known]) * factor == _named(other, others[known])).all())


def _named(mesh: TriangleMesh, faces: np.ndarray) -> np.ndarray:
    """The corners (n, 3, 3) of triangles in an order of their own."""
    corners = mesh.positions[mesh.triangles[faces]]
    order = np.lexsort(np.moveaxis(corners, 2, 0)[::-1], axis=1)
    return np.take_along_axis(corners, order[:, :, None], axis=1)


def nearly_the_same(mesh: ReflectionMesh, twin: ReflectionMesh, one: Configuration, other: Configuration,
                    share: float) -> Iterator[str]:
    """Both cover as much of the mirror that the eye sees, and have as many faces and points but for a `share`."""
    seen = mirror_seen(one)
    pixels = [int((rasterise(view, drawn.mirror_position, drawn.triangles).triangle[seen] >= 0).sum())
              for view, drawn in ((one.view, mesh), (other.view, twin))]
    if abs(pixels[0] - pixels[1]) > SAME_AREA * max(pixels) + PIXELS:
        yield f"{pixels[0]} and {pixels[1]} of {seen.sum()} pixels are covered"
    for name in ("triangles", "positions"):
        counts = len(getattr(mesh, name)), len(getattr(twin, name))
        if abs(counts[0] - counts[1]) > share * max(counts) + COUNT:
            yield f"there are {counts[0]} and {counts[1]} {name}"
            return


def mirror_seen(configuration: Configuration) -> np.ndarray:
    """Which pixels (n,) show the mirror, and nothing before it."""
    width, height = configuration.view.resolution
    pixels = np.stack(np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5), axis=-1).reshape(-1, 2)
    rays = configuration.view.rays(pixels)
    distance, others = first_hits(configuration.mirror, *rays)[1], [configuration.scene]
    others += [] if configuration.others is None else [configuration.others]
    before = np.min([first_hits(mesh, *rays)[1] for mesh in others], axis=0)
    return np.isfinite(distance) & (distance < before)
