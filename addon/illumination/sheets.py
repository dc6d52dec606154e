"""Split receivers of light by partly transparent sheets, which let light through to the next surface.

A sheet with transparency t counts as absent for the part t of the time and as opaque for the rest. So light is computed
with and without it, and both are weighted. Several sheets are independent. Light that meets one sheet twice is
transmitted once: so a body is two sheets, its sides towards the mirror and those away from it.
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
    """Some triangles of a scene that receive light.

    Attributes
    ----------
    mesh : core.TriangleMesh
    kept : (k,) int64
        Index of each triangle in the scene.
    share : (k,) float64
        Weight of the light on each triangle.
    """

    mesh: core.TriangleMesh
    kept: np.ndarray
    share: np.ndarray

    def counted(self, lit: core.CausticMesh) -> dict:
        """Return the fields of light on this mesh, weighted and for the scene's triangles, as keyword arguments."""
        share = self.share[lit.source_face]
        return {"irradiance": lit.irradiance * share[:, None], "flux": lit.flux * share,
                "source_face": self.kept[lit.source_face]}


def receiving(scene: DiffuseScene, mirror: core.TriangleMesh) -> list[Receiving]:
    """Return the receivers of a mirror's light in a scene, with and without each sheet. Clear glass is not lit, but the
    objects behind it are.

    Raises
    ------
    core.ReflectionError
        If there are no receivers.
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
            # a sheet is lit in the cases in which it is present
            share[~own] *= part if away else 1.0 - part
        kept = np.flatnonzero(there)
        if len(kept):
            mesh = scene.mesh if there.all() else core.TriangleMesh(scene.mesh.positions, scene.mesh.triangles[kept])
            found.append(Receiving(mesh, kept, share[kept]))
    return found


def let_through(scene: DiffuseScene) -> list:
    """Return the materials of a scene that transmit a part of the light but count as opaque here."""
    through, sheet = _sheets(scene)
    parts = [transparency(material) for material in scene.materials]
    return [material for number, material in enumerate(scene.materials) if parts[number] is None
            or (0.0 < parts[number] < 1.0 and (sheet[scene.material == number] < 0).any())]


def _sheets(scene: DiffuseScene, mirror: core.TriangleMesh | None = None) -> tuple[np.ndarray, np.ndarray]:
    """Return the transparency (m,) of each triangle, and the index (m,) of its sheet, -1 for none. If a mirror is
    given, the two sides of an object are different sheets.
    """
    parts = np.array([transparency(material) or 0.0 for material in scene.materials])
    through = parts[scene.material]
    is_open = (through > 0.0) & (through < 1.0)
    sheet = np.full(len(through), -1)
    if not is_open.any():
        return through, sheet
    # use separate sheets for objects and their sides, unless these are too many
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
    """Return 1.0 (m,) for `chosen` triangles whose front faces the mirror's middle, else 0.0."""
    corners = scene.mesh.positions[scene.mesh.triangles[chosen]]
    if mirror is None:
        return np.zeros(len(corners))
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    middle = mirror.positions[mirror.triangles].mean(axis=(0, 1))
    return (np.einsum("ij,ij->i", normal, middle - corners[:, 0]) > 0.0).astype(np.float64)
