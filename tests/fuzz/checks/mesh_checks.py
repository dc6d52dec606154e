"""What holds in every reflection mesh, whatever it shows: lengths, ranges, numbers, weights, paths."""
from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields

import numpy as np

from core import ReflectionMesh
from tests.fuzz.drawing.configurations import Configuration

ROUNDING = 1e-9
PER_POINT = {"positions": 3, "reflected_position": 3, "mirror_position": 3, "path_length": 0, "image_parity": 0}
PER_FACE = {"triangles": (3,), "source_face": (), "source_weights": (3, 3), "mirror_face": (), "bounces": ()}


def finite(configuration: Configuration, mesh: ReflectionMesh) -> Iterator[str]:
    """No array holds a number that is none."""
    for part in (mesh, mesh.discs) if mesh.discs is not None else (mesh,):
        for field in fields(part):
            values = getattr(part, field.name)
            if isinstance(values, np.ndarray) and not np.isfinite(values).all():
                yield f"finite: {field.name} holds {np.count_nonzero(~np.isfinite(values))} numbers that are none"
    if not (np.isfinite(mesh.estimated_error) and mesh.estimated_error >= 0.0):
        yield f"finite: the estimated error is {mesh.estimated_error}"


def lengths(configuration: Configuration, mesh: ReflectionMesh) -> Iterator[str]:
    """One entry for each point, or for each face."""
    for name, width in PER_POINT.items():
        if getattr(mesh, name).shape != ((len(mesh.positions), width) if width else (len(mesh.positions),)):
            yield f"lengths: {name} is {getattr(mesh, name).shape} for {len(mesh.positions)} points"
    for name, shape in PER_FACE.items():
        if getattr(mesh, name).shape != (len(mesh.triangles), *shape):
            yield f"lengths: {name} is {getattr(mesh, name).shape} for {len(mesh.triangles)} faces"
    if (mesh.discs is None) == (configuration.settings.method == "POINTS"):
        yield "lengths: points have discs, and faces have none"
    if mesh.discs is not None and (len(mesh.triangles) or len(mesh.discs.radius) != len(mesh.positions)):
        yield f"lengths: {len(mesh.discs.radius)} discs for {len(mesh.positions)} points, {len(mesh.triangles)} faces"


def ranges(configuration: Configuration, mesh: ReflectionMesh) -> Iterator[str]:
    """Every index names something that is there."""
    bounds = [("triangles", mesh.triangles, 0, len(mesh.positions)),
              ("source_face", mesh.source_face, 0, len(configuration.scene.triangles)),
              ("mirror_face", mesh.mirror_face, -1, len(configuration.mirror.triangles)),
              ("bounces", mesh.bounces, 1, configuration.settings.depth + 1),
              ("image_parity", mesh.image_parity, -1, 2)]
    if mesh.discs is not None:
        bounds += [("source_vertex", mesh.discs.source_vertex, 0, len(configuration.scene.positions)),
                   ("discs' mirror_face", mesh.discs.mirror_face, 0, len(configuration.mirror.triangles))]
    for name, values, low, high in bounds:
        if len(values) and not low <= values.min() <= values.max() < high:
            yield f"ranges: {name} reaches from {values.min()} to {values.max()}, not from {low} to {high - 1}"


def corners(configuration: Configuration, mesh: ReflectionMesh) -> Iterator[str]:
    """No face names a point twice, no two faces are one, and no point is left over."""
    named = np.sort(mesh.triangles, axis=1)
    twice = np.count_nonzero((named[:, 1:] == named[:, :-1]).any(axis=1))
    if twice:
        yield f"corners: {twice} faces name a point twice"
    if len(np.unique(named, axis=0)) < len(named):
        yield f"corners: {len(named) - len(np.unique(named, axis=0))} faces are others once more"
    left = len(mesh.positions) - len(np.unique(named))
    if left and mesh.discs is None:
        yield f"corners: {left} points belong to no face"


def weights(configuration: Configuration, mesh: ReflectionMesh) -> Iterator[str]:
    """Barycentric coordinates: none negative, together one."""
    of_discs = mesh.discs.mirror_weights[:, None] if mesh.discs is not None else np.zeros((0, 1, 3))
    for name, values, least in (("source_weights", mesh.source_weights, 0.0), ("mirror_weights", of_discs, -1e-6)):
        if values.size and values.min() < least:
            yield f"weights: {name} are {values.min():.3g} somewhere"
        if values.size and np.abs(values.sum(axis=2) - 1.0).max() > ROUNDING:
            yield f"weights: {name} make up {np.abs(values.sum(axis=2) - 1.0).max():.3g} more or less than one"


def paths(configuration: Configuration, mesh: ReflectionMesh) -> Iterator[str]:
    """A path after one bounce is the straight way from the mirror, after more it is at least that."""
    if not len(mesh.positions):
        return
    if mesh.path_length.min() < 0.0:
        yield f"paths: one is {mesh.path_length.min():.3g} long"
    straight = np.linalg.norm(mesh.reflected_position - mesh.mirror_position, axis=1)
    shorter = (straight - mesh.path_length) / configuration.size
    once = np.full(len(straight), mesh.discs is not None)
    once[mesh.triangles[mesh.bounces == 1]] = True
    if shorter.max() > ROUNDING:
        yield f"paths: one is {shorter.max():.3g} of the scene shorter than the straight way"
    if -shorter[once].min(initial=0.0) > ROUNDING:
        yield f"paths: one of a single bounce is {-shorter[once].min():.3g} of the scene longer than the straight way"


FIRST = (finite, lengths, ranges)
THEN = (corners, weights, paths)
