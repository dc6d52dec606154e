"""One bounce: from cameras on the last mirror to the faces of all that they see."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .cameras import Cameras, ReflectionMap, beyond_horizon, covered_pixels, picture_areas, refine_mirror
from .culling import Cones, SceneAndMirrors, overlapping
from .filling import Limits, thinned, with_crowds
from .geometry import SceneFrames, View, edge_lengths, norm
from .polygons import (
    FaceRefinement,
    Faces,
    Nodes,
    Polygons,
    clip,
    connect,
    polygon_nodes,
    refine_for_outlines,
    split_at_caustics,
    vertex_images,
    whole_triangles,
)
from .support import Progress, Settings, crowded
from .visibility import cut_behind_mirrors, drop_behind_contacts, without_touching

MIRROR_SHARE = 0.8  # of the tolerance: what the rays of a camera may stray
OUTLINE_SHARE = 0.5  # of the tolerance: what a straight outline in a camera may miss
FACE_SHARE = 0.8  # of the tolerance: what the interpolation inside a face may stray


@dataclass(frozen=True)
class Bounce:
    """What is seen after one bounce.

    Attributes
    ----------
    mirror_map : ReflectionMap
    cameras : Cameras
    frames : SceneFrames
    nodes : Nodes
    faces : Faces
    left : (2, e) float64
        Displacements estimated on the edges, and the lengths of the edges, in pixels.
    """

    mirror_map: ReflectionMap
    cameras: Cameras
    frames: SceneFrames
    nodes: Nodes
    faces: Faces
    left: np.ndarray


def bounced(view: View, mirror_map: ReflectionMap, cameras: Cameras, met: SceneAndMirrors, settings: Settings,
                 limits: Limits, last: bool, progress: Progress) -> Bounce:
    """All that the cameras see; `last` tells that light which meets a mirror goes no further."""
    tolerance, first_bounce = settings.tolerance, cameras.origins is cameras.places
    few = ~crowded(np.ones(len(cameras)), picture_areas(view, cameras), limits.cameras)
    crowds, cameras = [cameras.select(~few)], cameras.select(few)
    # to look twice for mirrors pays where few cameras see any: hardly after a bounce
    showing = (met.showing_mirrors(mirror_map, cameras, limits.pairs // 4) if first_bounce
               else np.ones(int(cameras.face.max(initial=-1)) + 1, dtype=bool))
    cameras = refined(view, mirror_map, cameras, met, None if last else showing, tolerance, limits.cameras, progress)

    progress.next(0.1, "cones through the tree")
    camera, triangle, visited, crowd = met.trace(mirror_map, cameras, showing, limits.pairs,
                                                 picture_areas(view, cameras))
    seen, column = np.unique(triangle, return_inverse=True)
    frames = SceneFrames.of(met, seen)
    candidates = without_touching(met, mirror_map, cameras, frames, overlapping(cameras, frames, camera, column))
    if last:
        candidates = met.hiding_something(frames, candidates)

    def thin(crowd: np.ndarray) -> np.ndarray:
        nonlocal cameras, candidates
        before, mirror = cameras, met.shows_mirror(frames)[candidates.column]
        cameras, candidates, crowd = thinned(view, before, candidates, mirror, crowd, limits)
        crowds.append(before.select(crowd))
        return ~crowd

    thin(crowd)
    contacts = 0
    if first_bounce:
        cameras, candidates, crowd, contacts = drop_behind_contacts(view, mirror_map, cameras, frames, met.positions,
                                                                    candidates, limits.candidates)
        thin(crowd)
    cameras, candidates, open_, outlines_limited = refine_for_outlines(
        view, mirror_map, cameras, frames, candidates, OUTLINE_SHARE * tolerance, limits.candidates, met)
    # cameras of a pixel in which outlines are bent still, as where rays cross: there is nothing left to cut
    thin(open_)
    bounded = len(candidates) > limits.candidates
    progress.done("cones", nodes_visited=visited, pairs=len(camera), contacts=contacts, cameras=len(cameras),
                  candidates=len(candidates), limited=outlines_limited)

    progress.next(0.35, "projection")
    images, image_counts = vertex_images(view, mirror_map, cameras, Cones.around(cameras), met.positions, frames,
                                         candidates if not last else met.only_diffuse(frames, candidates))
    progress.done("projection", **image_counts)
    cells, rays, filled = 0, 0, 0
    if any(map(len, crowds)):
        cameras, frames, candidates, cells, rays = with_crowds(view, mirror_map, cameras, frames, candidates, crowds,
                                                               met, limits.rays)
        shown = ~met.shows_mirror(frames)[candidates.column[len(candidates) - cells:]]
        filled = covered_pixels(view, cameras.select(slice(len(cameras) - cells, None)).select(shown))
    by_rays = np.arange(len(cameras)) >= len(cameras) - cells
    progress.done("filling", open=int(open_.sum()), crowded=sum(map(len, crowds)) - int(open_.sum()), filled=cells,
                  rays=rays, filled_pixels=filled)

    progress.next(0.5, "clipping")
    polygons = clip(candidates)
    mirror = met.shows_mirror(frames)[candidates.column[polygons.pair]]
    polygons, mirrors = polygons.select(~mirror), polygons.select(mirror & (not last))
    nodes, node_of = polygon_nodes(view, mirror_map, cameras, frames, met.positions, candidates, polygons, images)
    joined = whole_triangles(polygons)
    progress.done("clipping", polygons=len(polygons.pair), joined=joined, cut=len(polygons.pair) - joined)

    progress.next(0.7, "mirrors in the mirror")
    occluded = 0
    if met.shows_mirror(frames).any():
        # rays have told what cells show: nothing hides that
        own, others = (by_rays[candidates.camera[part.pair]] for part in (polygons, mirrors))
        cell_nodes = node_of[np.repeat(own, np.diff(polygons.start))]
        clipped = Polygons.joined((polygons.select(~own), mirrors.select(~others)))
        seen, occluded = cut_behind_mirrors(cameras, frames, met, candidates, clipped)
        if occluded or len(mirrors.pair):
            seen = Polygons.joined((seen, mirrors.select(others)))
            fresh, node_of = polygon_nodes(view, mirror_map, cameras, frames, met.positions, candidates, seen, images)
            node_of = np.concatenate((node_of, cell_nodes + len(fresh.distance)))
            nodes, polygons = fresh.joined(nodes.place, nodes.point, nodes.distance), Polygons.joined(
                (seen, polygons.select(own)))
    progress.done("occlusion", occluded=occluded)

    progress.next(0.75, "connection")
    faces = connect(candidates, polygons, node_of, view.pixels(nodes.place.T))
    # cells are as fine as they are to be
    shown_by_rays = by_rays[faces.camera]
    cell_faces, faces = faces.select(shown_by_rays), faces.select(~shown_by_rays)
    nodes, faces, caustic = split_at_caustics(mirror_map, cameras, frames, nodes, faces)
    progress.done("connection", connected=len(faces) + len(cell_faces), caustic_edges=caustic)

    progress.next(0.8, "refinement")
    refinement = FaceRefinement(view, mirror_map, cameras, frames, beyond_horizon(mirror_map, cameras),
                                settings.placement == "VIRTUAL")
    room = limits.faces - len(cell_faces)
    nodes, faces, left, limited = refinement.refine(nodes, faces, FACE_SHARE * tolerance, room)
    bounded |= limited > 0 and len(faces) + 2 * limited > room
    progress.done("refinement", limited=limited, bounded=bounded)
    # the border of what a cell shows may lie anywhere in it
    length = edge_lengths(view.pixels(nodes.place.T)[cell_faces.nodes]).ravel()
    faces, left = Faces.joined([faces, cell_faces]), np.concatenate((left, np.stack((0.5 * length, length))), axis=1)
    return Bounce(mirror_map, cameras, frames, nodes, faces, left)


def refined(view: View, mirror_map: ReflectionMap, cameras: Cameras, met: SceneAndMirrors, showing: np.ndarray | None,
            tolerance: float, maximum: int, progress: Progress) -> Cameras:
    """The cameras that may see the diffuse scene, or a mirror where the faces `showing` one are told, split where their
    rays stray from the true map."""
    seeing = met.showing_scene(cameras)
    if showing is not None:
        seeing |= showing[cameras.face]
    cameras = cameras.select(seeing)
    centre, radius = met.bounds
    reach = float(norm(cameras.origins - centre[:, None]).max(initial=0.0) + radius)
    cameras, limited = refine_mirror(view, mirror_map, cameras, MIRROR_SHARE * tolerance, reach, maximum)
    progress.done("cameras", limited=limited)
    return cameras
