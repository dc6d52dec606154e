"""Mirrors among objects, made from formulas: what the core is judged on without Blender."""
from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from core import TriangleMesh, View
from tests.inputs import shapes


@dataclass(frozen=True)
class Scene:
    """A view of one mirror and of the diffuse scene around it, in world space."""

    name: str
    view: View
    mirror: TriangleMesh
    scene: TriangleMesh

    def moved(self, name: str, offset, scale: float = 1.0) -> Scene:
        """The same picture from a scene that is scaled about the origin and then moved by `offset`."""
        offset = np.asarray(offset, dtype=float)
        mirror, scene = (TriangleMesh(mesh.positions * scale + offset, mesh.triangles, mesh.corner_normals)
                         for mesh in (self.mirror, self.scene))
        placement = self.view.camera_to_world.copy()
        placement[:3, 3] = placement[:3, 3] * scale + offset
        projection = self.view.projection.copy()
        # An orthographic picture holds a width in scene units, which grows with the scene.
        projection[:2, :2] /= scale if self.view.orthographic else 1.0
        return Scene(name, View(placement, projection, self.view.resolution), mirror, scene)


def _objects(radius: float = 3.0, ground: float = 0.0) -> tuple:
    """A floor of one quad, three boxes and a ball around the origin."""
    ring = np.array([[np.cos(angle), np.sin(angle), 0.0] for angle in (-2.3, -0.9, 0.4)]) * radius
    return (shapes.quad((0.0, 0.0, ground), (6.0, 0.0, 0.0), (0.0, 6.0, 0.0)),
            shapes.box(ring[0] + [0.0, 0.0, ground + 0.5], (1.0, 1.0, 0.98), 0.4),
            shapes.box(ring[1] + [0.0, 0.0, ground + 0.81], (0.8, 0.8, 1.6), 1.0),
            shapes.box(ring[2] + [0.0, 0.0, ground + 0.61], (1.2, 0.7, 1.2), 0.1),
            shapes.icosphere((-0.75 * radius, 0.1 * radius, ground + 0.75), 0.7, 3))


def sphere(resolution=(1024, 1024), *, kind: str = "uv", orthographic: bool = False) -> Scene:
    """A ball that mirrors a floor, boxes and a ball: `kind` 'uv' (1,984 triangles) or 'ico' (1,280)."""
    centre = (0.0, 0.0, 1.3)
    ball = shapes.uv_sphere(centre, 1.0, 32, 32) if kind == "uv" else shapes.icosphere(centre, 1.0, 3)
    view = View.looking_at((0.4, -6.0, 2.4), centre, resolution, field_of_view=0.385,
                           orthographic_scale=2.3 if orthographic else 0.0)
    return Scene("sphere", view, shapes.combine(ball), shapes.combine(*_objects()))


def flat(resolution=(1024, 1024), *, orthographic: bool = False) -> Scene:
    """An upright mirror of one quad behind a floor of one quad, boxes and a ball."""
    mirror = shapes.quad((0.0, 2.0, 1.6), (2.6, 0.3, 0.0), (0.0, 0.0, 1.5))
    view = View.looking_at((1.5, -7.0, 2.6), (0.0, 2.0, 1.5), resolution, field_of_view=0.62,
                           orthographic_scale=5.8 if orthographic else 0.0)
    return Scene("flat", view, shapes.combine(mirror), shapes.combine(*_objects(2.4)))


def cylinder(resolution=(1024, 1024)) -> Scene:
    """An upright cylinder of 64 segments, one quad high, smooth."""
    mirror = shapes.cylinder((0.0, 0.0, 1.3), 0.8, 2.4, 64)
    view = View.looking_at((0.5, -6.0, 2.6), (0.0, 0.0, 1.2), resolution, field_of_view=0.45)
    return Scene("cylinder", view, shapes.combine(mirror), shapes.combine(*_objects()))


def water(resolution=(1024, 1024)) -> Scene:
    """Waves of 64 x 64 cells below boxes, a ball and a wall."""
    boxes = (shapes.box((-1.2, 1.2, 0.9), (1.0, 1.0, 1.2), 0.5), shapes.box((1.3, 1.6, 1.1), (0.8, 0.8, 1.6), 1.1),
             shapes.icosphere((0.1, 2.4, 1.4), 0.6, 3), shapes.quad((0.0, 4.2, 2.0), (4.0, 0.0, 0.0), (0.0, 0.0, 1.9)))
    view = View.looking_at((0.0, -6.0, 2.8), (0.0, 0.4, 0.2), resolution, field_of_view=0.72)
    return Scene("water", view, shapes.combine(shapes.water(6.0, 0.04, 2.5, 64)), shapes.combine(*boxes))


def bowl(resolution=(1024, 1024)) -> Scene:
    """A concave cap of a sphere of radius 3: one box within its focal length, a box and a ball beyond, and a wall."""
    mirror = shapes.bowl((0.0, 0.0, 3.0), 3.0, 0.75, 48, 16)
    objects = (shapes.box((0.5, -0.5, 0.7), (0.4, 0.4, 0.4), 0.4), shapes.icosphere((-0.9, 2.6, 4.2), 0.6, 3),
               shapes.box((0.9, 2.9, 4.6), (0.8, 0.8, 1.2), 0.9),
               shapes.quad((0.0, 5.0, 4.0), (5.0, 0.0, 0.0), (0.0, 0.0, 4.5)))
    view = View.looking_at((0.0, -5.0, 7.0), (0.0, 0.0, 0.5), resolution, field_of_view=0.53)
    return Scene("bowl", view, shapes.combine(mirror), shapes.combine(*objects))


def torus(resolution=(1024, 1024)) -> Scene:
    """A smooth ring, convex outside and saddle-shaped inside."""
    mirror = shapes.torus((0.0, 0.0, 1.2), 1.0, 0.4, 64, 32)
    view = View.looking_at((0.3, -5.6, 3.0), (0.0, 0.0, 1.1), resolution, field_of_view=0.5)
    return Scene("torus", view, shapes.combine(mirror), shapes.combine(*_objects(3.2)))


def shifted_sphere(resolution=(1024, 1024)) -> Scene:
    """The ball through a lens that is shifted both ways, with pixels 1.2 times as high as wide."""
    base = sphere(resolution)
    projection = base.view.projection.copy()
    projection[1, 1] *= 1.0 / 1.2
    projection[0, 2], projection[1, 2] = 0.15, -0.1
    return replace(base, name="sphere_shift", view=View(base.view.camera_to_world, projection, resolution))


SCENES = {
    "sphere": sphere,
    "sphere_ico": lambda resolution: replace(sphere(resolution, kind="ico"), name="sphere_ico"),
    "sphere_ortho": lambda resolution: replace(sphere(resolution, orthographic=True), name="sphere_ortho"),
    "sphere_shift": shifted_sphere,
    "sphere_far": lambda resolution: sphere(resolution).moved("sphere_far", (1.2e4, -7.0e3, 3.0e3)),
    "sphere_small": lambda resolution: sphere(resolution).moved("sphere_small", (0.0, 0.0, 0.0), 1e-3),
    "flat": flat,
    "flat_ortho": lambda resolution: replace(flat(resolution, orthographic=True), name="flat_ortho"),
    "cylinder": cylinder,
    "water": water,
    "bowl": bowl,
    "torus": torus,
}
