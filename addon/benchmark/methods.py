"""The methods of the benchmark: those of `core.rivals` and Blender's own tree, from fewer samples than pixels to more.

A ray tracer takes more samples than pixels by working on a picture that is finer all over. What the eye sees of the
mirror at the pixels' centres is given to every method; what it sees at more places is the method's own work, and the
seconds of that beyond what was given are booked as `EYE`.
"""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from ...core.rivals import METHODS as CORE
from ...core.rivals import PrimaryHits, Rival, RivalPicture, primary_hits
from .case import Case
from .judging import Sampled
from .rival_bvhtree import RIVAL as BVHTREE

EYE = "more places seen by the eye"
SAMPLES = "samples across a pixel"
TILE = 16       # samples across a tile of a cluster: the fastest of those tried


@dataclass(frozen=True)
class Method:
    """One line of the plots: `run` takes (case, value of the knob, what the eye sees); values go from coarse to fine,
    and each is expected to take `growth` times as long as the one before."""

    title: str
    knob: str
    values: tuple
    run: Callable[[Case, float, PrimaryHits], Sampled]
    growth: float


def _as_it_is(rival: Rival, growth: float) -> Method:
    def run(case: Case, value: float, hits: PrimaryHits) -> Sampled:
        return Sampled(rival.run(case.view, case.mirror, case.scene.mesh, value, hits))
    return Method(rival.title, rival.knob, rival.values, run, growth)


def _rays(rival: Rival, values: tuple, title: str = "", argument=lambda value: 1 if value >= 1 else round(1 / value)):
    """A ray tracer with `value` samples across a pixel; `argument` says what the rival itself is told for that."""
    def run(case: Case, value: float, hits: PrimaryHits) -> Sampled:
        across = max(1, round(value))
        picture = _finer(rival, case, across, argument(value), hits)
        return Sampled(picture, across)
    return Method(title or rival.title, SAMPLES, values, run, 4.0)


def _finer(rival: Rival, case: Case, across: int, argument: int, hits: PrimaryHits) -> RivalPicture:
    scene = case.scene.mesh
    if across == 1:
        return rival.run(case.view, case.mirror, scene, argument, hits)
    width, height = case.view.resolution
    view = replace(case.view, resolution=(across * width, across * height))
    seen = primary_hits(view, case.mirror, scene)
    picture = rival.run(view, case.mirror, scene, argument, seen)
    more = max(sum(seen.seconds.values()) - sum(hits.seconds.values()), 0.0)
    return replace(picture, seconds={EYE: more, **picture.seconds})


METHODS: dict[str, Method] = {
    "GENERAL": _as_it_is(CORE["GENERAL"], 1.0),
    "UNREFINED": _as_it_is(CORE["UNREFINED"], 2.0),
    "PARALLEL": _as_it_is(CORE["PARALLEL"], 2.0),
    "POINTS": _as_it_is(CORE["POINTS"], 3.0),
    "RAYS": _rays(CORE["RAYS"], (0.125, 0.25, 0.5, 1, 2, 4)),
    "RAYS_ADAPTIVE": _rays(CORE["RAYS"], (2, 4), "Ray tracing, finer at edges only", round),
    "BVHTREE": _rays(BVHTREE, (0.125, 0.25, 0.5, 1, 2, 4), "Blender's BVHTree"),
    "CLUSTERS": _rays(CORE["CLUSTERS"], (1, 2, 4), argument=lambda value: TILE),
    "MORPHING": _as_it_is(CORE["MORPHING"], 2.0),
    "BILLBOARDS": _as_it_is(CORE["BILLBOARDS"], 2.0),
    "ENVIRONMENT": _as_it_is(CORE["ENVIRONMENT"], 2.0),
    "ENVIRONMENT_BOX": _as_it_is(CORE["ENVIRONMENT_BOX"], 2.0),
}
