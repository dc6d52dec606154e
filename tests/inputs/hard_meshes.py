"""Meshes with every defect that Blender can hold, and eyes in every awkward place, put together from names.

A case is a handful of names and numbers: hypothesis draws them, seeded generators draw them, and what either finds is
written down as the names again.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core import TriangleMesh, View
from tests.inputs import shapes


def _fan(rng):
    """Seven triangles round one edge."""
    angles = rng.uniform(0.0, 2.0 * np.pi, 7)
    rim = np.stack([np.cos(angles), np.sin(angles), rng.uniform(-0.5, 0.5, 7)], axis=1)
    return np.concatenate([[[0, 0, -1.0], [0, 0, 1.0]], rim]), np.array([[0, 1, 2 + k] for k in range(7)])


def _soup(rng):
    """Triangles anywhere, on few coordinates so that many coincide, touch and lie in one plane."""
    count = rng.integers(3, 9)
    positions = rng.integers(-2, 3, (count, 3)) / 2.0
    return positions, rng.integers(0, count, (rng.integers(1, 9), 3))


def _star(rng):
    """A face with ten corners that crosses itself, cut into a fan as it comes."""
    angles = np.arange(10) * 2.0 * np.pi * 3 / 10
    radius = np.where(np.arange(10) % 2, 1.0, 0.4)
    positions = np.stack([radius * np.cos(angles), radius * np.sin(angles), np.zeros(10)], axis=1)
    return positions[:, [0, 2, 1]], np.array([[0, k, k + 1] for k in range(1, 9)])


def _slivers(rng):
    """Triangles with an aspect up to 1e8."""
    start = rng.uniform(-1.0, 1.0, (6, 3))
    way = rng.normal(size=(6, 3))
    wide = 10.0 ** rng.uniform(-8.0, -1.0, (6, 1)) * rng.normal(size=(6, 3))
    positions = np.stack([start, start + way, start + rng.uniform(0, 1, (6, 1)) * way + wide], axis=1).reshape(-1, 3)
    return positions, np.arange(18).reshape(-1, 3)


def _plain(surface):
    return lambda rng: surface[:2]


SHAPES = {
    "quad": _plain(shapes.quad((0, 0, 0), (1, 0, 0), (0, 0, 1))),
    "turned quad": _plain(shapes.quad((0, 0, 0), (0.9, 0.3, 0.1), (-0.1, 0.2, 0.9))),
    "box": _plain(shapes.box((0, 0, 0), (1.5, 1.5, 1.5))),
    "ball": _plain(shapes.icosphere((0, 0, 0), 1.0, 1)),
    "bowl": _plain(shapes.bowl((0, 0, 0), 1.0, 1.2, 8, 3)),
    "cylinder": _plain(shapes.cylinder((0, 0, 0), 0.7, 1.6, 8)),
    "triangle": lambda rng: (rng.uniform(-1, 1, (3, 3)), np.array([[0, 1, 2]])),
    "fan": _fan,
    "soup": _soup,
    "star": _star,
    "slivers": _slivers,
    "nothing": lambda rng: (np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64)),
}


def _doubled_vertices(rng, positions, triangles):
    """Every triangle with vertices of its own, at the same places."""
    return positions[triangles].reshape(-1, 3), np.arange(3 * len(triangles)).reshape(-1, 3)


def _nearly_doubled_vertices(rng, positions, triangles):
    """The same, a rounding apart."""
    own, faces = _doubled_vertices(rng, positions, triangles)
    return own * (1.0 + 1e-15 * rng.integers(-3, 4, own.shape)), faces


def _loose(rng, positions, triangles):
    """Vertices and edges that belong to no face; some are no numbers."""
    loose = np.concatenate([rng.uniform(-9, 9, (4, 3)), [[np.nan, 0, 0], [np.inf, 1, 1]]])
    return np.concatenate([positions, loose]), triangles


def _without_area(rng, positions, triangles):
    """Faces on one point, on two, and on a line."""
    a, b, c = triangles[0]
    middle = 0.5 * (positions[a] + positions[b])
    count = len(positions)
    flat = [[a, a, a], [a, b, a], [a, count, b]]
    return np.concatenate([positions, [middle]]), np.concatenate([flat[:2], triangles, flat[2:]])


def _nearly_without_area(rng, positions, triangles):
    """Faces a rounding away from a line, or smaller than anything beside them."""
    a, b, _ = triangles[0]
    count = len(positions)
    more = np.stack([0.5 * (positions[a] + positions[b]) + 1e-16 * rng.normal(size=3),
                     positions[a] + 1e-9 * rng.normal(size=3), positions[a] + 1e-9 * rng.normal(size=3),
                     positions[b] + 1e-160 * rng.normal(size=3)])
    return (np.concatenate([positions, more]),
            np.concatenate([triangles, [[a, b, count], [a, count + 1, count + 2], [a, b, count + 3]]]))


def _doubled_faces(rng, positions, triangles):
    """Faces twice, once the other way round."""
    return positions, np.concatenate([triangles, triangles[:3], triangles[:5, ::-1]])


def _mixed_winding(rng, positions, triangles):
    turned = rng.random(len(triangles)) < 0.5
    return positions, np.where(turned[:, None], triangles[:, ::-1], triangles)


def _inside_out(rng, positions, triangles):
    return positions, triangles[:, ::-1]


def _with_fan(rng, positions, triangles):
    """More faces at one edge."""
    a, b, _ = triangles[0]
    count = len(positions)
    tops = positions[a] + rng.uniform(-1, 1, (3, 3))
    return np.concatenate([positions, tops]), np.concatenate([triangles, [[a, b, count + k] for k in range(3)]])


def _with_specks(rng, positions, triangles):
    """Itself again, a million times smaller, on its first corner."""
    return (np.concatenate([positions, positions[triangles[0, 0]] + 1e-6 * positions]),
            np.concatenate([triangles, triangles + len(positions)]))


def _with_plane(rng, positions, triangles):
    """A triangle a million times larger through its first corner."""
    corner = positions[triangles[0, 0]]
    return (np.concatenate([positions, corner + 1e6 * rng.uniform(-1, 1, (3, 3))]),
            np.concatenate([triangles, [len(positions) + np.arange(3)]]))


def _holes(rng, positions, triangles):
    kept = rng.random(len(triangles)) < 0.6
    kept[0] = True
    return positions, triangles[kept]


def _shuffled(rng, positions, triangles):
    order, place = rng.permutation(len(triangles)), rng.permutation(len(positions))
    moved = np.empty_like(positions)
    moved[place] = positions
    return moved, place[triangles[order]]


def _crumpled(rng, positions, triangles):
    return positions + 0.3 * rng.normal(size=positions.shape), triangles


def _flattened(rng, positions, triangles):
    """All in one plane."""
    return positions * [1.0, 0.0, 1.0], triangles


DEFECTS = {
    "doubled vertices": _doubled_vertices, "nearly doubled vertices": _nearly_doubled_vertices, "loose": _loose,
    "without area": _without_area, "nearly without area": _nearly_without_area, "doubled faces": _doubled_faces,
    "mixed winding": _mixed_winding, "inside out": _inside_out, "fan": _with_fan, "specks": _with_specks,
    "plane": _with_plane, "holes": _holes, "shuffled": _shuffled, "crumpled": _crumpled, "flattened": _flattened,
}


def _smooth(rng, mesh):
    """Averaged over the faces round each vertex, as Blender shades smooth."""
    normals = np.zeros_like(mesh.positions)
    np.add.at(normals, mesh.triangles.ravel(), np.repeat(mesh.face_normals(), 3, axis=0))
    return normals[mesh.triangles]


def _bent(rng, mesh):
    """Turned to where faces look along them or against them."""
    normals = mesh.corner_normals.copy()
    corners = mesh.positions[mesh.triangles]
    way = corners - np.roll(corners, 1, axis=1)
    return np.where(rng.random((*normals.shape[:2], 1)) < 0.5, way, -normals)


NORMALS = {
    "flat": lambda rng, mesh: None,
    "smooth": _smooth,
    "zero": lambda rng, mesh: np.zeros_like(mesh.corner_normals),
    "random": lambda rng, mesh: rng.normal(size=mesh.corner_normals.shape),
    "opposite": lambda rng, mesh: mesh.corner_normals * rng.choice([-1.0, 1.0], (*mesh.corner_normals.shape[:2], 1)),
    "turned round": lambda rng, mesh: -_smooth(rng, mesh),
    "sideways": lambda rng, mesh: np.broadcast_to([1.0, 0.0, 0.0], mesh.corner_normals.shape),
    "tiny": lambda rng, mesh: 1e-200 * _smooth(rng, mesh),
    "bent": _bent,
}

PLACES = {
    # where the scene is and how large, beside a mirror of about unit size at the origin that the eye sees from -Y
    "before": ((0.3, -1.9, 0.1), 0.6), "behind": ((0.2, 3.0, 0.0), 1.0), "through": ((0.2, 0.1, 0.3), 1.3),
    "same": ((0.0, 0.0, 0.0), 1.0), "around": ((0.0, 0.0, 0.0), 12.0), "huge": ((0.0, -1.0, 0.0), 1e6),
    "speck": ((0.1, -1.2, 0.1), 1e-6), "touching": ((0.0, -1.0, 0.0), 1.0), "behind the eye": ((0.0, -9.0, 0.0), 2.0),
    "at the eye": ((0.0, -5.0, 0.5), 0.8),
}

EYES = {
    # position, target, field of view, width where orthographic
    "plain": ((0.3, -5.0, 0.5), (0.0, 0.0, 0.0), 0.6, 0.0),
    "orthographic": ((0.3, -5.0, 0.5), (0.0, 0.0, 0.0), 0.6, 3.0),
    "inside": ((0.1, -0.05, 0.02), (0.0, 1.0, 0.1), 1.5, 0.0),
    "edge on": ((0.0, -5.0, 1.0), (0.0, 0.0, 1.0), 0.6, 0.0),
    "edge on orthographic": ((0.0, 0.0, 5.0), (0.0, 0.0, 0.0), 0.6, 3.0),
    "above": ((0.0, 0.0, 5.0), (0.0, 0.0, 0.0), 0.6, 0.0),
    "on": ((0.2, 0.0, 0.1), (0.0, 1.0, 0.1), 1.0, 0.0),
    "all but on": ((0.2, -1e-7, 0.1), (0.3, 1.0, 0.1), 1.0, 0.0),
    "on a corner": ((1.0, 0.0, 1.0), (0.0, 0.1, 0.0), 1.0, 0.0),
    "wide": ((0.3, -1.5, 0.2), (0.0, 0.0, 0.0), 3.14, 0.0),
    "narrow": ((0.3, -5.0, 0.5), (0.1, 0.0, 0.1), 1e-5, 0.0),
    "far": ((3e3, -1e6, 5e2), (0.0, 0.0, 0.0), 2e-6, 0.0),
    "grazing": ((0.0, -5.0, 1.0 + 1e-9), (0.0, 0.0, 1.0), 0.5, 0.0),
    "diagonal": ((3.0, -3.0, 3.0), (0.0, 0.0, 0.0), 0.7, 0.0),
    "wide orthographic": ((0.3, -5.0, 0.5), (0.0, 0.0, 0.0), 0.6, 1e6),
    "turned away": ((0.3, -5.0, 0.5), (0.0, -9.0, 0.0), 1.0, 0.0),
}

RESOLUTIONS = ((48, 32), (1, 1), (96, 2), (3, 120))
UNITS = (1.0, 1e-6, 1e6, 2.0 ** -20, 1e-12, 1e12)
HERE = 1.0, (0.0, 0.0, 0.0)
OFFSETS = ((0.0, 0.0, 0.0), (1e6, -7e5, 3e5), (0.0, 1e3, 0.0))


def mesh(shape: str, defects: tuple[str, ...] = (), normals: str = "flat", seed: int = 0, place: str = "same",
         where: tuple = HERE) -> TriangleMesh:
    """The shape with the defects, one after another, in the unit and about the place of `where`."""
    unit, offset = where
    rng = np.random.default_rng(seed)
    positions, triangles = SHAPES[shape](rng)
    for defect in defects if len(triangles) else ():
        positions, triangles = DEFECTS[defect](rng, positions, triangles)
    centre, size = PLACES[place]
    positions = (positions * size + np.asarray(centre)) * unit + np.asarray(offset)
    plain = TriangleMesh(positions, triangles)
    return TriangleMesh(positions, triangles, NORMALS[normals](rng, plain) if len(triangles) else None)


def view(eye: str, resolution: tuple[int, int] = (48, 32), where: tuple = HERE) -> View:
    unit, offset = where
    position, target, field_of_view, width = EYES[eye]
    return View.looking_at(np.asarray(position) * unit + offset, np.asarray(target) * unit + offset, resolution,
                           field_of_view=field_of_view, orthographic_scale=width * unit)


@dataclass(frozen=True)
class Case:
    """The names of a mirror, a scene and an eye."""

    mirror: str = "quad"
    mirror_defects: tuple[str, ...] = ()
    normals: str = "flat"
    scene: str = "box"
    scene_defects: tuple[str, ...] = ()
    place: str = "before"
    eye: str = "plain"
    resolution: tuple[int, int] = (48, 32)
    unit: float = 1.0
    offset: tuple[float, float, float] = (0.0, 0.0, 0.0)
    seed: int = 0

    def built(self) -> tuple[View, TriangleMesh, TriangleMesh]:
        where = self.unit, self.offset
        mirror = mesh(self.mirror, self.mirror_defects, self.normals, self.seed, where=where)
        return (view(self.eye, self.resolution, where), mirror,
                mesh(self.scene, self.scene_defects, "flat", self.seed + (self.place != "same"), self.place, where))

    @staticmethod
    def fields() -> dict:
        """What each name is drawn from; those of defects are drawn several times."""
        return {"mirror": list(SHAPES), "mirror_defects": list(DEFECTS), "normals": list(NORMALS),
                "scene": list(SHAPES), "scene_defects": list(DEFECTS), "place": list(PLACES), "eye": list(EYES),
                "resolution": list(RESOLUTIONS), "unit": list(UNITS), "offset": list(OFFSETS),
                "seed": list(range(1000))}

    @classmethod
    def drawn(cls, rng: np.random.Generator) -> Case:
        """A case at random; what is ordinary, listed first, comes more often than the rest of a list."""
        names = {}
        for name, choices in cls.fields().items():
            if name.endswith("defects"):
                names[name] = tuple(choices[k] for k in rng.integers(0, len(choices), rng.integers(0, 4)))
            elif name in ("unit", "offset", "resolution", "eye", "normals") and rng.random() < 0.5:
                names[name] = choices[0]
            else:
                names[name] = choices[rng.integers(len(choices))]
        return cls(**names)
