"""The arrays of the last reflection, for the next one."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import bpy
import numpy as np

from ...core import PointTree, SceneTree, Standing, TriangleMesh
from ..reading import (
    Assembly,
    DiffuseScene,
    LocalMesh,
    MirrorSurface,
    Placed,
    join_mirror,
    join_scene,
    read_meshes,
)
from ..reading.materials import which_reflect
from .told import listen, trusted


@dataclass(frozen=True)
class Stage:
    """The input arrays of a generation; they are never modified.

    Attributes
    ----------
    scene : DiffuseScene
    surfaces : list of MirrorSurface
        One for each mirror; the parts of an assembly are one.
    mirrors : core.TriangleMesh
        All mirrors joined.
    trees : dict
        Trees of the scene, by type.
    """

    scene: DiffuseScene
    surfaces: list[MirrorSurface]
    mirrors: TriangleMesh
    trees: dict[type, SceneTree | PointTree] = field(default_factory=dict)
    _built: dict[type, Standing] = field(default_factory=dict)

    def has(self, kind: type) -> bool:
        """Return True if the tree of that type has been built."""
        return kind in self.trees

    def built(self, kind: type[SceneTree] | type[PointTree]) -> Standing:
        """Return the scene and the mirrors with a tree of that type, which is built once."""
        if kind not in self.trees:
            self.trees[kind] = kind.build(self.scene.mesh)
        if kind not in self._built:
            self._built[kind] = Standing.of(self.trees[kind], self.mirrors)
        return self._built[kind]


@dataclass
class Kept:
    """The contents of one depsgraph when it was read last.

    A mesh is kept until its object, its instancer or its data are reported as changed, or its materials differ.
    Transforms and participants are read anew each time. Everything made of meshes is kept while the meshes and their
    transforms are the same.

    Attributes
    ----------
    depsgraph : tuple
        Identifies the depsgraph.
    meshes : dict
        Meshes by owner and request, with the `session_uid` of everything that they depend on.
    surfaces : dict
        By the `session_uid` of mirrors: placed meshes, reflecting materials, and the surface.
    placed : list of Placed
        The placed meshes of the diffuse scene.
    stage : Stage or None
    """

    depsgraph: tuple = ()
    meshes: dict[tuple, tuple[LocalMesh, frozenset]] = field(default_factory=dict)
    surfaces: dict[int, tuple[list[Placed], list[bool], MirrorSurface]] = field(default_factory=dict)
    placed: list[Placed] = field(default_factory=list)
    stage: Stage | None = None

    @staticmethod
    def of(depsgraph: bpy.types.Depsgraph) -> Kept:
        """Return the cache for an evaluated depsgraph. It is empty if the depsgraph was not the last one read, or if
        its reports of changes cannot be trusted.
        """
        name = depsgraph.as_pointer(), depsgraph.scene.original.session_uid, depsgraph.view_layer.name
        trust = trusted(depsgraph)
        if not trust or _last.depsgraph != name:
            _forget(None)
        _last.depsgraph = name
        return _last if trust else Kept()

    def read(self, depsgraph: bpy.types.Depsgraph, mirrors: list[Assembly], diffuse: list) -> Stage:
        """Return the mirrors and the diffuse objects. Read what is new, and release what does not take part any more.

        Raises
        ------
        ReflectionError
        """
        return self.joined(mirrors, diffuse, *self.looked_at(depsgraph, mirrors, diffuse))

    def looked_at(self, depsgraph: bpy.types.Depsgraph, mirrors: list[Assembly],
                  diffuse: list) -> tuple[list[list[Placed]], list[Placed]]:
        """Read the placed meshes of each mirror, and those of the diffuse objects. Blender's data is not needed
        afterwards.
        """
        used: dict[tuple, tuple[LocalMesh, frozenset]] = {}

        def known(name: tuple, depends: frozenset, read: Callable[[], LocalMesh | None]) -> LocalMesh | None:
            there = used.get(name) or self.meshes.get(name)
            mesh = read() if there is None else there[0]
            if mesh is not None:
                used[name] = mesh, depends
            return mesh
        found = [read_meshes(depsgraph, mirror.parts, True, known) for mirror in mirrors]
        placed = read_meshes(depsgraph, diffuse, False, known)
        self.meshes = used
        return found, placed

    def joined(self, mirrors: list[Assembly], diffuse: list, of_mirrors: list[list[Placed]],
               placed: list[Placed]) -> Stage:
        """Join the placed meshes from `looked_at` into the result of `read`."""
        surfaces = {one.mirror.session_uid: self._surface(one, own) for one, own in zip(mirrors, of_mirrors)}
        self.surfaces = surfaces
        before, own = self.stage, [surface for *_, surface in surfaces.values()]
        same = before is not None and list(map(id, own)) == list(map(id, before.surfaces))
        together = before.mirrors if same else TriangleMesh.joined([surface.mesh for surface in own])
        if before is not None and not (before.scene.sources == diffuse and _same(placed, self.placed)):
            # release the old arrays before the new ones are made
            before = self.stage = None
        if before is None:
            self.placed, self.stage = placed, Stage(join_scene(placed, diffuse), own, together)
        elif not same:
            self.stage = Stage(before.scene, own, together, before.trees)
        return self.stage

    def within(self, gigabytes: float) -> None:
        """Release everything if it takes more than `gigabytes`."""
        if self is _last and held_bytes(self) > 1e9 * gigabytes:
            _forget(None)

    def _surface(self, mirror: Assembly, placed: list[Placed]) -> tuple:
        reflecting = which_reflect([one for item in placed for one in item.mesh.materials or (None,)])
        known = self.surfaces.get(mirror.mirror.session_uid)
        if known is not None and known[1] == reflecting and _same(placed, known[0]):
            return known
        return placed, reflecting, join_mirror(placed, mirror.parts)


_last = Kept()


def held_bytes(item: object = _last) -> int:
    """Return the number of bytes of all arrays in the cache, each counted once."""
    return _bytes(item, set())


def _forget(changed: set[int] | None) -> None:
    """Release the meshes that depend on `changed`, or all."""
    if changed is None:
        vars(_last).update(vars(Kept()))
        return
    for name in [name for name, (_, depends) in _last.meshes.items() if not depends.isdisjoint(changed)]:
        del _last.meshes[name]


listen(_forget)


def _same(placed: list[Placed], others: list[Placed]) -> bool:
    """Return True if the same meshes stand at the same places."""
    return len(placed) == len(others) and all(
        one.mesh is other.mesh and np.array_equal(one.owners, other.owners)
        and np.array_equal(one.matrices, other.matrices) and np.array_equal(one.instances, other.instances)
        for one, other in zip(placed, others))


def _bytes(item: object, seen: set[int]) -> int:
    if id(item) in seen:
        return 0
    seen.add(id(item))
    if isinstance(item, np.ndarray):
        return item.nbytes if item.base is None else _bytes(item.base, seen)
    if isinstance(item, dict):
        return sum(_bytes(part, seen) for part in item.values())
    if isinstance(item, (list, tuple)):
        return sum(_bytes(part, seen) for part in item)
    # descend into objects of this package only
    own = type(item).__module__.startswith(__package__.rsplit(".", 2)[0])
    return sum(_bytes(part, seen) for part in vars(item).values()) if own and hasattr(item, "__dict__") else 0
