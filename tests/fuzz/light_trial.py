"""One lamp and its mirror tried: the light that the mirror throws is finite, all there, and where rays bring it."""
from __future__ import annotations

import traceback
import warnings
from collections.abc import Iterator

import numpy as np

from core import CausticMesh, ReflectionError, caustics
from core.rivals.tracing import LightRays
from tests.fuzz.drawing.lights import LightConfiguration, drawn_light
from tests.fuzz.limits import TooLong, at_most
from tests.fuzz.reflecting import SENTENCE

SECONDS = 20.0  # of processor time
RAYS, MORE, THROWS = 5_000, 60_000, 6  # of a throw; of one that decides; throws, whose differences are the noise
SHARE, LEAST = 0.004, 1e-4  # of the light that arrives, and of all that the mirror is sent: more must not be wrong
HALF = 0.5  # pixels: the tolerance for which that holds; a larger one leaves as much wider strips along outlines open
NOISE = 8.0  # times the standard error of the throws
PLACES = 256  # on each triangle of a mirror, at which a lamp's pattern is asked
EXACT = 1e-6  # of the light: by how much irradiance may miss the flux
SINGLE = 0.02  # of all that the mirror is sent: by how much it may be more where places are single precision
ON_SOURCE = 1e-6  # of all that is there
BESIDE = 1e-2  # of the mirror: half a pixel of the lamp's picture, and many times more where it is seen at an angle
TOLD = ("missed", "bounded", "crowded", "limited")  # counts of what a mesh may lack


def tried_light(seed: int) -> dict:
    """What the configuration of a seed is called, and all that is wrong, each "what: how"."""
    configuration = drawn_light(seed)
    return {"name": configuration.name, "problems": light_problems(configuration)}


def light_problems(configuration: LightConfiguration) -> list[str]:
    """All that is wrong with what `core.caustics` makes of a configuration."""
    mesh, refusal = None, ""
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always")
        try:
            with at_most(SECONDS):
                mesh = caustics(*configuration.arguments)
        except ReflectionError as error:
            refusal = str(error)
        except TooLong:
            return [f"time: more than {SECONDS:g} s"]
        except Exception as error:
            place = traceback.extract_tb(error.__traceback__)[-1]
            return [f"error: {type(error).__name__}: {error} ({place.filename}:{place.lineno})"]
    found = sorted({f"warning: {one.message} ({one.filename}:{one.lineno})" for one in heard})
    if mesh is None:
        if not SENTENCE.fullmatch(refusal):
            found.append(f"refusal: not one sentence: {refusal!r}")
        if "lies on the mirror" in refusal:
            return found
        return found + list(_missed(configuration, np.zeros(len(configuration.receivers.triangles)), 0))
    return found + checked_light(configuration, mesh)


def checked_light(configuration: LightConfiguration, mesh: CausticMesh) -> list[str]:
    """What does not hold in one mesh of light; no more than numbers and indices where those are none."""
    wrong = list(_numbers(configuration, mesh))
    if wrong:
        return wrong
    flux = np.bincount(mesh.source_face, mesh.flux, minlength=len(configuration.receivers.triangles))
    told = sum(mesh.counts.get(name, 0) for name in TOLD)
    return [*_energy(configuration, mesh), *_places(configuration, mesh), *_missed(configuration, flux, told)]


def _numbers(configuration: LightConfiguration, mesh: CausticMesh) -> Iterator[str]:
    count, vertices, most = len(mesh.triangles), len(mesh.positions), mesh.met.shape[1]
    shapes = {"positions": (vertices, 3), "mirror_position": (vertices, 3), "image_parity": (vertices,),
              "triangles": (count, 3), "irradiance": (count, 3), "flux": (count,), "met": (count, most),
              "cosine": (count, 3, most),
              "direction": (count, 3, 3), "source_face": (count,), "source_weights": (count, 3, 3), "bounces": (count,)}
    for name, shape in shapes.items():
        values = getattr(mesh, name)
        if values.shape != shape:
            yield f"lengths: {name} has the shape {values.shape}, not {shape}"
        elif not np.isfinite(values).all():
            yield f"finite: {name} holds {np.count_nonzero(~np.isfinite(values))} numbers that are none"
    if not count:
        yield "lengths: it shows nothing, and nothing says so"
    mirrors = [one for one in (configuration.mirror, configuration.others) if one is not None]
    bounds = {"triangles": (0, vertices - 1), "met": (-1, sum(len(one.triangles) for one in mirrors) - 1),
              "irradiance": (0.0, np.inf), "flux": (0.0, np.inf), "cosine": (-1.0, 1.0),
              "direction": (-1.0 - 1e-12, 1.0 + 1e-12),
              "source_face": (0, len(configuration.receivers.triangles) - 1), "source_weights": (0.0, 1.0 + 1e-9),
              "bounces": (1, configuration.settings.depth), "image_parity": (-1, 1)}
    for name, (low, high) in bounds.items():
        values = getattr(mesh, name)
        if values.size and not (values.min() >= low and values.max() <= high):
            yield f"ranges: {name} reaches from {values.min()} to {values.max()}"
    if ((mesh.met >= 0) != (np.arange(most) < mesh.bounces[:, None])).any():
        yield "met: not as many mirrors as bounces"


def _energy(configuration: LightConfiguration, mesh: CausticMesh) -> Iterator[str]:
    """Irradiance amounts to the flux, where places are single precision too."""
    # far from the origin places have lost digits of the areas
    if not np.abs(configuration.mirror.positions).max() > 100.0:
        received = (_areas(mesh.positions, mesh) * mesh.irradiance.mean(axis=1)).sum()
        if abs(received / mesh.flux.sum() - 1.0) > EXACT:
            yield f"energy: the irradiance amounts to {received / mesh.flux.sum():.6f} of the flux"
    middle = 0.5 * (mesh.positions.min(axis=0) + mesh.positions.max(axis=0))
    single = (mesh.positions - middle).astype(np.float32).astype(np.float64)
    received = (_areas(single, mesh) * mesh.irradiance.mean(axis=1)).sum()
    # places at random may all miss a narrow lamp's cone, and what arrives has been sent
    if received > mesh.flux.sum() + SINGLE * max(sent_light(configuration), mesh.flux.sum()):
        yield f"single: the irradiance amounts to {received / mesh.flux.sum():.3f} of the flux in single precision"


def _places(configuration: LightConfiguration, mesh: CausticMesh) -> Iterator[str]:
    """Corners lie where their weights say, and their light comes from the triangle of the mirror that is told."""
    receivers = configuration.receivers
    corners = receivers.positions[receivers.triangles[mesh.source_face]]
    astray = np.abs(np.matmul(mesh.source_weights, corners) - mesh.positions[mesh.triangles]).max()
    size = max(np.ptp(one.positions, axis=0).max() for one in (configuration.mirror, receivers))
    # and where rounding far from the origin puts them
    if astray > ON_SOURCE * size + 1e-13 * np.abs(receivers.positions).max():
        yield f"source: corners lie up to {astray:.2g} off their source"
    mirror, places = configuration.mirror, mesh.mirror_position[mesh.triangles]
    astray = _away(mirror.positions[mirror.triangles[mesh.met[:, 0]]], places).max()
    if astray > BESIDE * np.ptp(mirror.positions, axis=0).max() + 1e-13 * np.abs(mirror.positions).max():
        yield f"mirror: light comes from up to {astray:.2g} off the triangle that is told"


def _away(corners: np.ndarray, places: np.ndarray) -> np.ndarray:
    """How far (m, 3) places (m, 3, 3) are from triangles with `corners` (m, 3, 3)."""
    corners = corners[:, :, None]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal = normal / np.maximum(np.linalg.norm(normal, axis=2, keepdims=True), 1e-300)
    above, inside, away = np.abs(((places - corners[:, 0]) * normal).sum(axis=2)), np.True_, np.inf
    for start, end in ((0, 1), (1, 2), (2, 0)):
        start, side = corners[:, start], corners[:, end] - corners[:, start]
        along = ((places - start) * side).sum(axis=2) / np.maximum((side**2).sum(axis=2), 1e-300)
        nearest = start + np.clip(along, 0.0, 1.0)[:, :, None] * side
        away = np.minimum(away, np.linalg.norm(places - nearest, axis=2))
        inside = inside & ((np.cross(side, places - start) * normal).sum(axis=2) >= 0.0)
    return np.where(inside, above, away)


def _missed(configuration: LightConfiguration, flux: np.ndarray, told: int) -> Iterator[str]:
    """The light on each triangle is that of rays to their noise: none is lost, and nothing is lit that is hidden. The
    light of rays that smooth normals would send into the mirror is left out."""
    # few rays say nothing of a narrow cone
    if configuration.lamp.pattern is not None or _as_rays(configuration, flux, told, RAYS) is not None:
        wrong = _as_rays(configuration, flux, told, MORE)
        if wrong is not None:
            yield wrong


def _as_rays(configuration: LightConfiguration, flux: np.ndarray, told: int, count: int) -> str | None:
    one = configuration
    rays = LightRays(one.mirror, one.receivers, one.others, one.blockers)
    thrown = [rays.thrown(one.lamp, count, seed, one.settings.depth) for seed in range(THROWS)]
    watts = [light.flux * one.lamp.share(light.start) for light in thrown]
    landed = np.array([np.bincount(light.source_face, each, minlength=len(flux)) for light, each in zip(thrown, watts)])
    bent = np.mean([each[light.bent].sum() for light, each in zip(thrown, watts)])
    mean, noise = landed.mean(axis=0), landed.std(axis=0, ddof=1) / np.sqrt(THROWS)
    whole, least = landed.sum(axis=1), LEAST * max(one.settings.tolerance / HALF, 1.0) * sent_light(one) + bent
    # what a mesh tells of may be missing
    share = SHARE * (10.0 if told else 1.0)
    off = flux.sum() - mean.sum()
    if abs(off) > NOISE * whole.std(ddof=1) / np.sqrt(THROWS) + share * mean.sum() + least:
        return f"flux: {flux.sum():.6g}, by rays {mean.sum():.6g}"
    astray = np.abs(flux - mean) - (NOISE * noise + share * mean.sum() + least)
    worst = int(np.argmax(astray))
    return f"light: on triangle {worst} {flux[worst]:.6g}, by rays {mean[worst]:.6g}" if astray[worst] > 0.0 else None


def sent_light(configuration: LightConfiguration) -> float:
    """About what light the lamp sends towards the mirror."""
    a, b, c = np.moveaxis(configuration.mirror.positions[configuration.mirror.triangles], 1, 0)
    normal, lamp = 0.5 * np.cross(b - a, c - a), configuration.lamp
    inner = np.full((1, 1, 3), 1.0 / 3.0)
    if lamp.pattern is not None:
        inner = np.random.default_rng(0).dirichlet((1.0, 1.0, 1.0), (PLACES, 1))
    places = inner[..., :1] * a + inner[..., 1:2] * b + inner[..., 2:] * c
    way = lamp.directions(places.reshape(-1, 3)).reshape(places.shape)
    length = np.maximum(np.linalg.norm(way, axis=2), 1e-300)
    squared = 1.0 if lamp.sun else np.maximum(length**2, np.linalg.norm(normal, axis=1))
    return float((np.abs((normal * way).sum(axis=2)) / length / squared * lamp.share(places)).mean(axis=0).sum())


def _areas(positions: np.ndarray, mesh: CausticMesh) -> np.ndarray:
    a, b, c = np.moveaxis(positions[mesh.triangles], 1, 0)
    return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
