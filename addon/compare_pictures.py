"""Dresses a copied scene for its renders: in codes that say what each pixel shows, and in its own materials."""
from __future__ import annotations

import json
import time
from typing import NamedTuple

import bpy
import numpy as np

from . import compat, cycles_codes, cycles_render
from .compare_numbers import ITSELF, NOTHING, CodedPicture
from .cycles_codes import CodedMaterials
from .cycles_scene import CopiedScene
from .mirror_materials import is_mirror



class Renders(NamedTuple):
    """All renders of a comparison.

    Attributes
    ----------
    mirror, bent : (height, width) bool
        Pixels in which the eye sees a mirror, and those of them where Cycles bends the shading normal.
    truth, shown : CodedPicture
        What the mirror shows, and what the reflection mesh shows.
    exact : CodedPicture or None
        What the mirror would show if Cycles did not round its normals; None where Cycles does not.
    reference, result : (height, width, 3) float32
        The pictures in linear light.
    seconds : dict
        Time that Cycles took for the two pictures, by their names.
    """

    mirror: np.ndarray
    bent: np.ndarray
    truth: CodedPicture
    shown: CodedPicture
    exact: CodedPicture | None
    reference: np.ndarray
    result: np.ndarray
    seconds: dict


def render_comparison(context: bpy.types.Context, copied: CopiedScene, diffuse: list, results: list,
                      samples: int) -> Renders:
    """Render the copied scene in codes and in its own materials; `samples` as in `compare`."""
    depth = max((json.loads(result.reflection_mesh.counts or "{}").get("depth", 1) for result in results), default=1)
    cycles_render.prepare(copied.scene, depth)
    _code_results(copied, results, diffuse, _polygons(context, diffuse))
    own = [(slot, slot.material) for copy in copied.everything for slot in copy.material_slots]
    codes = CodedMaterials(copied, _lowest_corner(copied))
    coded = _coded_pictures(copied, codes, depth)
    for slot, material in own:
        slot.material = material
    _dress([(copy, index) for copy, index in copied.mirrors if not _reflecting(copy)], codes.plain_mirror())
    return Renders(*coded, *_pictures(copied, context.scene, samples))


def _polygons(context: bpy.types.Context, diffuse: list) -> list:
    """The polygon of each triangle of each diffuse object; None where it instances others and counts their faces."""
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


def _code_results(copied: CopiedScene, results: list, diffuse: list, polygons: list) -> None:
    """Give each face of the copied results its code: diffuse object and polygon, as the truth is coded."""
    number = {obj: index for index, obj in enumerate(diffuse)}
    for copy, index in copied.results:
        mesh, sources = copy.data, [item.object for item in results[index].reflection_mesh.sources]
        count = len(mesh.polygons)
        source, face = (np.empty(count, dtype=np.int32) for _ in range(2))
        mesh.attributes["source_object"].data.foreach_get("value", source)
        mesh.attributes["source_face"].data.foreach_get("value", face)
        code = np.zeros((count, 3), dtype=np.float32)
        for position, obj in enumerate(sources):
            own = source == position
            # a source that no longer takes part is shown where nothing should be
            code[own, 0] = number.get(obj, len(diffuse)) + 2
            table = polygons[number[obj]] if obj in number else None
            known = own & (face < (0 if table is None else len(table)))
            code[own, 1] = -1.0
            code[known, 1] = table[face[known]] if known.any() else -1.0
        code[:, 1] += 1.0
        mesh.attributes.new("reflection_code", "FLOAT_VECTOR", "FACE").data.foreach_set("vector", code.ravel())


def _dress(part: list, material: bpy.types.Material) -> None:
    """Put one material on every face of the copies."""
    for slot in (slot for copy, _ in part for slot in copy.material_slots):
        slot.material = material


def _dress_mirrors(copied: CopiedScene, material: bpy.types.Material, other: bpy.types.Material,
                   reflecting: dict) -> None:
    """Put a material on the faces that reflect; where no material of a mirror is one, all of them do."""
    for copy, _ in copied.mirrors:
        for index, slot in enumerate(copy.material_slots):
            slot.material = material if not reflecting[copy] or index in reflecting[copy] else other


def _reflecting(copy: bpy.types.Object) -> set:
    """The material slots of a mirror that reflect; empty where none is a mirror, and then all faces are to reflect."""
    return {index for index, slot in enumerate(copy.material_slots) if is_mirror(slot.material)}


def _coded_pictures(copied: CopiedScene, codes: CodedMaterials, depth: int) -> tuple:
    """The first five of `Renders`."""
    scene, origin = copied.scene, codes.origin
    black = codes.black()
    reflecting = {copy: _reflecting(copy) for copy, _ in copied.mirrors}
    shown_camera = {copy: copy.visible_camera for copy, _ in copied.mirrors}
    for copy, index in copied.diffuse:
        copy.pass_index = index + 2
    for copy, _ in copied.bystanders:
        copy.visible_glossy = False
    _dress(copied.bystanders, black)
    for copy, _ in copied.mirrors:
        copy.visible_camera = True
    _show(copied.results, False)

    _dress(copied.diffuse, black)
    _dress_mirrors(copied, codes.mirror_facing(), black, reflecting)
    facing = cycles_render.render_codes(scene)
    seen = facing[..., 2] > 0.5
    bent = seen & (facing[..., 0] - 2.0 < np.minimum(0.9 * (facing[..., 1] - 2.0), 0.01))

    mirrors = [codes.mirror(depth)]
    if compat.packs_normals():
        cycles_codes.carry_normals(copied)
        mirrors.append(codes.mirror(depth, cycles_codes.MIRROR_NORMAL))
    reflected: list = []
    for mirror in mirrors:
        _dress_mirrors(copied, mirror, black, reflecting)
        _dress(copied.diffuse, codes.identity())
        identity = cycles_render.render_codes(scene)
        _dress(copied.diffuse, codes.position())
        reflected.append(_decode(identity, cycles_render.render_codes(scene), origin, seen, face_start=0))

    for copy, _ in copied.mirrors:
        copy.visible_camera = shown_camera[copy]
    _dress(copied.diffuse, black)
    _dress(copied.mirrors, black)
    _show(copied.results, True)
    _dress(copied.results, codes.attribute("reflection_code"))
    identity = cycles_render.render_codes(scene)
    _dress(copied.results, codes.attribute_position("reflected_position"))
    shown = _decode(identity, cycles_render.render_codes(scene), origin, True, face_start=1)
    return seen, bent, reflected[0], shown, reflected[1] if len(reflected) > 1 else None


def _lowest_corner(copied: CopiedScene) -> tuple:
    copied.scene.view_layers[0].update()
    corners = [np.array(copy.bound_box) @ np.array(copy.matrix_world)[:3, :3].T + np.array(copy.matrix_world)[:3, 3]
               for copy, _ in copied.diffuse]
    return tuple(float(value) for value in np.floor(np.concatenate(corners).min(axis=0)) - 1.0)


def _show(part: list, visible: bool) -> None:
    for copy, _ in part:
        copy.hide_render = not visible


def _decode(identity: np.ndarray, position: np.ndarray, origin: tuple, where, face_start: int) -> CodedPicture:
    """0: nothing, 1: a mirror, from 2 on: a diffuse object."""
    code = np.where(where, np.rint(identity[..., 0]).astype(np.int64), 0)
    source = np.select([code == 0, code == 1], [NOTHING, ITSELF], code - 2)
    face = np.rint(identity[..., 1]).astype(np.int64) - face_start
    return CodedPicture(source, face, position.astype(np.float64) + np.array(origin))


def _pictures(copied: CopiedScene, user: bpy.types.Scene, samples: int) -> tuple[np.ndarray, np.ndarray, dict]:
    """What Cycles shows, what it shows with the mesh before a mirror that reflects the world alone, and its times."""
    scene = copied.scene
    scene.world = user.world
    visible = [(copy, copy.visible_camera, copy.visible_glossy) for copy in copied.everything]
    for copy, _ in copied.mirrors:
        copy.visible_camera = True
    _show(copied.results, False)
    started = time.perf_counter()
    reference = cycles_render.render_picture(scene, samples, user)
    between = time.perf_counter()
    for copy, camera, glossy in visible:
        copy.visible_camera, copy.visible_glossy = camera, glossy
    for copy, _ in copied.diffuse:
        copy.visible_glossy = False
    _show(copied.results, True)
    result, ended = cycles_render.render_picture(scene, samples, user), time.perf_counter()
    return reference, result, {"reference": between - started, "result": ended - between}
