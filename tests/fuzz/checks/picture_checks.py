"""Whether a reflection mesh shows what rays see, on a coarse grid of the picture: whole regions must not be wrong."""
from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from core import ReflectionMesh, View
from tests.fuzz.drawing.configurations import Configuration
from tests.oracles.raster import rasterise
from tests.oracles.truth_bounces import trace_bounces

PIXELS = 24  # of the longer side of the coarse picture
SHARE, FEWEST = 0.04, 5  # of the mirror's pixels, and pixels: more must not be wrong
OTHER_SURFACE = 2.0  # pixels: another triangle further away is another surface
TOLERANCES = 3.0  # by which a region may be displaced, and one pixel more
TOLD = ("missed", "bounded", "unfilled")  # counts by which a result tells that something is missing


def shows_what_rays_see(configuration: Configuration, mesh: ReflectionMesh) -> Iterator[str]:
    """No large part of the mirror is wrong, or open without a count that says so."""
    if configuration.settings.method != "GENERAL":
        return
    seen, wrong = regions(configuration, mesh)
    if any(mesh.counts.get(name) for name in TOLD):
        del wrong["holes"]
    for kind, pixels in wrong.items():
        if pixels >= FEWEST and pixels > SHARE * seen:
            yield f"{kind}: {pixels} of {seen} pixels of the mirror, and no count says so"


def refused_rightly(configuration: Configuration, refusal: str) -> Iterator[str]:
    """No sentence says that the view does not see the mirror where rays do."""
    if " see " not in refusal:
        return
    view, mirrors = coarse(configuration.view), configuration.mirrors
    seen = trace_bounces(view, configuration.mirror, configuration.scene, mirrors, 1).seen
    if seen.sum() >= FEWEST:
        yield f"refusal: {seen.sum()} of {len(seen)} pixels show the mirror: {refusal!r}"


def regions(configuration: Configuration, mesh: ReflectionMesh) -> tuple[int, dict[str, int]]:
    """How many pixels of the coarse picture show the mirror, and in how many of these the mesh is wrong.

    Returns
    -------
    seen : int
        Pixels where Cycles bends the normal are left out, here and below.
    wrong : dict
        `holes`: rays see the scene and the mesh shows nothing; `spill`: the reverse; `layers`: the mesh shows another
        surface; `astray`: it shows another place of the same triangle. SURFACE does not order its layers: both are
        left out there.
    """
    view = coarse(configuration.view)
    truth = trace_bounces(view, configuration.mirror, configuration.scene, configuration.mirrors,
                          configuration.settings.depth)
    counted = truth.seen & ~truth.bent
    sees = counted & (truth.source >= 0)
    drawn = rasterise(view, mesh.positions, mesh.triangles)
    shows = drawn.triangle >= 0
    wrong = {"holes": sees & ~shows, "spill": counted & ~sees & shows}
    if configuration.settings.placement != "SURFACE" and len(mesh.triangles):
        both, same = sees & shows, mesh.source_face[drawn.triangle] == truth.source
        place = drawn.interpolate(mesh.reflected_position, mesh.triangles)
        away = np.linalg.norm(place - truth.position, axis=1) / np.where(truth.motion > 0.0, truth.motion, np.nan)
        wrong["layers"] = both & ~same & ~(away < OTHER_SURFACE)
        wrong["astray"] = both & same & (away > TOLERANCES * configuration.settings.tolerance + 1.0)
    return int(counted.sum()), {kind: int(pixels.sum()) for kind, pixels in wrong.items()}


def coarse(view: View) -> View:
    """The same eye with few pixels."""
    return replace(view, resolution=tuple(max(1, round(PIXELS * side / max(view.resolution)))
                                          for side in view.resolution))


CHECKS = (shows_what_rays_see,)
