"""Lamps before mirrors and what their light may fall on, all drawn from one seed."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core import Lamp, Settings, TriangleMesh, View
from tests.fuzz.drawing.diffuse import drawn_scene
from tests.fuzz.drawing.mirrors import drawn_mirror
from tests.fuzz.drawing.placing import placed_mesh, random_rotation


@dataclass(frozen=True)
class LightConfiguration:
    """What `core.caustics` is given.

    Attributes
    ----------
    name : str
        The seed and what was drawn.
    lamp : Lamp
    mirror, receivers : TriangleMesh
    settings : Settings
    others, blockers : TriangleMesh or None
    """

    name: str
    lamp: Lamp
    mirror: TriangleMesh
    receivers: TriangleMesh
    settings: Settings
    others: TriangleMesh | None = None
    blockers: TriangleMesh | None = None

    @property
    def arguments(self) -> tuple:
        return self.lamp, self.mirror, self.receivers, self.settings, self.others, self.blockers


def drawn_light(seed: int) -> LightConfiguration:
    """The configuration of a seed, the same every time."""
    rng = np.random.default_rng((seed, 15))
    kinds, mirror = drawn_mirror(rng)
    kind, lamp, view = _lamp(rng, mirror)
    kind, lamp = _patterned((seed, 18), kind, lamp, mirror)
    parts, receivers = drawn_scene(rng, view, mirror)
    names = [str(seed), *kinds, kind, *parts]
    others = blockers = None
    if rng.random() < 0.25:
        more, other = drawn_mirror(rng)
        others = placed_mesh(other, random_rotation(rng), 0.7, rng.normal(0.0, 2.0, 3), True)
        names.append("beside a " + more[0])
    if rng.random() < 0.25:
        more, blockers = drawn_scene(rng, view, mirror)
        names.append("behind " + ", ".join(more))
    depth = int(rng.choice([1, 1, 2])) if others is not None else int(rng.choice([1, 1, 1, 1, 2]))
    settings = Settings(float(rng.choice([0.5, 0.5, 2.0])), depth=depth)
    far = float(rng.choice([0.0, 0.0, 0.0, 1e3, 1e5]))
    names += [f"depth {depth}"] * (depth > 1) + [f"at {far:g}"] * (far > 0.0)
    if far:
        lamp = lamp.moved(np.full(3, far))
        mirror, receivers, others, blockers = (
            mesh and TriangleMesh(mesh.positions + far, mesh.triangles, mesh.corner_normals)
            for mesh in (mirror, receivers, others, blockers))
    return LightConfiguration(", ".join(names), lamp, mirror, receivers, settings, others, blockers)


def _lamp(rng: np.random.Generator, mirror: TriangleMesh) -> tuple[str, Lamp, View]:
    """A lamp near, far or inside the mirror, or a sun, and a view from there at one of the mirror's corners."""
    way = rng.normal(0.0, 1.0, 3)
    way /= np.linalg.norm(way)
    target = 0.5 * mirror.positions[rng.integers(len(mirror.positions))] + rng.normal(0.0, 0.3, 3)
    if rng.random() < 0.3:
        return "sun", Lamp.shining(target - 8.0 * way - target), View.looking_at(
            target + 8.0 * way, target, (64, 64), orthographic_scale=4.0)
    distance = float(rng.choice([0.05, 0.5, 2.0, 4.0, 50.0]))
    place = distance * way + (0.0 if distance > 0.1 else mirror.positions[rng.integers(len(mirror.positions))])
    return f"lamp at {distance:g}", Lamp(place), View.looking_at(place, target, (64, 64))


def _patterned(seed: tuple[int, int], kind: str, lamp: Lamp, mirror: TriangleMesh) -> tuple[str, Lamp]:
    """Some lamps as spots and squares are, which light a cone round some place of the mirror. Drawn for itself, so that
    seeds that are kept stay what they were in all else."""
    rng = np.random.default_rng(seed)
    if lamp.sun or rng.random() < 0.5:
        return kind, lamp
    aim = rng.dirichlet((1.0, 1.0, 1.0)) @ mirror.positions[mirror.triangles[rng.integers(len(mirror.triangles))]]
    axis = (aim - lamp.place) / max(np.linalg.norm(aim - lamp.place), 1e-300)
    half = float(rng.choice([0.02, 0.1, 0.3, 0.8, 1.5]))
    place = lamp.place

    def ahead(places: np.ndarray) -> np.ndarray:
        way = places - place
        return way @ axis / np.maximum(np.linalg.norm(way, axis=-1), 1e-300)

    if rng.random() < 0.5:
        blend = max((1.0 - np.cos(half)) * float(rng.choice([0.0, 0.15, 1.0])), 1e-6)

        def spot(places: np.ndarray) -> np.ndarray:
            t = np.clip((ahead(places) - np.cos(half)) / blend, 0.0, 1.0)
            return t * t * (3.0 - 2.0 * t)
        return f"spot of {half:g}, {kind}", Lamp(place, False, spot, max(0.5 * half, 4e-3), (axis, half))

    def square(places: np.ndarray) -> np.ndarray:
        cosine = np.maximum(ahead(places), 0.0)
        tangent = np.sqrt(np.maximum(1.0 - cosine**2, 0.0)) / np.maximum(cosine, 1e-12)
        return cosine * np.maximum(1.0 - tangent / np.tan(half), 0.0)
    return f"square of {half:g}, {kind}", Lamp(place, False, square, max(0.5 * half, 4e-3), (axis, half))
