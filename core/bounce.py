"""One bounce: from cameras on the last mirror to the faces of all that they see, step by step as in docs/method.md."""
from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from .cameras import Cameras, beyond_horizon, refine_mirror
from .culling import Candidates, MirrorsShown, SceneAndMirrors
from .filling import Crowds, Limits
from .geometry import SceneFrames, distinct, edge_lengths, norm
from .polygons import (
    FaceRefinement,
    Faces,
    Nodes,
    Overlaps,
    Polygons,
    VertexImages,
    clip,
    connect,
    polygon_nodes,
    refine_for_outlines,
    split_at_caustics,
    vertex_images,
    whole_triangles,
)
from .support import FACE_SHARE, MIRROR_SHARE, OUTLINE_SHARE, Progress, Settings
from .visibility import cut_behind_mirrors, drop_behind_contacts, plainly_seen


@dataclass(frozen=True)
class Task:
    """Input and settings that all steps of a bounce share.

    Attributes
    ----------
    met : SceneAndMirrors, triangles that rays may hit
    settings : Settings
    limits : Limits
    last : bool, True for the last bounce: rays that hit a mirror end there
    progress : Progress
    """

    met: SceneAndMirrors
    settings: Settings
    limits: Limits
    last: bool
    progress: Progress

    def reach(self, cameras: Cameras) -> float:
        """Return an upper bound on the length of rays from cameras to the diffuse scene, in scene units."""
        centre, radius = self.met.bounds
        return float(norm(cameras.origins - centre[:, None]).max(initial=0.0) + radius)


@dataclass(frozen=True)
class Bounce:
    """Faces that one bounce shows, with the cameras that see them.

    Attributes
    ----------
    cameras : Cameras
    frames : SceneFrames
    nodes : Nodes
    faces : Faces
    left : (2, e) float64, displacements estimated on the edges, and the lengths of the edges, in pixels
    corner_face : (k, 3) int64
        For each corner of the last k cameras, which span several mirror triangles: the face of the map it lies on.
    """

    cameras: Cameras
    frames: SceneFrames
    nodes: Nodes
    faces: Faces
    left: np.ndarray
    corner_face: np.ndarray = field(default_factory=lambda: np.zeros((0, 3), dtype=np.int64))


def bounced(cameras: Cameras, task: Task, showing: MirrorsShown) -> Bounce:
    """Compute all faces that the cameras see; `showing` says which mirrors each camera may show."""
    crowds = Crowds(task.met, task.limits, task.last)
    cameras = crowds.without_most(cameras)
    cameras = refined(cameras, task, None if task.last else showing.faces)
    candidates = _culled(cameras, task, showing, crowds)
    images = _projected(candidates, task)
    candidates, by_rays, corner_face = _filled(candidates, task, crowds)
    polygons = _hidden(_clipped(candidates, task), task, by_rays)
    return replace(_triangulated(polygons, images, task, by_rays), corner_face=corner_face)


def refined(cameras: Cameras, task: Task, showing: np.ndarray | None) -> Cameras:
    """Select the cameras that may see something, and split them where their rays deviate from the true map.

    `showing` (m,) bool marks faces of the map that may show a mirror; if None, only the diffuse scene counts.
    """
    seeing = task.met.showing_scene(cameras)
    if showing is not None:
        seeing |= showing[cameras.face]
    cameras = cameras.select(seeing)
    most = task.limits.cameras
    cameras, limited = refine_mirror(cameras, MIRROR_SHARE * task.settings.tolerance, task.reach(cameras), most)
    bounded = limited and len(cameras) > most
    if task.last:
        cameras = cameras.select(task.met.showing_scene(cameras))
    task.progress.done("cameras", limited=limited, bounded=bounded)
    return cameras


def showing_mirrors(cameras: Cameras, met: SceneAndMirrors, limits: Limits) -> MirrorsShown:
    """Find the mirrors that cameras may show, before the cameras are refined.

    The search pays only if few cameras see a mirror, as at the first bounce. Later bounces return `unknown`.
    """
    return met.showing_mirrors(cameras, limits.pairs // 4) if cameras.mirror_map.bounce == 1 else \
        MirrorsShown.unknown(cameras)


def _culled(cameras: Cameras, task: Task, showing: MirrorsShown, crowds: Crowds) -> Candidates:
    """Find pairs of a camera and a triangle that it may see, with cameras split until outlines in them are straight."""
    task.progress.next(0.1, "Finding reflected objects")
    met, limits = task.met, task.limits
    candidates, crowd, pairs, visited = _met(cameras, task, showing, crowds)
    candidates, contacts, pierced = crowds.thinned(candidates, crowd), 0, 0
    if cameras.mirror_map.bounce == 1:
        candidates, crowd, contacts, pierced = drop_behind_contacts(
            candidates, limits.candidates,
            lambda pieces, pairs: Overlaps.of(pieces, candidates.frames, pairs, met).in_sight(task.last),
            met.opacities, met.slide)
        candidates = crowds.thinned(candidates, crowd)
    candidates, still_bent, limited = refine_for_outlines(candidates, OUTLINE_SHARE * task.settings.tolerance,
                                                          limits.candidates, met, task.last)
    # pixel-sized cameras with curved outlines, as where rays cross, cannot be split further: rays sample them
    candidates = crowds.thinned(candidates, still_bent)
    still_open, count = int(still_bent.sum()), len(candidates)
    crowds.given_up = len(crowds) - still_open - crowds.dense
    task.progress.done("cones", nodes_visited=visited, pairs=pairs, contacts=contacts, pierced=pierced,
                       limited=limited, cameras=len(candidates.cameras), candidates=count, open=still_open,
                       bounded=count > limits.candidates)
    return candidates


def _met(cameras: Cameras, task: Task, showing: MirrorsShown,
         crowds: Crowds) -> tuple[Candidates, np.ndarray, int, int]:
    """Find pairs of a camera and a triangle that may overlap.

    Mirrors are searched on the faces that may show one (`showing`); at the last bounce, only where they may hide
    something.

    Returns
    -------
    candidates : Candidates
    crowd : (n,) bool, cameras with too many triangles
    pairs : int, number of pairs tested
    visited : int, number of tree nodes visited
    """
    met, bound = task.met, crowds.bound(cameras)
    found = met.diffuse_in(cameras, bound)
    crowd = crowds.full(cameras, found)
    left = ~crowd[found.cone]
    seen, column = distinct(found.triangle[left])
    diffuse = Overlaps.of(cameras, SceneFrames.of(met, seen), (found.cone[left], column), met)
    looking = showing.faces[cameras.face] & ~crowd
    if task.last:
        looking &= np.bincount(diffuse.candidates.camera, minlength=len(cameras)) > 0
    looking = np.flatnonzero(looking)
    mirrors = met.mirrors_in(cameras.select(looking), bound.select(looking), showing)
    crowd[looking[crowds.full(cameras.select(looking), mirrors)]] = True
    shown, column = distinct(mirrors.triangle)
    frames = SceneFrames.of(met, np.append(seen, shown + met.diffuse))
    mirror = Overlaps.of(cameras, frames, (looking[mirrors.cone], len(seen) + column), met)
    mirror = mirror.select(plainly_seen(met, mirror.candidates))
    diffuse = replace(diffuse, candidates=replace(diffuse.candidates, frames=frames))
    return (Overlaps.joined((diffuse, mirror)).in_sight(task.last), crowd, len(found.cone) + len(mirrors.cone),
            found.visited + mirrors.visited)


def _projected(candidates: Candidates, task: Task) -> VertexImages:
    task.progress.next(0.35, "Reflecting vertices")
    images, counts = vertex_images(task.met.only_diffuse(candidates) if task.last else candidates)
    task.progress.done("projection", **counts)
    return images


def _filled(candidates: Candidates, task: Task, crowds: Crowds) -> tuple[Candidates, np.ndarray, np.ndarray]:
    """Append the cells that rays sample to the candidates.

    Returns
    -------
    candidates : Candidates, first the given ones, then those of the cells
    by_rays : (n,) bool, cameras that are such cells
    corner_face : (k, 3) int64, mirror triangle of each corner of the last k cells, which belong to whole squares
    """
    exact = len(candidates.cameras)
    filled = crowds.filled(candidates)
    crowded = crowds.given_up if filled.less else 0
    by_rays = np.arange(len(filled.candidates.cameras)) >= exact
    task.progress.done("filling", filled=by_rays.sum(), rays=filled.rays, filled_pixels=filled.pixels,
                       crowded=crowded, dense=crowds.dense + crowds.given_up - crowded)
    return filled.candidates, by_rays, filled.corner_face


def _clipped(candidates: Candidates, task: Task) -> Polygons:
    """Clip each candidate's triangle to its camera; at the last bounce, drop the polygons of mirrors."""
    task.progress.next(0.5, "Clipping faces")
    polygons = clip(candidates)
    mirror = task.met.are_mirrors(candidates)[polygons.pair]
    diffuse = polygons.select(~mirror)
    whole = whole_triangles(diffuse)
    task.progress.done("clipping", polygons=len(diffuse.pair), joined=whole, cut=len(diffuse.pair) - whole)
    return Polygons.joined((diffuse, polygons.select(mirror & (not task.last))))


def _hidden(polygons: Polygons, task: Task, by_rays: np.ndarray) -> Polygons:
    """Cut away the parts of polygons that mirrors hide; polygons of ray-sampled cells (`by_rays`) stay as they are."""
    task.progress.next(0.7, "Reflecting other mirrors")
    cell = by_rays[polygons.camera]
    seen, occluded, undecided = cut_behind_mirrors(task.met, polygons.select(~cell))
    task.progress.done("occlusion", occluded=occluded, many_outlines=undecided)
    return Polygons.joined((seen, polygons.select(cell)))


def _triangulated(polygons: Polygons, images: VertexImages, task: Task, by_rays: np.ndarray) -> Bounce:
    """Triangulate the polygons on exact nodes, split the faces at caustics, and refine them to the tolerance."""
    progress, limits = task.progress, task.limits
    progress.next(0.75, "Building faces")
    cameras, frames = polygons.candidates.cameras, polygons.candidates.frames
    nodes, node_of = polygon_nodes(polygons, images)
    faces = connect(polygons, node_of, cameras.view.pixels(nodes.place.T))
    # cells sampled by rays need no refinement
    cells, faces = faces.select(by_rays[faces.camera]), faces.select(~by_rays[faces.camera])
    nodes, faces, caustic = split_at_caustics(cameras, frames, nodes, faces)
    progress.done("connection", connected=len(faces) + len(cells), caustic_edges=caustic)

    progress.next(0.8, "Refining faces")
    refinement = FaceRefinement(cameras, frames, beyond_horizon(cameras), task.settings.placement == "VIRTUAL")
    room = limits.faces - len(cells)
    nodes, faces, left, limited = refinement.refine(nodes, faces, FACE_SHARE * task.settings.tolerance, room)
    progress.done("refinement", limited=limited, bounded=limited > 0 and len(faces) + 2 * limited > room)
    # the outline in a cell may lie anywhere in it: its error is half the cell's edge
    length = edge_lengths(cameras.view.pixels(nodes.place.T)[cells.nodes]).ravel()
    left = np.concatenate((left, np.stack((0.5 * length, length))), axis=1)
    return Bounce(cameras, frames, nodes, Faces.joined([faces, cells]), left)
