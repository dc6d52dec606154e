"""What light ends on, and what goes through what is open in part to the next surface behind it.

A sheet through which a part t of the light goes lights what is behind it as one does that is away for the part t of
the time, and opaque for the rest: so light is asked for with and without it, and the answers are weighted. Of several
sheets each has its time. What meets one sheet twice is let through once: so a body is two, its sides to the mirror and
those away from it.
"""
from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np

from ... import core
from ..reading import DiffuseScene
from ..reading.materials import transparency

ALL_CLEAR = "Light goes through all that is to be lit: select what it is to fall on, or give it the role Reflected."
MOST = 2  # sheets that light is let through: each doubles the work


@dataclass(frozen=True)
class Receiving:
    """Some of a scene's triangles, on which light ends.

    Attributes
    ----------
    mesh : core.TriangleMesh
    kept : (k,) int64
        Which of the scene's triangles it has.
    share : (k,) float64
        What part of the light on each counts.
    """

    mesh: core.TriangleMesh
    kept: np.ndarray
    share: np.ndarray

    def counted(self, lit: core.CausticMesh) -> dict:
        """What of light on this mesh is another where it counts, on the scene's triangles, as arguments."""
        share = self.share[lit.source_face]
        return {"irradiance": lit.irradiance * share[:, None], "flux": lit.flux * share,
                "source_face": self.kept[lit.source_face]}


def receiving(scene: DiffuseScene, mirror: core.TriangleMesh) -> list[Receiving]:
    """What of a scene the light of a mirror ends on, once with and once without each sheet: clear glass is not lit, and
    what lies behind it is.

    Raises
    ------
    core.ReflectionError
        Where there is no such thing.
    """
    through, sheet = _sheets(scene, mirror)
    lit = through < 1.0
    if not lit.any():
        raise core.ReflectionError(ALL_CLEAR)
    found = []
    for removed in product((False, True), repeat=int(sheet.max()) + 1):
        there = lit.copy()
        share = np.ones(len(lit))
        for number, away in enumerate(removed):
            own = sheet == number
            part = through[own][0]
            there[own] &= not away
            # its own light it has from the times when it is there
            share[~own] *= part if away else 1.0 - part
        kept = np.flatnonzero(there)
        if len(kept):
            mesh = scene.mesh if there.all() else core.TriangleMesh(scene.mesh.positions, scene.mesh.triangles[kept])
            found.append(Receiving(mesh, kept, share[kept]))
    return found


def let_through(scene: DiffuseScene) -> list:
    """Materials of a scene that let a part of the light through and at which it ends here all the same."""
    through, sheet = _sheets(scene)
    parts = [transparency(material) for material in scene.materials]
    return [material for number, material in enumerate(scene.materials) if parts[number] is None
            or (0.0 < parts[number] < 1.0 and (sheet[scene.material == number] < 0).any())]


def _sheets(scene: DiffuseScene, mirror: core.TriangleMesh | None = None) -> tuple[np.ndarray, np.ndarray]:
    """What part of the light goes through each triangle (m,), and which sheet it is of, of those that have sides to a
    mirror where one is told; -1 for what is of none."""
    parts = np.array([transparency(material) or 0.0 for material in scene.materials])
    through = parts[scene.material]
    is_open = (through > 0.0) & (through < 1.0)
    sheet = np.full(len(through), -1)
    if not is_open.any():
        return through, sheet
    # objects, and their sides, are sheets of their own until there are too many
    keys = [scene.source_object[is_open], through[is_open]]
    for key in ([_facing(scene, mirror, is_open), *keys], keys, keys[1:]):
        _, number = np.unique(np.stack(key), axis=1, return_inverse=True)
        sheet[is_open] = number.reshape(-1)
        count = int(sheet.max()) + 1
        if count <= MOST:
            return through, sheet
    largest = np.argsort(-np.bincount(sheet[is_open]), kind="stable")[:MOST]
    number = np.full(count, -1)
    number[largest] = np.arange(MOST)
    sheet[is_open] = number[sheet[is_open]]
    return np.where(is_open & (sheet < 0), 0.0, through), sheet


def _facing(scene: DiffuseScene, mirror: core.TriangleMesh | None, chosen: np.ndarray) -> np.ndarray:
    """Whether the fronts of the triangles that are `chosen` (m,) look to a mirror's middle."""
    corners = scene.mesh.positions[scene.mesh.triangles[chosen]]
    if mirror is None:
        return np.zeros(len(corners))
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    middle = mirror.positions[mirror.triangles].mean(axis=(0, 1))
    return (np.einsum("ij,ij->i", normal, middle - corners[:, 0]) > 0.0).astype(np.float64)
