"""Configurations: a view, a mirror, a diffuse scene and settings, all drawn from one seed."""
from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from core import PLACEMENTS, Settings, TriangleMesh, View
from tests.fuzz.drawing.diffuse import drawn_scene
from tests.fuzz.drawing.mirrors import drawn_mirror
from tests.fuzz.drawing.placing import placed_mesh, placed_view, random_rotation

RESOLUTIONS = ((64, 64), (128, 96), (200, 200), (30, 120))


@dataclass(frozen=True)
class Configuration:
    """What `core.reflect` is given.

    Attributes
    ----------
    name : str
        The seed, or what a kept example is called, and what was drawn.
    view : View
    mirror, scene : TriangleMesh
    settings : Settings
    flat : bool
        The mirror was made without corner normals.
    others : TriangleMesh or None
        Other mirrors, which may be seen in this one.
    """

    name: str
    view: View
    mirror: TriangleMesh
    scene: TriangleMesh
    settings: Settings
    flat: bool = False
    others: TriangleMesh | None = None

    @property
    def mirrors(self) -> TriangleMesh:
        """All mirrors, the one that is looked into first."""
        return self.mirror if self.others is None else TriangleMesh.joined([self.mirror, self.others])

    @property
    def size(self) -> float:
        """The largest extent of all that is there, in scene units."""
        meshes = (self.mirrors, self.scene)
        used = np.concatenate([mesh.positions[mesh.triangles.ravel()] for mesh in meshes])
        return float(np.ptp(used, axis=0).max())

    def placed(self, rotation: np.ndarray, scale: float, offset: np.ndarray) -> Configuration:
        """The same picture of everything turned, then scaled, then moved."""
        others = self.others
        return replace(
            self, view=placed_view(self.view, rotation, scale, offset),
            mirror=placed_mesh(self.mirror, rotation, scale, offset, not self.flat),
            scene=placed_mesh(self.scene, rotation, scale, offset, False),
            others=others if others is None else placed_mesh(others, rotation, scale, offset, True))


def drawn_view(rng: np.random.Generator, mirror: TriangleMesh) -> tuple[list[str], View]:
    """An eye near, far or inside the mirror, which looks at one of its corners or beside it."""
    direction = rng.normal(0.0, 1.0, 3)
    eye = direction / np.linalg.norm(direction) * rng.choice([0.5, 2.0, 4.0, 8.0])
    target = 0.5 * mirror.positions[rng.integers(len(mirror.positions))] + rng.normal(0.0, 0.3, 3)
    orthographic = rng.random() < 0.2
    view = View.looking_at(
        eye, target, RESOLUTIONS[rng.integers(len(RESOLUTIONS))], up=rng.normal(0.0, 1.0, 3),
        field_of_view=float(rng.choice([0.3, 0.7, 1.5, 2.8])),
        orthographic_scale=float(rng.choice([2.0, 5.0])) if orthographic else 0.0)
    return ["orthographic"] if orthographic else [], view


def drawn_settings(rng: np.random.Generator) -> Settings:
    method = str(rng.choice(["GENERAL", "PARALLEL", "POINTS"], p=[0.6, 0.2, 0.2]))
    depth = 2 if method != "POINTS" and rng.random() < 0.25 else 1
    return Settings(float(rng.choice([0.2, 0.5, 2.0])), str(rng.choice(PLACEMENTS)), method, depth)


def drawn(seed: int) -> Configuration:
    """The configuration of a seed, the same every time."""
    rng = np.random.default_rng(seed)
    kinds, mirror = drawn_mirror(rng)
    eye, view = drawn_view(rng, mirror)
    parts, scene = drawn_scene(rng, view, mirror)
    settings, others, more = drawn_settings(rng), None, []
    if rng.random() < 0.2:
        more, other = drawn_mirror(rng)
        others = placed_mesh(other, random_rotation(rng), 0.7, rng.normal(0.0, 2.0, 3), True)
        more = ["beside a " + more[0]]
    name = ", ".join([str(seed), *kinds, *more, *eye, *parts, settings.method, settings.placement,
                      f"{settings.tolerance:g} px", f"depth {settings.depth}"])
    return Configuration(name, view, mirror, scene, settings, kinds[1] == "flat", others)
