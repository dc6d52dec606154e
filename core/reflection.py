"""The way through the house: view and mirror and diffuse scene in, reflection mesh out."""
from __future__ import annotations

import time
from collections.abc import Generator

import numpy as np

from .cameras import three_ray_cameras, visible_triangles
from .candidates import overlapping
from .clipping import clip
from .cones import Cones
from .connection import connect
from .face_refinement import FaceRefinement
from .horizon import cut_at_horizon
from .images import vertex_images
from .mirror_map import MirrorMap
from .mirror_refinement import in_picture, refine_mirror
from .mirror_visibility import without_hidden
from .nodes import polygon_nodes
from .outline_refinement import refine_for_outlines
from .placement import place, slide_limits
from .reflection_mesh import ReflectionMesh
from .scene_frames import SceneFrames
from .scene_tree import SceneTree
from .settings import Settings
from .triangle_mesh import TriangleMesh
from .vectors import norm
from .view import View

MIRROR_SHARE = 0.8  # of the tolerance: what the rays of a camera may stray
OUTLINE_SHARE = 0.5  # of the tolerance: what a straight outline in a camera may miss
FACE_SHARE = 0.8  # of the tolerance: what the interpolation inside a face may stray


class ReflectionError(ValueError):
    """The input cannot give a reflection; the message is one sentence for the user."""


def reflect(view: View, mirror: TriangleMesh, scene: TriangleMesh | SceneTree,
            settings: Settings = Settings()) -> ReflectionMesh:
    """The reflection of a diffuse scene in a mirror as the view sees it.

    Parameters
    ----------
    view : View
    mirror : TriangleMesh
        In world space, with shading normals. Two-sided.
    scene : TriangleMesh or SceneTree
        In world space; a tree built before saves the time to build it.
    settings : Settings

    Returns
    -------
    ReflectionMesh
        In world space.

    Raises
    ------
    ReflectionError
        Where the mirror or the scene is empty, the mirror is not in the picture, or the eye lies on it.
    """
    steps = reflection_steps(view, mirror, scene, settings)
    while True:
        try:
            next(steps)
        except StopIteration as end:
            return end.value


class _Stages:
    """Seconds by stage, and the share of the work done."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}
        self._last = time.perf_counter()

    def done(self, stage: str) -> None:
        now = time.perf_counter()
        self.seconds[stage] = self.seconds.get(stage, 0.0) + now - self._last
        self._last = now


def reflection_steps(view: View, mirror: TriangleMesh, scene: TriangleMesh | SceneTree,
                     settings: Settings = Settings()) -> Generator[tuple[float, str], None, ReflectionMesh]:
    """`reflect` in steps: yields (share of the work done, stage that comes next) and returns the mesh at its end."""
    stages, counts = _Stages(), {}
    _check(view, mirror, scene)
    yield 0.0, "k-d tree"
    tree = scene if isinstance(scene, SceneTree) else SceneTree.build(scene)
    if not len(tree.leaf_triangles):
        raise ReflectionError("The diffuse objects have no faces with an area; select objects with faces to reflect.")
    stages.done("tree")

    yield 0.1, "cameras"
    mirror_map = MirrorMap(view, mirror, settings.method == "PARALLEL")
    cameras = three_ray_cameras(mirror_map, mirror, visible_triangles(view, mirror))
    cameras = cut_at_horizon(view, mirror_map, cameras.select(in_picture(view, cameras)))
    if not len(cameras):
        raise ReflectionError("The view does not see the mirror; turn the camera to the mirror or move it into view.")
    cameras, grid = without_hidden(view, mirror_map, cameras)
    counts["mirror_triangles"] = len(cameras)
    cones = Cones.around(cameras)
    sphere = tree.spheres[0][:, 0]
    every = np.arange(len(cameras))
    seeing = cones.touch(every, np.repeat(sphere[:3, None], len(cameras), axis=1), np.full(len(cameras), sphere[3]))
    cameras = cameras.select(seeing)
    reach = float(norm(cameras.places - sphere[:3, None]).max() + sphere[3])
    cameras, mirror_limited = refine_mirror(view, mirror_map, cameras, MIRROR_SHARE * settings.tolerance, reach,
                                            settings.maximum_faces)
    stages.done("cameras")

    yield 0.2, "cones through the tree"
    cones = Cones.around(cameras)
    camera, triangle, counts["nodes_visited"] = tree.trace(cones)
    counts["pairs"] = len(camera)
    met, column = np.unique(triangle, return_inverse=True)
    frames = SceneFrames.of(tree.mesh, met)
    candidates = overlapping(cameras, frames, camera, column)
    cameras, candidates, outline_limited = refine_for_outlines(
        view, mirror_map, cameras, frames, candidates, OUTLINE_SHARE * settings.tolerance, settings.maximum_faces)
    cones = Cones.around(cameras)
    counts["cameras"], counts["candidates"] = len(cameras), len(candidates)
    stages.done("cones")

    yield 0.4, "projection"
    positions = tree.mesh.positions
    images, image_counts = vertex_images(view, mirror_map, cameras, cones, positions, frames, candidates)
    counts.update(image_counts)
    stages.done("projection")

    yield 0.6, "clipping"
    polygons = clip(candidates)
    nodes, node_of = polygon_nodes(view, mirror_map, cameras, frames, positions, candidates, polygons, images)
    counts["polygons"] = len(polygons.pair)
    stages.done("clipping")

    yield 0.75, "connection"
    faces = connect(candidates, polygons, node_of, view.pixels(nodes.place.T))
    refinement = FaceRefinement(view, mirror_map, cameras, frames, settings.placement == "VIRTUAL")
    nodes, faces, counts["caustic_edges"] = refinement.split_at_caustics(nodes, faces)
    faces = faces.select(~grid.hides(nodes.place)[faces.nodes].all(axis=1))
    counts["connected"] = len(faces)
    stages.done("connection")

    yield 0.8, "refinement"
    nodes, faces, left, limited = refinement.refine(nodes, faces, FACE_SHARE * settings.tolerance,
                                                    settings.maximum_faces)
    stages.done("refinement")

    yield 0.95, "depth order"
    result = _mesh(view, mirror_map, cameras, frames, nodes, faces, settings)
    counts["faces"] = len(result.triangles)
    counts["vertices"] = len(result.positions)
    counts["limited"] = int(mirror_limited) + int(outline_limited) + limited
    stages.done("placement")
    return ReflectionMesh(**result.__dict__ | {"counts": counts, "seconds": stages.seconds, "estimated_error": float(np.percentile(left, 99))})


def _check(view: View, mirror: TriangleMesh, scene: TriangleMesh | SceneTree) -> None:
    if not len(mirror.triangles):
        raise ReflectionError("The mirror has no faces; give it faces or choose another mirror.")
    if isinstance(scene, TriangleMesh) and not len(scene.triangles):
        raise ReflectionError("The diffuse objects have no faces; select objects with faces to reflect.")
    corners = mirror.positions[mirror.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(normals, axis=1)
    if not (length > 0.0).any():
        raise ReflectionError("The mirror has no face with an area; give it faces or choose another mirror.")
    if view.orthographic:
        return
    offset = view.eye - corners
    height = np.abs(np.einsum("ij,ij->i", normals, offset[:, 0])) / np.where(length > 0.0, length, np.inf)
    size = np.sqrt(length)
    near = np.flatnonzero((length > 0.0) & (height < 1e-6 * size))
    a, b, c = (offset[near, k] for k in range(3))
    inside = np.stack([np.einsum("ij,ij->i", np.cross(p, q), normals[near]) for p, q in ((a, b), (b, c), (c, a))])
    if (inside >= 0.0).all(axis=0).any():
        raise ReflectionError("The eye lies on the mirror; move the camera away from the mirror's surface.")


def _mesh(view, mirror_map, cameras, frames, nodes, faces, settings) -> ReflectionMesh:
    """The faces as arrays, without unused nodes, all turned to the eye."""
    used, corner = np.unique(faces.nodes, return_inverse=True)
    triangles = corner.reshape(-1, 3)
    kept = type(nodes)(nodes.place[:, used], nodes.point[:, used], nodes.distance[used])
    mirror_face = cameras.face[faces.camera]
    owner = np.zeros(len(used), dtype=np.int64)
    owner[triangles.ravel()] = np.repeat(mirror_face, 3)
    ray = mirror_map.rays(owner, mirror_map.coordinates(owner, kept.place)) if len(used) else kept.place
    path = kept.distance * norm(ray)
    turned = mirror_map.turned(owner, mirror_map.coordinates(owner, kept.place), kept.distance)
    parity = np.where(np.abs(turned) < 1e-5, 0, np.sign(turned)).astype(np.int8)
    pixels = view.pixels(kept.place.T)[triangles]
    u, v = pixels[:, 1] - pixels[:, 0], pixels[:, 2] - pixels[:, 0]
    away = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0] < 0.0
    triangles[away] = triangles[away][:, [0, 2, 1]]
    column = np.repeat(faces.column, 3)
    weights = frames.weights(column, np.take(kept.point, triangles.ravel(), axis=1))
    most = slide_limits(view, kept, path, frames, triangles, faces.column)
    return ReflectionMesh(
        positions=place(view, kept, path, settings.placement, most).T, triangles=triangles, reflected_position=kept.point.T,
        mirror_position=kept.place.T, path_length=path, image_parity=parity,
        source_face=frames.triangle[faces.column], source_weights=weights.T.reshape(-1, 3, 3), mirror_face=mirror_face)
