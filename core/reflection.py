"""The way through the house: view and mirror and diffuse scene in, reflection mesh out."""
from __future__ import annotations

import time
from collections.abc import Generator
from dataclasses import replace

import numpy as np

from .assembly import assemble
from .cameras import three_ray_cameras, visible_triangles
from .candidates import overlapping
from .caustics import split_at_caustics
from .clipping import clip, whole_triangles
from .cones import Cones
from .connection import connect
from .face_refinement import FaceRefinement
from .contacts import drop_behind_contacts
from .filling import fill, fill_openings
from .horizon import beyond_horizon, cut_at_horizon
from .images import vertex_images
from .mirror_map import MirrorMap
from .camera_splitting import in_picture
from .mirror_refinement import refine_mirror
from .mirror_visibility import without_hidden
from .nodes import polygon_nodes
from .outline_refinement import refine_for_outlines
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
INSIDE = 4.0 / 3.0  # a quadratic that is zero at a triangle's corners exceeds its values at the edges' middles by this


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
    counts["mirror_triangles"], counts["mirror_pixels"] = len(cameras), grid.mirror_pixels
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
    cameras, candidates, counts["contacts"] = drop_behind_contacts(view, mirror_map, cameras, frames,
                                                                   tree.mesh.positions, candidates)
    bounded = len(cameras) > settings.maximum_faces
    cameras, candidates, open_, outlines_limited = refine_for_outlines(
        view, mirror_map, cameras, frames, candidates, OUTLINE_SHARE * settings.tolerance, settings.maximum_faces)
    cones = Cones.around(cameras)
    counts["cameras"], counts["candidates"] = len(cameras), len(candidates)
    bounded |= len(candidates) > settings.maximum_faces
    stages.done("cones")

    yield 0.4, "projection"
    positions = tree.mesh.positions
    images, image_counts = vertex_images(view, mirror_map, cameras, cones, positions, frames, candidates)
    counts.update(image_counts)
    stages.done("projection")

    yield 0.6, "clipping"
    polygons = clip(candidates)
    polygons, bent = fill(mirror_map, cameras, frames, candidates, polygons, open_)
    nodes, node_of = polygon_nodes(view, mirror_map, cameras, frames, positions, candidates, polygons, images)
    counts["polygons"], counts["joined"] = len(polygons.pair), whole_triangles(polygons)
    counts["cut"] = counts["polygons"] - counts["joined"]
    stages.done("clipping")

    yield 0.7, "filling"
    candidates, polygons, nodes, node_of, fill_counts = fill_openings(
        view, mirror_map, cameras, tree, frames, images, candidates, polygons, nodes, node_of)
    counts.update(fill_counts)
    counts["filled"], counts["rays"] = counts["filled"] + bent, counts["rays"] + bent
    stages.done("filling")

    yield 0.75, "connection"
    faces = connect(candidates, polygons, node_of, view.pixels(nodes.place.T))
    nodes, faces, counts["caustic_edges"] = split_at_caustics(mirror_map, cameras, frames, nodes, faces)
    faces = faces.select(~grid.hides_faces(nodes.place, faces.nodes))
    counts["connected"] = len(faces)
    stages.done("connection")

    yield 0.8, "refinement"
    refinement = FaceRefinement(view, mirror_map, cameras, frames, beyond_horizon(mirror_map, cameras),
                                settings.placement == "VIRTUAL")
    nodes, faces, left, limited = refinement.refine(nodes, faces, FACE_SHARE * settings.tolerance,
                                                    settings.maximum_faces)
    stages.done("refinement")

    yield 0.95, "depth order"
    mesh = assemble(view, mirror_map, cameras, frames, positions, nodes, faces, settings.placement)
    counts["faces"], counts["limited"] = len(mesh.triangles), int(mirror_limited) + outlines_limited + limited
    bounded |= limited > 0 and len(faces) + 2 * limited > settings.maximum_faces
    counts["bounded"] = int(bounded)
    stages.done("placement")
    return replace(mesh, counts=counts, seconds=stages.seconds,
                   estimated_error=INSIDE * float(np.percentile(left, 99)))


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
