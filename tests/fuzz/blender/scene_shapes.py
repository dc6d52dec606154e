"""Objects of every kind that Blender has a surface for, and of some that it has none for, drawn at random and small."""
from __future__ import annotations

from collections.abc import Callable

import bpy
import bmesh
import numpy as np

from tests.inputs import hard_meshes, shapes

ORIGIN = (0.0, 0.0, 0.0)


def chosen(rng: np.random.Generator, choices):
    """One of the choices, as it is: no number of NumPy's."""
    return choices[int(rng.integers(len(choices)))]


def from_arrays(name: str, positions, faces, edges=()) -> bpy.types.Mesh:
    """A mesh that Blender has nothing to mend in: on others its own tools crash."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(np.asarray(positions, dtype=float).reshape(-1, 3).tolist(), list(edges),
                     [[int(corner) for corner in face] for face in faces])
    mesh.validate()
    return mesh


def _surface(maker: Callable) -> Callable:
    """One of the surfaces of `tests.inputs.shapes`."""
    def made(rng: np.random.Generator, name: str) -> bpy.types.Mesh:
        positions, triangles = maker(rng)[:2]
        return from_arrays(name, positions, triangles)
    return made


def _hard(rng: np.random.Generator, name: str) -> bpy.types.Mesh:
    """A shape with one of the defects of `tests.inputs.hard_meshes`."""
    mesh = hard_meshes.mesh(chosen(rng, list(hard_meshes.SHAPES)), (chosen(rng, list(hard_meshes.DEFECTS)),),
                            seed=int(rng.integers(1000)))
    return from_arrays(name, np.nan_to_num(mesh.positions, nan=9.0, posinf=9.0), mesh.triangles)


def _primitive(operator: str, **options) -> Callable:
    """Quads, fans and faces of many corners, by Blender's own makers."""
    def made(rng: np.random.Generator, name: str) -> bpy.types.Mesh:
        room = bmesh.new()
        getattr(bmesh.ops, operator)(room, **{key: value(rng) if callable(value) else value
                                              for key, value in options.items()})
        mesh = bpy.data.meshes.new(name)
        room.to_mesh(mesh)
        room.free()
        return mesh
    return made


def _rough_grid(rng: np.random.Generator, name: str) -> bpy.types.Mesh:
    cells, roughness = chosen(rng, [1, 2, 3, 5, 8, 16]), chosen(rng, [0.0, 1e-7, 0.01, 0.1, 1.0])
    x, y = (part.ravel() for part in np.meshgrid(*2 * [np.linspace(-1.0, 1.0, cells + 1)]))
    corner = (np.arange(cells)[:, None] * (cells + 1) + np.arange(cells)).ravel()
    return from_arrays(name, np.stack([x, y, rng.normal(0.0, roughness, len(x))], axis=1),
                       corner[:, None] + [0, 1, cells + 2, cells + 1])


def _polygon(rng: np.random.Generator, name: str) -> bpy.types.Mesh:
    """One face of many corners: round, a star, bent, or with corners on a line."""
    count = chosen(rng, [5, 17, 40])
    angle = 2.0 * np.pi * np.arange(count) / count
    radius = np.where(np.arange(count) % 2, 1.0, chosen(rng, [1.0, 0.3]))
    height = chosen(rng, [0.0, 0.2]) * rng.normal(size=count)
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle), height], axis=1)
    if rng.random() < 0.3:
        points[: count // 2, 1] = 0.0
    return from_arrays(name, points, [range(count)])


def _self_crossing(rng: np.random.Generator, name: str) -> bpy.types.Mesh:
    """Faces of three to five corners between points anywhere."""
    faces = [rng.permutation(12)[:rng.integers(3, 6)] for _ in range(14)]
    return from_arrays(name, rng.normal(0.0, 1.0, (12, 3)), faces)


def _soup(*counts: int) -> Callable:
    """Triangles anywhere; some are all but lines."""
    def made(rng: np.random.Generator, name: str) -> bpy.types.Mesh:
        count, width = chosen(rng, counts), chosen(rng, [1.0, 1.0, 1.0, 1e-3, 1e-9])
        corner, way, across = rng.normal(0.0, 1.0, (3, count, 3))
        positions = np.stack([corner, corner + way, corner + 0.5 * way + width * across], axis=1)
        return from_arrays(name, positions, np.arange(3 * count).reshape(-1, 3))
    return made


def _strip(rng: np.random.Generator, name: str) -> bpy.types.Mesh:
    """A band with one side."""
    count = 16
    angle, side = np.repeat(2.0 * np.pi * np.arange(count) / count, 2), np.tile([-0.4, 0.4], count)
    out = 1.0 + side * np.cos(0.5 * angle)
    faces = [[2 * k, 2 * k + 1, 2 * k + 3, 2 * k + 2] for k in range(count - 1)]
    # the ends meet with their sides changed over
    faces.append([2 * count - 2, 2 * count - 1, 0, 1])
    return from_arrays(name, np.stack([out * np.cos(angle), out * np.sin(angle), side * np.sin(0.5 * angle)], axis=1),
                       faces)


def _loose(rng: np.random.Generator, name: str) -> bpy.types.Mesh:
    """A quad and an edge; or no face at all; or nothing."""
    quad, more = shapes.quad(ORIGIN, (1.0, 0.0, 0.0), (0.0, 1.0, 0.0))[0], [[5.0, 5.0, 5.0], [6.0, 5.0, 5.0]]
    kind = chosen(rng, ["quad", "quad", "edges", "nothing"])
    if kind == "nothing":
        return from_arrays(name, np.zeros((0, 3)), [])
    return from_arrays(name, np.concatenate([quad, more]), [(0, 1, 2, 3)] if kind == "quad" else [], [(4, 5)])


def _broken(rng: np.random.Generator, name: str) -> bpy.types.Mesh:
    """A quad with a corner that is no number, or too far away for single precision."""
    mesh = from_arrays(name, shapes.quad(ORIGIN, (1.0, 0.0, 0.0), (0.0, 1.0, 0.0))[0], [(0, 1, 2, 3)])
    mesh.vertices[int(rng.integers(4))].co.x = chosen(rng, [float("nan"), float("inf"), 1e15, 3e38])
    return mesh


def _curve(rng: np.random.Generator, name: str) -> bpy.types.Curve:
    curve = bpy.data.curves.new(name, "CURVE")
    curve.dimensions, curve.bevel_depth, curve.resolution_u = "3D", chosen(rng, [0.0, 0.05, 0.3]), 2
    spline = curve.splines.new("BEZIER")
    spline.bezier_points.add(2)
    for point in spline.bezier_points:
        point.co = rng.normal(0.0, 1.0, 3).tolist()
        point.handle_left_type = point.handle_right_type = "AUTO"
    return curve


def _text(rng: np.random.Generator, name: str) -> bpy.types.Curve:
    text = bpy.data.curves.new(name, "FONT")
    text.body, text.extrude, text.resolution_u = chosen(rng, ["I", "", "L\n1"]), chosen(rng, [0.0, 0.1]), 1
    return text


def _nurbs(rng: np.random.Generator, name: str) -> bpy.types.Curve:
    surface = bpy.data.curves.new(name, "SURFACE")
    surface.dimensions = "3D"
    spline = surface.splines.new("NURBS")
    spline.points.add(3)
    for point in spline.points:
        point.co = (*rng.normal(0.0, 1.0, 3).tolist(), 1.0)
    return surface


def _metaballs(rng: np.random.Generator, name: str) -> bpy.types.MetaBall:
    balls = bpy.data.metaballs.new(name)
    for _ in range(chosen(rng, [1, 2])):
        element = balls.elements.new()
        element.co, element.radius = rng.normal(0.0, 0.6, 3).tolist(), 1.0
    balls.resolution = 0.7
    return balls


USUAL = {
    "plane": _surface(lambda rng: shapes.quad(ORIGIN, (1.0, 0.0, 0.0), (0.0, 1.0, 0.0))),
    "ball": _surface(lambda rng: shapes.uv_sphere(ORIGIN, 1.0, chosen(rng, [4, 8, 12, 24]), chosen(rng, [3, 6, 12]))),
    "ico ball": _surface(lambda rng: shapes.icosphere(ORIGIN, 1.0, chosen(rng, [0, 1, 1, 2, 2, 3]))),
    "ring": _surface(lambda rng: shapes.torus(ORIGIN, 1.0, chosen(rng, [0.1, 0.3, 1.2]), 8, 5)),
    "bowl": _surface(lambda rng: shapes.bowl(ORIGIN, 1.0, chosen(rng, [0.6, 1.2]), 8, 3)),
    "pipe": _surface(lambda rng: shapes.cylinder(ORIGIN, 0.7, 1.6, 8)),
    "water": _surface(lambda rng: shapes.water(2.0, chosen(rng, [0.02, 0.1]), 1.5, 5)),
    "cube": _primitive("create_cube", size=2.0),
    "cone": _primitive("create_cone", cap_ends=True, segments=lambda rng: chosen(rng, [3, 8, 16]), radius1=1.0,
                       radius2=0.0, depth=2.0),
    "rough grid": _rough_grid, "polygon": _polygon, "soup": _soup(3, 20),
}
LARGE = {
    "large ball": _surface(lambda rng: shapes.uv_sphere(ORIGIN, 1.0, 24, 14)),
    "large ico ball": _surface(lambda rng: shapes.icosphere(ORIGIN, 1.0, chosen(rng, [3, 4]))),
    "large ring": _surface(lambda rng: shapes.torus(ORIGIN, 1.0, chosen(rng, [0.3, 0.9]), 16, 10)),
    "large bowl": _surface(lambda rng: shapes.bowl(ORIGIN, 1.0, 1.4, 24, 10)),
    "large water": _surface(lambda rng: shapes.water(2.0, chosen(rng, [0.02, 0.1]), 2.5, 20)),
    "large soup": _soup(80), "monkey": _primitive("create_monkey"),
}
UNUSUAL = {
    "hard": _hard, "self-crossing": _self_crossing, "strip": _strip, "loose": _loose, "broken": _broken,
    "curve": _curve, "text": _text, "nurbs": _nurbs, "metaballs": _metaballs, "monkey": _primitive("create_monkey"),
}


def drawn_object(rng: np.random.Generator, name: str, large: bool) -> tuple[str, bpy.types.Object]:
    """An object with its data, linked to the scene, and what it is called; of many faces more often where `large`."""
    kinds = USUAL if rng.random() < 0.75 else UNUSUAL
    if large and rng.random() < 0.5:
        kinds = LARGE
    kind = chosen(rng, list(kinds))
    obj = bpy.data.objects.new(name, kinds[kind](rng, name))
    bpy.context.scene.collection.objects.link(obj)
    return kind, obj
