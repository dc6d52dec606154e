"""Seconds against the size of the scene, in one run: the operator, one Cycles sample, Embree and BVHTree.

    python -m tools.timing.sizes [1000 10000 100000 1000000] [--runs 3] [--mirror 32] [--everything]

A ball of 2 x MIRROR^2 triangles mirrors bumpy knots on a ground, at 1024 x 1024. The operator reads everything anew,
and what of its seconds goes to asking Blender and to writing is told. Cycles renders the file as it is, one sample,
without its data from the last time. Embree traces the eye's rays and the mirrored ones, its trees built; mathutils'
BVHTree, in a loop of Python, the mirrored ones alone.
With --everything the operator is timed without whole faces too: all of the geometry, by cameras alone.
"""
from __future__ import annotations

import argparse
import importlib
import os
import statistics
import sys
import time
from collections.abc import Callable

import numpy as np

from tools import extension_zip
from tools.measure import print_table
from tools.timing.installed import measured_installed

EYE, TARGET, LENS, SIZE = (0.2, -5.4, 2.6), (0.08, 0.0, 1.2), 58.0, 1024
# middle, turns and size of the knots
KNOTS = (((-1.7, -1.5, 1.1), 3, 0.75), ((1.7, -1.4, 1.1), 5, 0.75), ((0.1, -2.9, 0.7), 7, 0.45))


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("vertices", nargs="*", type=int, default=[1000, 10000, 100000])
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--mirror", type=int, default=32, help="rings and segments of the ball (32)")
    parser.add_argument("--everything", action="store_true", help="time the operator without whole faces too")
    options = parser.parse_args(arguments)
    rows = measured_installed(options.vertices, lambda count: _measured(count, options))
    import bpy
    print(f"Blender {bpy.app.version_string}, {os.cpu_count()} threads, medians of {options.runs} runs; ratios of the "
          "medians, and the smallest and largest of single runs\n")
    print_table([("vertices", "faces", "generate s", "reading %", "writing %", "Cycles s", "Embree s",
                  "Cycles / generate", "from", "to", "Embree / generate", "BVHTree s", "BVHTree / generate", "from",
                  "to", "all geometry s"), *rows])
    return 0


def _measured(count: int, options: argparse.Namespace) -> list:
    """One row of the table."""
    import bpy
    ball, scene = _scene(count, options.mirror)
    bvhtree = _bvhtree(ball, scene)
    generate, shares, cycles, embree, looped, everything = [], [], [], [], [], []
    for _ in range(options.runs):
        seconds, blender = _generate_anew()
        generate.append(seconds)
        shares.append([100.0 * part / seconds for part in blender])
        faces = sum(len(obj.data.polygons) for obj in bpy.context.scene.objects
                    if obj.reflection_mesh.role == "REFLECTION")
        bpy.ops.reflection_mesh.clear()
        cycles.append(_cycles())
        embree.append(_embree(ball, scene))
        looped.append(bvhtree())
    if options.everything:
        everything.append(_generate_anew(hidden_faces=True)[0])
        bpy.ops.reflection_mesh.clear()
    mine, theirs, traced, loop = (statistics.median(seconds) for seconds in (generate, cycles, embree, looped))
    return [count, faces, mine, *map(statistics.median, zip(*shares)), theirs, traced, theirs / mine,
            *_spread(cycles, generate), traced / mine, loop, loop / mine, *_spread(looped, generate),
            everything[0] if everything else None]


def _spread(seconds: list[float], others: list[float]) -> tuple[float, float]:
    """The smallest and the largest ratio of single runs."""
    ratios = [one / other for one, other in zip(seconds, others)]
    return min(ratios), max(ratios)


def _generate(**settings) -> float:
    import bpy
    bpy.context.evaluated_depsgraph_get()
    started = time.perf_counter()
    bpy.ops.reflection_mesh.generate(**settings)
    return time.perf_counter() - started


def _generate_anew(**settings) -> tuple[float, list[float]]:
    """Seconds of a first generation, and those of it that read from Blender and write to it."""
    importlib.import_module(extension_zip.PACKAGE + ".addon.standing.told")._tell(None)
    kept = importlib.import_module(extension_zip.PACKAGE + ".addon.standing").Kept
    operator = importlib.import_module(extension_zip.PACKAGE + ".addon.operators.generate")
    spent, parts = [0.0, 0.0], ((kept, "looked_at", 0), (kept, "joined", 0), (operator, "_written", 1),
                                (operator, "write_results", 1))

    def timed(work: Callable, kind: int) -> Callable:
        def run(*arguments, **options):
            started = time.perf_counter()
            try:
                return work(*arguments, **options)
            finally:
                spent[kind] += time.perf_counter() - started
        return run
    real = [getattr(place, name) for place, name, _ in parts]
    for (place, name, kind), work in zip(parts, real):
        setattr(place, name, timed(work, kind))
    try:
        return _generate(**settings), spent
    finally:
        for (place, name, _), work in zip(parts, real):
            setattr(place, name, work)


def _cycles() -> float:
    import bpy
    started = time.perf_counter()
    bpy.ops.render.render()
    return time.perf_counter() - started


def _embree(ball: tuple, scene: tuple) -> float:
    """Seconds to trace the eye's rays to ball and scene, and those that the ball mirrors."""
    from embreex.mesh_construction import TriangleMesh as EmbreeMesh
    from embreex.rtcore_scene import EmbreeScene
    corners = np.concatenate([points[triangles] for points, triangles in (ball, scene)]) - EYE
    tracer = EmbreeScene()
    EmbreeMesh(tracer, corners.astype(np.float32))
    right, up, back = _axes()
    x, y = np.meshgrid((np.arange(SIZE) + 0.5) / SIZE - 0.5, (np.arange(SIZE) + 0.5) / SIZE - 0.5)
    rays = (x.ravel()[:, None] * right + y.ravel()[:, None] * up) * (36.0 / LENS) - back
    rays, origins = rays.astype(np.float32), np.zeros((SIZE * SIZE, 3), dtype=np.float32)
    tracer.run(origins[:1], rays[:1])
    started = time.perf_counter()
    first = tracer.run(origins, rays)
    seen = np.flatnonzero((first >= 0) & (first < len(ball[1])))
    spent = time.perf_counter() - started
    a, b, c = corners[first[seen]].swapaxes(0, 1)
    normal, ray = np.cross(b - a, c - a), rays[seen].astype(np.float64)
    place = ray * ((a * normal).sum(axis=1) / (ray * normal).sum(axis=1))[:, None]
    smooth = place + EYE - ball[0].mean(axis=0)
    smooth /= np.linalg.norm(smooth, axis=1)[:, None]
    mirrored = ray - 2.0 * (ray * smooth).sum(axis=1)[:, None] * smooth
    place, mirrored = (place + 1e-4 * mirrored).astype(np.float32), mirrored.astype(np.float32)
    started = time.perf_counter()
    tracer.run(place, mirrored)
    return spent + time.perf_counter() - started


def _bvhtree(ball: tuple, scene: tuple) -> Callable[[], float]:
    """Seconds of the benchmark's rival that asks Blender's tree for one ray after the other, its tree built and the
    eye's rays given."""
    core = importlib.import_module(extension_zip.PACKAGE + ".core")
    rivals = importlib.import_module(extension_zip.PACKAGE + ".core.rivals")
    rival = importlib.import_module(extension_zip.PACKAGE + ".addon.benchmark.rival_bvhtree").RIVAL
    view = core.View.looking_at(EYE, TARGET, (SIZE, SIZE), field_of_view=2.0 * np.arctan(18.0 / LENS))
    normals = ball[0] - ball[0].mean(axis=0)
    mirror = core.TriangleMesh(*ball, normals[ball[1]] / np.linalg.norm(normals[0]))
    objects = core.TriangleMesh(*scene)
    hits = rivals.primary_hits(view, mirror, objects)
    return lambda: rival.run(view, mirror, objects, 1, hits).seconds["rays"]


def _axes() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Right, up and backward of the eye."""
    back = np.subtract(EYE, TARGET)
    back /= np.linalg.norm(back)
    right = np.cross((0.0, 0.0, 1.0), back)
    right /= np.linalg.norm(right)
    return right, np.cross(back, right), back


def _scene(count: int, rings: int) -> tuple[tuple, tuple]:
    """The scene in Blender; positions and triangles of the ball, and of the objects with about `count` vertices."""
    import bpy
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module=extension_zip.PACKAGE)
    scene = bpy.context.scene
    scene.render.engine, scene.render.resolution_x, scene.render.resolution_y = "CYCLES", SIZE, SIZE
    scene.cycles.samples, scene.cycles.use_denoising, scene.render.use_persistent_data = 1, False, False
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.data.lens, scene.camera = LENS, camera
    placement = np.eye(4)
    placement[:3, :3], placement[:3, 3] = np.stack(_axes(), axis=1), EYE
    camera.matrix_world = _matrix(placement)
    scene.collection.objects.link(camera)
    ball = _ball(rings)
    _object("Ball", *ball, _material("Mirror", mirror=True), smooth=True).reflection_mesh.role = "MIRROR"
    objects = _objects(count)
    _object("Knots", *objects, _material("Knots", mirror=False)).reflection_mesh.role = "DIFFUSE"
    bpy.context.view_layer.update()
    return ball, objects


def _matrix(rows: np.ndarray):
    from mathutils import Matrix
    return Matrix(rows.tolist())


def _object(name: str, positions: np.ndarray, triangles: np.ndarray, material, smooth: bool = False):
    import bpy
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(positions.tolist(), [], triangles.tolist())
    mesh.materials.append(material)
    if smooth:
        mesh.polygons.foreach_set("use_smooth", np.ones(len(triangles), dtype=bool))
    obj = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(obj)
    return obj


def _material(name: str, mirror: bool):
    import bpy
    material = bpy.data.materials.new(name)
    if not material.node_tree:
        material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    shader = nodes.new("ShaderNodeBsdfGlossy" if mirror else "ShaderNodeEmission")
    if mirror:
        shader.inputs["Roughness"].default_value = 0.0
        shader.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    links.new(shader.outputs[0], nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    return material


def _ball(rings: int) -> tuple[np.ndarray, np.ndarray]:
    """2 x rings x (rings - 1) triangles."""
    v, u = np.meshgrid(np.arange(1, rings) * np.pi / rings, np.arange(rings) * 2.0 * np.pi / rings, indexing="ij")
    sides = np.stack((np.sin(v) * np.cos(u), np.sin(v) * np.sin(u), np.cos(v)), axis=-1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(rings - 2), np.arange(rings), indexing="ij")
    a, b = (i * rings + j).ravel(), (i * rings + (j + 1) % rings).ravel()
    triangles = [np.stack((a, a + rings, b + rings), axis=1), np.stack((a, b + rings, b), axis=1)]
    j, last, count = np.arange(rings), (rings - 2) * rings, len(sides)
    triangles += [np.stack((np.full(rings, count), j, (j + 1) % rings), axis=1),
                  np.stack((np.full(rings, count + 1), last + (j + 1) % rings, last + j), axis=1)]
    points = np.concatenate((sides, [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]))
    return points * 1.2 + (0.1, 0.2, 1.26), np.concatenate(triangles)


def _objects(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Three bumpy knots and a ground."""
    parts, start = [], 0
    round_ = max(6, round((count / 3.1 / 22.0) ** 0.5))
    along = max(12, round(count / 3.1 / round_))
    for middle, turns, size in KNOTS:
        u, v = np.meshgrid(np.arange(along) * 2.0 * np.pi / along, np.arange(round_) * 2.0 * np.pi / round_,
                           indexing="ij")
        radius = 1.0 + 0.35 * np.cos(turns * u)
        way = np.stack((radius * np.cos(2.0 * u), radius * np.sin(2.0 * u), 0.45 * np.sin(turns * u)), axis=-1)
        thick = 0.16 + 0.02 * np.sin(23.0 * u + 3.0 * v) + 0.012 * np.sin(41.0 * u - 7.0 * v)
        out = np.stack((np.cos(2.0 * u) * np.cos(v), np.sin(2.0 * u) * np.cos(v), np.sin(v)), axis=-1)
        points = ((way + thick[..., None] * out) * size + middle).reshape(-1, 3)
        i, j = (index.ravel() for index in np.meshgrid(np.arange(along), np.arange(round_), indexing="ij"))
        parts.append((points, _quads(i * round_ + j, (i + 1) % along * round_ + j,
                                     (i + 1) % along * round_ + (j + 1) % round_, i * round_ + (j + 1) % round_)))
    cells = max(4, round((0.03 * count) ** 0.5))
    x, y = np.meshgrid(np.linspace(-6.0, 6.0, cells + 1), np.linspace(-6.0, 6.0, cells + 1), indexing="ij")
    corner = (np.arange(cells)[:, None] * (cells + 1) + np.arange(cells)).ravel()
    parts.append((np.stack((x, y, np.zeros_like(x)), axis=-1).reshape(-1, 3),
                  _quads(corner, corner + cells + 1, corner + cells + 2, corner + 1)))
    points, triangles = [], []
    for own, faces in parts:
        points.append(own)
        triangles.append(faces + start)
        start += len(own)
    return np.concatenate(points), np.concatenate(triangles)


def _quads(a: np.ndarray, b: np.ndarray, c: np.ndarray, d: np.ndarray) -> np.ndarray:
    return np.concatenate((np.stack((a, b, c), axis=1), np.stack((a, c, d), axis=1)))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
