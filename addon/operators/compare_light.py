"""The comparison of caustics with Cycles: the work in steps."""
from __future__ import annotations

import time
from dataclasses import dataclass
from functools import partial

import bpy
import numpy as np

from ...core import ReflectionError, TriangleMesh, View, breathe, draw, in_steps
from ..comparison import (
    MESH,
    OWN,
    LightPictures,
    Lit,
    Shot,
    Surroundings,
    against_rays,
    render_light,
    runs_of,
    write_light_report,
)
from ..faults import Steps, one_or_more, part
from ..files import staged
from ..illumination import blockers_of, blocking
from ..judge import copied_scene
from ..metrics import line_offsets, picture_errors
from ..reading import Participants, read_view

READING, RENDERING, TRACING, JUDGING = 0.02, 0.8, 0.1, 0.04  # shares of the work
COMPARING = "Comparing the pictures"
STEPS_UP = 4  # times as many samples in the second picture of each kind
ON_SURFACE = 2e-3  # relative to the distance; points so close to a surface lie on it
MOST_PIECES = 20_000  # limit for the number of segments of the caustic curve


@dataclass(frozen=True)
class Effort:
    """Samples of the first picture of each kind, of the reference, and rays for each result."""

    samples: int
    converged: int
    rays: int


def caustics_in(context: bpy.types.Context) -> list:
    """Return the scene's caustics, which will be compared.

    Raises
    ------
    ReflectionError
        If there are none, or some are hidden or have lost their lamp or mirror.
    """
    found = [obj for obj in context.view_layer.objects if obj.reflection_mesh.role == "CAUSTICS" and obj.type == "MESH"]
    if not found:
        raise ReflectionError("There is no light of mirrors to compare: generate caustics first.")
    for obj in found:
        record = obj.reflection_mesh
        if obj.hide_render or not obj.visible_get():
            raise ReflectionError(f"The light '{obj.name}' is hidden: show it in the viewport and in renders.")
        if any(one is None or one.name not in context.view_layer.objects for one in (record.mirror, record.lamp)):
            raise ReflectionError(f"The mirror or the lamp of '{obj.name}' has gone: clear it.")
    return found


def light_comparison(context: bpy.types.Context, folder: str, effort: Effort) -> Steps[dict]:
    """Judge the scene's caustics against Cycles' own and against rays, and write pictures and numbers.

    Yields (fraction, stage), of renders as `rendering.shown_while`; closed at any step it leaves no trace.

    Returns
    -------
    report : dict
        What report.json holds.

    Raises
    ------
    ReflectionError
        Where nothing can be compared, or a render is cancelled; nothing has changed then.
    """
    started, results = time.perf_counter(), caustics_in(context)
    view = read_view(context)
    yield 0.0, "Reading the scene"
    depsgraph = context.evaluated_depsgraph_get()
    faces = [Lit.of(result) for result in results]
    if None in faces:
        lost = results[faces.index(None)].name
        raise ReflectionError(f"The faces of '{lost}' do not know their light: generate it again.")
    around = [_surroundings(context, depsgraph, result, results) for result in results]
    seen = yield from part(in_steps(partial(_seen, view, around)), 0.0, READING, "Reading the scene")
    light, done = {}, READING
    for result, lit, surroundings in zip(results, faces, around):
        share = TRACING / len(results)
        steps = against_rays(depsgraph, result, lit, surroundings, effort.rays)
        light[result.name] = yield from part(steps, done, share, f"Tracing rays for '{result.name}'")
        done += share
    counts = (effort.samples, STEPS_UP * effort.samples)
    with staged(folder) as scratch:
        pictures = yield from part(render_light(context, results, counts, effort.converged), done, RENDERING)
        done += RENDERING
        yield done, COMPARING
        mask = seen.reshape(view.resolution[::-1])
        generate = sum(result.reflection_mesh.seconds for result in results)
        errors = yield from part(in_steps(partial(_errors, pictures, mask)), done, JUDGING, COMPARING)
        runs = runs_of(pictures, errors, generate)
        curve = yield from part(in_steps(partial(_curve, view, faces, around, pictures, mask)), done, JUDGING,
                                COMPARING)
        done += JUDGING
        report = {
            "blender": bpy.app.version_string, "resolution": list(view.resolution),
            "mirrors": _names(result.reflection_mesh.mirror for result in results),
            "lamps": _names(result.reflection_mesh.lamp for result in results),
            "receivers": _names(item.object for result in results for item in result.reflection_mesh.sources),
            "results": [result.name for result in results],
            "receiver_pixels": int(mask.sum()),
            "reference": {"samples": pictures.samples, "seconds": pictures.seconds,
                          "noise": float(np.sqrt(pictures.variance[mask].mean())) if mask.any() else 0.0},
            "runs": [{"method": run.method, "samples": int(run.value), "seconds": run.seconds, **run.numbers}
                     for run in runs],
            "light": light, "rays": effort.rays, "curve": curve,
            "generate_seconds": generate, "seconds": time.perf_counter() - started}
        with copied_scene(context, [], [], []) as copied:
            yield from part(write_light_report(scratch, copied.scene, pictures, mask, report, runs), done, 1.0 - done)
    return report


def light_summary(report: dict, folder: str) -> str:
    """Return the report in one sentence."""
    last = {run["method"]: run for run in report["runs"]}
    mesh, own = (last[method]["picture"]["receivers"]["psnr"] for method in (MESH, OWN))
    flux = [one["flux_percent"] for one in report["light"].values() if one["flux_percent"] is not None]
    taken = last[OWN]["samples"]
    samples = one_or_more(taken, "1 sample", "{count} samples")
    if mesh is None or own is None:
        return f"The camera sees nothing on which light falls; pictures in {folder}"
    if not flux:
        return (f"{mesh:.1f} dB from Cycles' own converged caustics, where its own at {samples} "
                f"are {own:.1f} dB; pictures in {folder}")
    return (f"{mesh:.1f} dB from Cycles' own converged caustics, where its own at {samples} are "
            f"{own:.1f} dB; flux {max(flux, key=abs):+.3f} % from rays; pictures in {folder}")


def _names(objects) -> list:
    return list(dict.fromkeys(obj.name for obj in objects if obj is not None))


def _surroundings(context: bpy.types.Context, depsgraph: bpy.types.Depsgraph, result: bpy.types.Object,
                  results: list) -> Surroundings:
    record = result.reflection_mesh
    sources = [item.object for item in record.sources if item.object is not None]
    mirrors = [record.mirror, *dict.fromkeys(other.reflection_mesh.mirror for other in results
                                             if other.reflection_mesh.mirror not in (record.mirror, *sources))]
    standing = [obj for obj in blocking(context, Participants(mirrors, sources, [])) if obj != record.lamp]
    blockers = blockers_of(depsgraph, standing)
    return Surroundings.of(depsgraph, mirrors, sources, blockers)


def _seen(view: View, around: list) -> np.ndarray:
    """Return the pixels (n,) in which the camera sees an object that may receive caustics."""
    seen = np.zeros(view.resolution[0] * view.resolution[1], dtype=bool)
    for one in around:
        breathe()
        receivers = one.scene.mesh
        others = TriangleMesh.joined([*one.surfaces, *([] if one.blockers is None else [one.blockers])])
        depth, hiding = (draw(view, mesh.positions, mesh.triangles).depth for mesh in (receivers, others))
        seen |= np.isfinite(depth) & (depth <= hiding)
    return seen


def _errors(pictures: LightPictures, mask: np.ndarray) -> list:
    """Return, for each shot, its errors over the mask and its noise (difference between two random seeds). Cycles' own
    shots come first.
    """
    found = []
    for shot in (*pictures.own, *pictures.mesh):
        breathe()
        errors = picture_errors(pictures.reference, shot.picture, {"receivers": mask})["receivers"]
        found.append((errors, _noise(shot, mask)))
    return found


def _noise(shot: Shot, mask: np.ndarray) -> float | None:
    if shot.again is None or not mask.any():
        return None
    apart = (shot.picture.astype(np.float64) - shot.again)[mask]
    return float(np.sqrt((apart**2).mean() / 2.0))


def _curve(view: View, faces: list, around: list, pictures: LightPictures, mask: np.ndarray) -> dict:
    """Compare the brightest lines near the folds of the caustics in the reference and in the last picture with meshes.
    """
    middle, inward, length = (np.concatenate(one) for one in zip(*(
        _folds(view, lit, one) for lit, one in zip(faces, around))))
    known = {"regions": 0, "pieces": len(length)}
    if not len(length):
        return known
    shown = {"reference": pictures.reference.mean(axis=2), "mesh": pictures.mesh[-1].picture.mean(axis=2)}
    shown = {name: np.where(mask, picture, 0.0) for name, picture in shown.items()}
    breathe()
    offsets = line_offsets(shown, middle, inward, length)
    regions = len(offsets["mesh"])
    if not regions:
        return known
    apart = np.abs(offsets["reference"] - offsets["mesh"])
    return {**known, "regions": regions, "reference_median": float(np.median(offsets["reference"])),
            "mesh_median": float(np.median(offsets["mesh"])), "apart_median": float(np.median(apart)),
            "apart_most": float(apart.max())}


def _folds(view: View, lit: Lit, around: Surroundings) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the segments of the caustic curve that the camera sees: middles in pixels, unit directions to the lit
    side, and lengths.
    """
    on_fold = (lit.parity == 0)[lit.triangles]
    row = np.flatnonzero(on_fold.sum(axis=1) == 2)
    third = np.argmin(on_fold[row], axis=1)
    corners = lit.triangles[row[:, None], (third[:, None] + np.arange(3)) % 3]
    used = lit.positions[corners]
    pixels = view.pixels(used.reshape(-1, 3)).reshape(-1, 3, 2)
    start, end, other = pixels[:, 1], pixels[:, 2], pixels[:, 0]
    along = end - start
    length = np.linalg.norm(along, axis=1)
    across = np.stack((-along[:, 1], along[:, 0]), axis=1) / np.maximum(length, 1e-9)[:, None]
    middle = 0.5 * (start + end)
    across *= np.where(((other - middle) * across).sum(axis=1) < 0.0, -1.0, 1.0)[:, None]
    inside = ((middle >= 0.0) & (middle < view.resolution)).all(axis=1) & (length > 1e-6)
    breathe()
    depth = view.depths(used[:, 1:].mean(axis=1))
    inside &= depth > 0.0
    pixel = (middle[inside].astype(np.int64) * (1, view.resolution[0])).sum(axis=1)
    nearest = np.minimum(*(draw(view, mesh.positions, mesh.triangles).depth for mesh in (
        around.scene.mesh, TriangleMesh.joined([*around.surfaces, *([] if around.blockers is None else [
            around.blockers])]))))
    breathe()
    inside[inside] = depth[inside] <= nearest[pixel] * (1.0 + ON_SURFACE)
    chosen = np.flatnonzero(inside)
    chosen = chosen[np.linspace(0, len(chosen) - 1, min(len(chosen), MOST_PIECES)).astype(np.int64)]
    return middle[chosen], across[chosen], length[chosen]
