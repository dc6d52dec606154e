"""Cycles as the judge: what a copied scene's mirrors show at the pixels' centres, rendered in codes."""
from __future__ import annotations

from collections.abc import Generator

import bpy
import numpy as np

from ..metrics import ITSELF, NOTHING, CodedPicture
from ..reading import is_mirror
from ..reading.materials import which_reflect
from ..rendering import Renders
from . import cycles_codes, cycles_render
from .cycles_codes import CodedMaterials
from .cycles_scene import CopiedScene
from .see_through import ALWAYS, BEFORE_MIRRORS


class CodedTruth:
    """Renders what the mirrors of a copied scene show, as often as it is asked: the camera may be moved in between.

    `depth` reflections are followed. Bystanders are black and not reflected from then on, and results are hidden.
    """

    def __init__(self, copied: CopiedScene, codes: CodedMaterials, depth: int) -> None:
        self._copied, self._codes = copied, codes
        self._reflecting = reflecting(copied)
        self._shown_camera = {copy: copy.visible_camera for copy, _ in copied.mirrors}
        self._black, self._facing, self._mirror = codes.black(), codes.mirror_facing(), codes.mirror(depth)
        self._identity, self._position, self._depth = codes.identity(), codes.position(), depth
        self._unrounded = None
        for copy, index in copied.diffuse:
            copy.pass_index = index + 2
        for copy, _ in copied.bystanders:
            copy.visible_glossy = False
        codes.dress(copied.bystanders, self._black, ALWAYS)
        for copy, _ in copied.mirrors:
            copy.visible_camera = True
        show(copied.results, False)

    def mirror(self) -> Renders[tuple[np.ndarray, np.ndarray]]:
        """Return the pixels (height, width) in which the camera sees a mirror, and those of them where Cycles bends the
        normal.
        """
        self._codes.dress(self._copied.diffuse, self._black, BEFORE_MIRRORS)
        self._dress_mirrors(self._facing)
        facing = yield from cycles_render.render_codes(self._copied.scene)
        seen = facing[..., 2] > 0.5
        return seen, seen & (facing[..., 0] - 2.0 < np.minimum(0.9 * (facing[..., 1] - 2.0), 0.01))

    def reflected(self, seen: np.ndarray, unrounded: bool = False) -> Generator[str | None, None, CodedPicture]:
        """Render the reflection in the pixels `seen` (height, width). Set `unrounded` to give Cycles normals that it
        does not round.

        Yields the name of each of its two renders before it, and None while Blender renders.
        """
        if unrounded and self._unrounded is None:
            cycles_codes.carry_normals(self._copied)
            self._unrounded = self._codes.mirror(self._depth, cycles_codes.MIRROR_NORMAL)
        self._dress_mirrors(self._unrounded if unrounded else self._mirror)
        self._codes.dress(self._copied.diffuse, self._identity, BEFORE_MIRRORS)
        yield "the faces in the mirror with exact normals" if unrounded else "the faces in the mirror"
        identity = yield from cycles_render.render_codes(self._copied.scene)
        self._codes.dress(self._copied.diffuse, self._position, BEFORE_MIRRORS)
        yield "the positions in the mirror with exact normals" if unrounded else "the positions in the mirror"
        position = yield from cycles_render.render_codes(self._copied.scene)
        return decode(identity, position, self._codes.origin, seen, face_start=0)

    def end(self) -> None:
        """Make mirrors visible to the camera as they were, and diffuse objects and mirrors black."""
        for copy, _ in self._copied.mirrors:
            copy.visible_camera = self._shown_camera[copy]
        self._codes.dress(self._copied.diffuse, self._black, BEFORE_MIRRORS)
        self._dress_mirrors(self._black)

    def _dress_mirrors(self, code: bpy.types.Material) -> None:
        """Put a code on the reflecting faces. Other faces of the mirrors become black or transparent."""
        for copy, _ in self._copied.mirrors:
            for index, slot in enumerate(copy.material_slots):
                own = self._copied.own[copy][index]
                if index in self._reflecting[copy]:
                    slot.material = self._codes.on(own, code, by_side_alone=True)
                else:
                    slot.material = self._codes.on(own, self._black, ALWAYS)


def reflecting(copied: CopiedScene) -> dict:
    """The material slots of each copy of a mirror that reflect, as sets by copy.

    Those reflect that reading takes for the mirror, by all materials on the faces of one mirror, be it one object or
    many instances.
    """
    found: dict = {copy: set() for copy, _ in copied.mirrors}
    for index in {index for _, index in copied.mirrors}:
        faces = [(copy, slot) for copy, number in copied.mirrors if number == index for slot in _slots_on_faces(copy)]
        known = which_reflect([copied.own[copy][slot] for copy, slot in faces])
        for (copy, slot), reflects in zip(faces, known, strict=True):
            if reflects:
                found[copy].add(slot)
    return found


def mirror_all(copied: CopiedScene, material: bpy.types.Material) -> None:
    """Put a `material` that reflects on mirrors whose own materials do not."""
    for copy, slots in reflecting(copied).items():
        if not any(is_mirror(copied.own[copy][slot]) for slot in slots):
            for slot in copy.material_slots:
                slot.material = material


def _slots_on_faces(copy: bpy.types.Object) -> list:
    """Return the material slots that a copy's faces use. As in Blender, indices that are too large mean the last slot.
    """
    used = np.zeros(len(copy.data.polygons), dtype=np.int32)
    copy.data.polygons.foreach_get("material_index", used)
    return np.unique(used.clip(0, len(copy.material_slots) - 1)).tolist()


def show(part: list, visible: bool) -> None:
    """Show copies in renders, or hide them."""
    for copy, _ in part:
        copy.hide_render = not visible


def lowest_corner(copied: CopiedScene) -> tuple:
    """Return a corner below and left of all diffuse objects."""
    copied.scene.view_layers[0].update()
    corners = [np.array(copy.bound_box) @ np.array(copy.matrix_world)[:3, :3].T + np.array(copy.matrix_world)[:3, 3]
               for copy, _ in copied.diffuse]
    return tuple(float(value) for value in np.floor(np.concatenate(corners).min(axis=0)) - 1.0)


def polygons(context: bpy.types.Context, diffuse: list) -> list:
    """Return the polygon of each triangle of each diffuse object; None for objects with instances, whose faces are
    numbered consecutively.
    """
    depsgraph = context.evaluated_depsgraph_get()
    tables = []
    for obj in diffuse:
        evaluated = obj.evaluated_get(depsgraph)
        table = None
        if evaluated.type == "MESH" and not obj.is_instancer:
            mesh = evaluated.data
            mesh.calc_loop_triangles()
            table = np.empty(len(mesh.loop_triangles), dtype=np.int32)
            mesh.loop_triangle_polygons.foreach_get("value", table)
        tables.append(table)
    return tables


def decode(identity: np.ndarray, position: np.ndarray, origin: tuple, where, face_start: int) -> CodedPicture:
    """Decode a render. Codes are 0 for nothing, 1 for a mirror, and 2 or more for diffuse objects."""
    code = np.where(where, np.rint(identity[..., 0]).astype(np.int64), 0)
    source = np.select([code == 0, code == 1], [NOTHING, ITSELF], code - 2)
    face = np.rint(identity[..., 1]).astype(np.int64) - face_start
    return CodedPicture(source, face, position.astype(np.float64) + np.array(origin))
