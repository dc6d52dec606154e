"""What stands still, worked out once: results are those of the meshes themselves, bit for bit."""
from __future__ import annotations

from dataclasses import fields, replace

import numpy as np
import pytest

from core import PointTree, ReflectionMesh, SceneTree, Settings, Standing, TriangleMesh, View, reflect
from tests.inputs import shapes

SCENE = shapes.combine(shapes.icosphere((0.3, -2.0, 0.9), 0.5, 2), shapes.box((-1.0, -1.6, 0.6), 0.7))
BALL = shapes.combine(shapes.uv_sphere((0.0, 0.0, 1.0), 0.8, 24, 12))
WALL = shapes.combine(shapes.quad((1.6, 0.0, 1.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)))
VIEWS = [View.looking_at((x, -5.0, 1.6), (0.0, 0.0, 1.0), (200, 160)) for x in (-0.3, 0.4)]


def arrays(mesh: ReflectionMesh) -> dict:
    found = {field.name: getattr(mesh, field.name) for field in fields(mesh)}
    if mesh.discs is not None:
        found |= {field.name: getattr(mesh.discs, field.name) for field in fields(mesh.discs)}
    return {name: value.tobytes() for name, value in found.items() if isinstance(value, np.ndarray)} | {
        "error": mesh.estimated_error, "counts": mesh.counts}


@pytest.mark.thorough
@pytest.mark.parametrize("settings", [Settings(), Settings(depth=2), Settings(method="POINTS"),
                                      Settings(method="PARALLEL")], ids=["general", "deep", "points", "parallel"])
@pytest.mark.parametrize("far", [0.0, 1e5])
def test_frames_are_those_from_scratch(settings, far):
    ball, wall, scene = (TriangleMesh(mesh.positions + far, mesh.triangles, mesh.corner_normals)
                         for mesh in (BALL, WALL, SCENE))
    tree = (PointTree if settings.method == "POINTS" else SceneTree).build(scene)
    for mirrors in (ball, TriangleMesh.joined([ball, wall])):
        standing = Standing.of(tree, mirrors)
        for view in VIEWS:
            placement = view.camera_to_world.copy()
            placement[:3, 3] += far
            view = replace(view, camera_to_world=placement)
            assert arrays(reflect(view, ball, standing, settings)) == arrays(
                reflect(view, ball, tree, settings, mirrors))


def test_what_does_not_stand_is_worked_out_anew():
    standing = Standing.of(SCENE, BALL)
    moved = TriangleMesh(BALL.positions + (0.0, 0.1, 0.0), BALL.triangles, BALL.corner_normals)
    assert arrays(reflect(VIEWS[0], moved, standing, Settings(), moved)) == arrays(reflect(VIEWS[0], moved, SCENE))
    # with another method than that of its tree
    points = Settings(method="POINTS")
    one, other = (reflect(VIEWS[0], BALL, given, points) for given in (standing, standing.tree))
    assert len(one.positions) > 100 and arrays(one) == arrays(other)


def test_nothing_of_it_is_worked_out_twice(monkeypatch):
    import core.reflection
    standing, asked = Standing.of(SCENE, BALL), []
    for name in ("ordered", "SceneAndMirrors"):
        monkeypatch.setattr(core.reflection, name, lambda *given, name=name, **more: asked.append(name))
    reflect(VIEWS[0], BALL, standing)
    assert asked == []
