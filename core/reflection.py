"""The pipeline of the core: from a view, a mirror and a diffuse scene to a reflection mesh."""
from __future__ import annotations

from collections.abc import Generator
from dataclasses import fields, replace

import numpy as np

from .assembly import assemble
from .backward import BackwardPart, backward_arrays
from .bounce import Bounce, Task, bounced, refined, showing_mirrors
from .bounced_cameras import bounced_cameras
from .cameras import (
    Cameras,
    MirrorMap,
    cut_at_horizon,
    in_picture,
    pixels_of,
    three_ray_cameras,
    visible_triangles,
)
from .culling import MirrorsShown, SceneAndMirrors
from .filling import Limits, missed_probes
from .geometry import Order, TriangleMesh, ordered
from .given import check_given, checked_opacity
from .patches import Patch, speck
from .points import reflected_points
from .recentring import far_corner, moved_mesh, moved_surface, moved_view
from .result import ReflectionMesh, in_given_order
from .standing import Standing
from .support import INSIDE, INSIDE_WHOLE, LEFT, NothingInView, Progress, Settings, in_steps, keep_freed_memory
from .trees import PointTree, SceneTree
from .views import LampView, View
from .visibility import cut_at_borders, cut_before_eye, lit, slide_share, with_shades, without_hidden, without_occluded
from .whole_faces import WholeFaces, seamed, whole_faces

TRACING = "Tracing rays"
UNSEEN = "The view does not see the mirror; turn the camera to the mirror or move it into view."


def reflect(view: View, mirror: TriangleMesh, scene: TriangleMesh | SceneTree | PointTree | Standing,
            settings: Settings = Settings(), mirrors: TriangleMesh | None = None,
            opacity: np.ndarray | None = None) -> ReflectionMesh:
    """Compute the reflection of a diffuse scene in a mirror as the view sees it.

    Parameters
    ----------
    view : View
    mirror : TriangleMesh
        In world space, with shading normals. Two-sided.
    scene : TriangleMesh or SceneTree or PointTree or Standing
        In world space. A tree saves the time to build one; a `Standing` also caches the mirrors. The method POINTS
        takes a `PointTree`, or scenes of vertices without faces.
    settings : Settings
    mirrors : TriangleMesh, optional
        In world space. All mirrors that may be seen in this one, including itself. Default: `mirror` alone, or the
        mirrors of a `Standing`. They hide objects behind them, and from a depth of two on they show reflections too.
    opacity : (m,) integer, optional
        `Opacity` of each triangle of the input scene; all are opaque if omitted. Objects behind clear triangles are in
        the result too. It is not a part of the mesh, so that trees stay valid while materials change.

    Returns
    -------
    ReflectionMesh
        In world space.

    Raises
    ------
    ReflectionError
        If the mirror or the scene is empty, the mirror is not in the picture, or the eye lies on it.

    Examples
    --------
    >>> import numpy as np
    >>> from core import TriangleMesh, View, reflect
    >>> view = View.looking_at((0, -4, 3), (0, 0, 0), (320, 240))
    >>> mirror = TriangleMesh(np.array([[-2, -2, 0], [2, -2, 0], [0, 2, 0]]), np.array([[0, 1, 2]]))
    >>> scene = TriangleMesh(np.array([[0, 0, 1], [0.3, 0, 1], [0, 0, 1.4]]), np.array([[0, 1, 2]]))
    >>> mesh = reflect(view, mirror, scene)
    >>> np.unique(mesh.source_face).tolist(), mesh.estimated_error < 0.5
    ([0], True)
    """
    keep_freed_memory()
    tree = scene.tree if isinstance(scene, Standing) else scene
    mirrors = scene.mirrors if isinstance(scene, Standing) and mirrors is None else mirrors
    check_given(view, mirror, tree, settings, mirrors)
    opacity = checked_opacity(tree, opacity)
    corner = far_corner(mirror)
    if corner is None:
        return _near_origin(view, mirror, scene, settings, mirrors, opacity)
    mesh = _near_origin(moved_view(view, -corner), moved_surface(mirror, -corner), moved_surface(tree, -corner),
                        settings, None if mirrors is None else moved_surface(mirrors, -corner), opacity)
    return moved_mesh(mesh, corner)


def reflection_steps(
        view: View, mirror: TriangleMesh, scene: TriangleMesh | SceneTree | PointTree | Standing,
        settings: Settings = Settings(), mirrors: TriangleMesh | None = None,
        opacity: np.ndarray | None = None) -> Generator[tuple[float, str], None, ReflectionMesh]:
    """Run `reflect` as a generator that yields (share of the work done, name of the next stage) and returns the mesh.

    A long stage yields several times. Close the generator to cancel the work.

    Examples
    --------
    >>> import numpy as np
    >>> from core import TriangleMesh, View, reflection_steps
    >>> view = View.looking_at((0, -4, 3), (0, 0, 0), (320, 240))
    >>> mirror = TriangleMesh(np.array([[-2, -2, 0], [2, -2, 0], [0, 2, 0]]), np.array([[0, 1, 2]]))
    >>> scene = TriangleMesh(np.array([[0, 0, 1], [0.3, 0, 1], [0, 0, 1.4]]), np.array([[0, 1, 2]]))
    >>> next(reflection_steps(view, mirror, scene))  # in a generator: mesh = yield from reflection_steps(...)
    (0.0, 'Preparing the scene')
    """
    return (yield from in_steps(lambda: reflect(view, mirror, scene, settings, mirrors, opacity)))


def _near_origin(view: View, mirror: TriangleMesh, scene: TriangleMesh | SceneTree | PointTree | Standing,
                 settings: Settings, mirrors: TriangleMesh | None, opacity: np.ndarray | None) -> ReflectionMesh:
    """Compute the reflection of a scene near the origin, where float precision is enough for the mirror's shape."""
    progress = Progress()
    progress.next(0.0, "Preparing the scene")
    kind: type[SceneTree] | type[PointTree] = PointTree if settings.method == "POINTS" else SceneTree
    given_tree = scene.tree if isinstance(scene, Standing) else scene
    tree = given_tree if isinstance(given_tree, kind) else kind.build(
        given_tree if isinstance(given_tree, TriangleMesh) else given_tree.mesh)
    if not len(tree):
        raise NothingInView("The reflected objects have no faces with an area; select objects with faces to reflect.")
    known = scene if isinstance(scene, Standing) and scene.tree is tree and scene.mirrors is mirrors else None
    mirror, given, met = _with_mirrors(view, tree, mirror, mirrors, known)
    met = met.with_opacity(opacity)
    met = met if isinstance(tree, PointTree) or settings.hidden_faces else met.from_outside(view)
    progress.done("tree")

    backward = _backward(view, mirror, met, settings, progress)
    try:
        seen = _seen_cameras(view, mirror, met, settings, progress, None if backward is None else ~backward.chosen)
    except NothingInView:
        if backward is None:
            raise
        # cameras see nothing: the part of the mirror made by rays hides the rest
        progress.next(0.3, TRACING)
        mesh = assemble(view, [], met, settings.placement, backward=backward_arrays(backward, met))
        progress.done("rays", faces=len(mesh.triangles), **backward.counts)
        mesh, error = in_given_order(mesh, tree.given, given), settings.tolerance
    else:
        mesh, error = _forward(met, settings, progress, seen, backward)
        mesh = in_given_order(mesh, tree.given, given)
        if not isinstance(tree, PointTree):
            mirror_map = seen[0].mirror_map
            assert isinstance(mirror_map, MirrorMap)  # the first bounce has no other map
            probes, missed = missed_probes(view, mirror, mirror_map, met, mesh.mirror_position, mesh.triangles)
            progress.done("probes", probes=probes, missed=missed)
    return replace(mesh, counts=progress.counts, seconds=progress.seconds, estimated_error=error)


def _forward(met: SceneAndMirrors, settings: Settings, progress: Progress,
             seen: tuple[Cameras, int, tuple[int, int]], backward: BackwardPart | None) -> tuple[ReflectionMesh, float]:
    """Compute the reflection that cameras see, and join it with the part made by rays (`backward`).

    `seen` is the result of `_seen_cameras`.

    Returns
    -------
    mesh : ReflectionMesh
    error : float, estimated error in pixels
    """
    cameras, uncut, (pixels, overlaid) = seen
    met = _behind_panes(cameras, met, progress)
    limits = Limits.of(settings, pixels, len(met.triangles))
    if isinstance(met.tree, PointTree):
        entire = np.zeros(0, dtype=bool) if overlaid else _entire(cameras, uncut)
        mesh = _points(cameras, entire, Task(met, settings, limits, True, progress))
        return mesh, mesh.estimated_error
    task = Task(met, settings, limits, settings.bounces == 1, progress)
    showing = _showing_mirrors(cameras, task)
    if not settings.depth and not showing.faces.any():
        task = replace(task, last=True)
    whole, task = (None, task) if overlaid else _whole_first(cameras, uncut, task, showing.plainly)
    bounces, seams, error, reach = _bounces(cameras, task, showing, pixels), None, 0.0, 0.0
    if whole is not None:
        seams, nodes = seamed(whole, bounces[0].cameras, bounces[0].frames, bounces[0].nodes, bounces[0].faces)
        bounces[0] = replace(bounces[0], nodes=nodes)
        # the depth order of whole faces assumed this longest path length
        reach, error = task.reach(cameras), INSIDE_WHOLE * _over_length(*whole.straying)
    del whole  # free its memory before assembly

    progress.start, progress.share = 0.0, 1.0
    error = max(_estimate(*np.concatenate([bounce.left for bounce in bounces], axis=1)), error)
    by_rays = None
    if backward is not None:
        progress.next(0.9, TRACING)
        by_rays, error = backward_arrays(backward, met), max(error, settings.tolerance)
        progress.done("rays", **backward.counts)
    progress.next(0.95, "Sorting by depth")
    mesh = assemble(cameras.view, bounces, task.met, settings.placement,
                    None if seams is None else (seams, reach), by_rays)
    depth = max(len(bounces), settings.depth, 1 if backward is None else backward.counts["depth"])
    progress.done("placement", faces=len(mesh.triangles), depth=depth)
    return mesh, error


def _points(cameras: Cameras, entire: np.ndarray, task: Task) -> ReflectionMesh:
    """Compute the reflected points that cameras see.

    `entire` (n,) bool marks cameras that are uncut mirror triangles: these may form a patch. It may be empty.
    """
    patch = None
    if len(entire) and not speck(cameras.view, task.met.tree.spheres[0][:, 0]):
        patch = Patch.largest(cameras, entire & ~showing_mirrors(cameras, task.met, task.limits).plainly[cameras.face])
    rest = cameras if patch is None else cameras.select(~np.isin(cameras.face, patch.face))
    mesh = reflected_points(refined(rest, task, None), patch, task.met, task.settings.placement, task.progress)
    task.progress.done("points", **mesh.counts)
    return mesh


def _seen_cameras(view: View, mirror: TriangleMesh, met: SceneAndMirrors, settings: Settings, progress: Progress,
                  faces: np.ndarray | None = None) -> tuple[Cameras, int, tuple[int, int]]:
    """Make cameras on the visible parts of the mirror.

    Parameters
    ----------
    faces : (m,) bool, optional, triangles of the mirror to use; default all

    Returns
    -------
    cameras : Cameras
    uncut : int, number of corners before any camera was cut
    pixels, overlaid : tuple of int
        About how many pixels see the mirror, and for how many cameras the occluders in front are not all known.

    Raises
    ------
    NothingInView
        If the view does not see the mirror.
    """
    progress.next(0.1, "Preparing the mirror")
    chosen = visible_triangles(view, mirror) if faces is None or faces.any() else np.zeros(0, dtype=np.int64)
    if faces is not None:
        chosen = chosen[faces[chosen]]
    if not len(chosen):
        raise NothingInView(UNSEEN)
    body, faces = with_shades(view, mirror, chosen)
    mirror_map = MirrorMap(view, body, settings.method == "PARALLEL", met.surface if body is met.mirrors else None)
    cameras = three_ray_cameras(mirror_map, body, faces)
    uncut = cameras.places.shape[1]
    cameras = _seen(cameras.select(in_picture(cameras)))
    cameras = cut_at_borders(cut_before_eye(cameras))
    cameras, grid = without_hidden(cameras)
    cameras, occluded, overlaid = without_occluded(body, cameras, grid)
    cameras = cut_at_horizon(_seen(cameras.select(lit(cameras) & (cameras.face < len(mirror.triangles)))))
    progress.done("cameras", mirror_triangles=len(cameras), mirror_pixels=grid.mirror_pixels, self_occluded=occluded,
                  overlaid=overlaid)
    return cameras, uncut, (grid.mirror_pixels, overlaid)


def _backward(view: View, mirror: TriangleMesh, met: SceneAndMirrors, settings: Settings,
              progress: Progress) -> BackwardPart | None:
    """Find the part of the mirror that is made backwards, by rays from the eye; return None if there is none.

    Parallel cameras, points, lamps, and layers behind clear or hidden triangles are always made forward.
    """
    if (settings.method != "GENERAL" or settings.hidden_faces or isinstance(view, LampView)
            or not met.opacities.all_opaque):
        return None
    progress.next(0.1, "Preparing the mirror")
    part = BackwardPart(view, mirror, met, settings)
    progress.done("rays")
    return part if part else None


def _behind_panes(cameras: Cameras, met: SceneAndMirrors, progress: Progress) -> SceneAndMirrors:
    """Return `met` with layers that slide by less, so that they stay behind panes and films in front of the mirror."""
    share, covering = slide_share(cameras, met)
    progress.done("cameras", too_close=covering)
    return met.sliding(share)


def _seen(cameras: Cameras) -> Cameras:
    if not len(cameras):
        raise NothingInView(UNSEEN)
    return cameras


def _with_mirrors(view: View, tree: SceneTree | PointTree, mirror: TriangleMesh, mirrors: TriangleMesh | None,
                  known: Standing | None) -> tuple[TriangleMesh, Order, SceneAndMirrors]:
    """Sort the mirror canonically, and join the diffuse scene, the mirrors and a lamp's occluders.

    `known` is the cache of the same tree and the same mirrors, or None.

    Returns
    -------
    mirror : TriangleMesh, in its canonical order
    order : Order, of the mirror
    met : SceneAndMirrors, triangles that rays may hit
    """
    screens = view.screens if isinstance(view, LampView) else None
    if known is not None and screens is None:
        own = (known.met.mirrors, known.order) if mirror is mirrors else ordered(mirror, shading=True)
        return *own, known.met
    every, (mirror, given) = mirrors, ordered(mirror, shading=True)
    if screens is not None:
        every = mirror if every is None else every
        met, order = ordered(TriangleMesh.joined((every, screens)), shading=True)
        return mirror, given, SceneAndMirrors(tree, met, order.triangle < len(every.triangles), order.triangle)
    met, order = (mirror, given) if every is None else ordered(every, shading=True)
    return mirror, given, SceneAndMirrors(tree, met, given=order.triangle)


def _draws_whole(settings: Settings) -> bool:
    return settings.method == "GENERAL" and not settings.hidden_faces


def _showing_mirrors(cameras: Cameras, task: Task) -> MirrorsShown:
    """Find the mirrors that cameras of the first bounce may show.

    Return `unknown` if this is the last bounce and all faces are clipped, as for a lamp. Then the refined cameras
    search for mirrors once; an earlier search would cost more time than it saves.
    """
    if task.last and not _draws_whole(task.settings):
        return MirrorsShown.unknown(cameras)
    return showing_mirrors(cameras, task.met, task.limits)


def _whole_first(cameras: Cameras, uncut: int, task: Task,
                 showing: np.ndarray) -> tuple[WholeFaces | None, Task]:
    """Draw unclipped triangles from the images of their vertices, where a part of the mirror shows them whole.

    Parameters
    ----------
    uncut : int, number of corners before any camera was cut: cameras with later corners have been cut
    showing : (m,) bool, faces of the mirror that may show a mirror

    Returns
    -------
    whole : WholeFaces or None
    task : Task, for the rest of the scene and with the limits that are left
    """
    settings, limits = task.settings, task.limits
    if not _draws_whole(settings):
        return None, task
    task.progress.next(0.15, "Reflecting faces")
    eligible = _entire(cameras, uncut) & ~showing[cameras.face]
    whole = whole_faces(cameras, eligible, task.met, task.reach(cameras), settings, limits.pieces)
    if whole is None:
        return None, task
    drawn = int(whole.drawn.sum())
    task.progress.done("whole faces", whole=drawn, left=whole.left.sum(), pieces=len(whole.pieces),
                       hidden=whole.hidden, limited=whole.limited, bounded=whole.limited > 0)
    held = sum(getattr(part, field.name).nbytes for part in (whole.images, whole.pieces) for field in fields(part))
    return whole, replace(task, met=task.met.left_to(whole.scene_pieces()),
                          limits=replace(limits.beside(held), faces=max(limits.faces - drawn, 1)))


def _entire(cameras: Cameras, uncut: int) -> np.ndarray:
    """Return True (n,) for cameras that are uncut mirror triangles: their corner indices are all below `uncut`."""
    return (cameras.corners < uncut).all(axis=1) & (np.bincount(cameras.face)[cameras.face] == 1)


def _bounces(cameras: Cameras, task: Task, showing: MirrorsShown, pixels: int) -> list[Bounce]:
    """Compute the bounces one after another: faces seen after one mirror, after two, and so on.

    Stop at the depth in the settings, or if nothing is left to see. With automatic depth, stop also if the cameras left
    cover less than a small share (`LEFT`) of the mirror's `pixels`.
    """
    bounces: list[Bounce] = []
    met, settings, limits, progress = task.met, task.settings, task.limits, task.progress
    most, enough = (1 if task.last else settings.bounces), (0.0 if settings.depth else LEFT * pixels)
    for number in range(most):
        # divide the progress bar: the first bounce gets most, later bounces share the rest
        progress.start, progress.share = 0.95 - 0.8 / (number + 1), 0.8 / ((number + 1) * min(number + 2, most))
        last = number + 1 == most
        bounces.append(bounced(cameras, replace(task, limits=limits, last=last), showing))
        if last:
            break
        limits, cameras = limits.of_next_bounce(), cut_at_horizon(bounced_cameras(bounces[-1], met))
        progress.done("cameras", bounced_cameras=len(cameras))
        if not len(cameras) or pixels_of(cameras).sum() < enough:
            break
        showing = showing_mirrors(cameras, met, limits)
    return bounces


def _estimate(straying: np.ndarray, length: np.ndarray) -> float:
    """Estimate the 99th percentile of the deviation inside the faces, in pixels, from the deviation at edge midpoints.

    Return the larger of two estimates: the percentile over edges, times a factor for the inside of faces (`INSIDE`),
    and the percentile over edge length, for meshes with many edges that are too short to be seen.

    Parameters
    ----------
    straying : (e,) float64, deviation at the midpoint of each edge, in pixels
    length : (e,) float64, length of each edge, in pixels
    """
    return float(max(INSIDE * np.percentile(straying, 99), _over_length(straying, length)))


def _over_length(straying: np.ndarray, length: np.ndarray) -> float:
    """Return the 99th percentile of the deviation `straying` (e,), weighted by the edges' `length` (e,), in pixels."""
    order = np.argsort(straying)
    below = np.cumsum(length[order])
    return straying[order[min(np.searchsorted(below, 0.99 * below[-1]), len(order) - 1)]] if len(order) else 0.0
