"""Records of earlier work, stored as JSON in properties of a .blend file. They are parsed once and validated.

A file may come from anywhere: anything that this extension does not write counts as missing.
"""
from __future__ import annotations

import json
from functools import lru_cache
from types import MappingProxyType
from typing import NamedTuple

import bpy

LONGEST = 20_000    # characters of a record; its own are a few hundred
LARGEST = 1e15      # no number in a record is larger
NOTHING = MappingProxyType({})


class Comparison(NamedTuple):
    """The numbers of a comparison with Cycles; None where there was nothing to measure."""

    resolution: tuple[int, int]
    coverage: float | None
    median: float | None
    p99: float | None
    psnr: float | None
    ssim: float | None
    flip: float | None


class LightComparison(NamedTuple):
    """The numbers of a comparison of caustics with Cycles'; None where there was nothing to measure.

    PSNR are those of the picture with meshes and of Cycles' own at `samples` samples, to its own converged; the flux is
    how far that is from rays, in per cent.
    """

    resolution: tuple[int, int]
    samples: int
    psnr: float | None
    psnr_own: float | None
    flux: float | None


def light_text(report: dict) -> str:
    """Return the record of a report on caustics as text."""
    last = {run["method"]: run for run in report["runs"]}
    flux = [one["flux_percent"] for one in report["light"].values() if one["flux_percent"] is not None]
    return json.dumps({
        "resolution": report["resolution"], "light_samples": last["CYCLES"]["samples"],
        "light_psnr": last["MESH"]["picture"]["receivers"]["psnr"],
        "own_psnr": last["CYCLES"]["picture"]["receivers"]["psnr"], "flux": max(flux, key=abs, default=None)})


def light_comparison(text: str) -> LightComparison | None:
    """Parse the text that `light_text` wrote; return None for any other text."""
    return _light_comparison(text) if len(text) <= LONGEST else None


def comparison_text(report: dict) -> str:
    """Return the record of a comparison's report as text."""
    picture = report["picture"]["mirror"]
    return json.dumps({
        "results": report["results"], "resolution": report["resolution"],
        "median": report["displacement_px"]["median"], "p99": report["displacement_px"]["p99"],
        "coverage": report["coverage_percent"]["all"], "psnr": picture["psnr"], "ssim": picture["ssim"],
        "flip": picture["flip"]})


def comparison(text: str) -> Comparison | None:
    """Parse the text that `comparison_text` wrote; return None for any other text."""
    return _comparison(text) if len(text) <= LONGEST else None


def counts(obj: bpy.types.Object) -> MappingProxyType:
    """Return counts of a result by name, which say how often each part of the method was used. Invalid counts are left
    out.
    """
    text = obj.reflection_mesh.counts
    return _counts(text) if len(text) <= LONGEST else NOTHING


@lru_cache(maxsize=64)
def _comparison(text: str) -> Comparison | None:
    known = _entries(text)
    size = known.get("resolution")
    if not _is_size(size):
        return None
    numbers = {name: known.get(name) for name in Comparison._fields[1:]}
    if not all(value is None or _is_number(value) for value in numbers.values()):
        return None
    # without pixels to compare there are no numbers at all
    if numbers["coverage"] is None and any(value is not None for value in numbers.values()):
        return None
    for one, other in (("median", "p99"), ("ssim", "flip")):    # pairs that occur together
        if (numbers[one] is None) != (numbers[other] is None):
            return None
    return Comparison(tuple(size), **numbers)


@lru_cache(maxsize=64)
def _light_comparison(text: str) -> LightComparison | None:
    known = _entries(text)
    size, samples = known.get("resolution"), known.get("light_samples")
    numbers = [known.get(name) for name in ("light_psnr", "own_psnr", "flux")]
    if not (_is_size(size) and _is_count(samples) and all(value is None or _is_number(value) for value in numbers)):
        return None
    return LightComparison(tuple(size), samples, *numbers)


@lru_cache(maxsize=256)
def _counts(text: str) -> MappingProxyType:
    return MappingProxyType({name: count for name, count in _entries(text).items() if _is_count(count)})


def _entries(text: str) -> dict | MappingProxyType:
    """Return the object in a JSON text; empty if there is none."""
    try:
        known = json.loads(text)
    except (ValueError, RecursionError):
        return NOTHING
    return known if isinstance(known, dict) else NOTHING


def _is_size(value) -> bool:
    return isinstance(value, list) and len(value) == 2 and all(_is_count(side) for side in value)


def _is_number(value) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < LARGEST


def _is_count(value) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and 0 <= value < LARGEST
