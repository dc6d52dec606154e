"""Reflections that show light: prepare their meshes, show the light, keep it if they are generated again."""
from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable

import bpy
import numpy as np

from ...core import View
from ..faults import AllOrNothing, Steps, finished, keep_object, remove_new, still_there, unused
from ..mirror_part import LATER, write_later_tints, write_mirror_layers, write_mirror_normals
from ..reading import mirrors_of
from ..reading.materials import asked_attributes
from ..writing import (
    LONGEST_RECORD,
    edges_that_stray,
    forget_mesh,
    forget_unblurred,
    halve_edges,
    images_of,
    light_layer,
    light_points,
    place_of,
    show_own_materials,
    unblurred_in,
)
from .kept_light import steady_turn
from .known_texels import found_again
from .lit_faces import Placed, faces_of
from .needs_light import needs_light
from .preview import MARK, forget_previews
from .unwrapping import Unwrapped, unwrap
from .world_faces import add_world_faces, edges_off_world

COLOUR = "Reflection Light Colour"
KNOWN = ("mirror_position", "reflected_position")  # what light asks of a mesh
WRITING = "Writing"


def can_be_lit(result: bpy.types.Object) -> bool:
    """Return True if a reflection's mesh tells what each of its points shows."""
    return all(name in result.data.attributes for name in KNOWN)


def prepared(result: bpy.types.Object, view: View, dense: int, whole: AllOrNothing) -> Steps[Placed]:
    """Return a copy of a reflection's mesh that also covers what its mirror shows of the world.

    Faces are cut until a picture of `dense` texels along each side of a pixel lies on them as `view` sees it.
    """
    mesh = result.data.copy()
    whole.undo(remove_new, mesh)
    record = result.reflection_mesh
    placed = Placed(mesh, np.array(place_of(result), dtype=np.float64), record.hidden_faces,
                    record.mirror.session_uid if record.mirror else 0,
                    tuple(steady_turn(source.object) for source in record.sources))
    # before faces are cut: between their corners normals are interpolated as those of the mirror are
    write_mirror_normals(mesh, view)
    if record.world_faces != "NEVER":
        add_world_faces(mesh, result, view, placed.layered)
    yield 0.0, WRITING
    yield from halve_edges(mesh, lambda: _straying(placed, view, dense))
    # engines darken a face that is shaded by one normal and stands by another
    own = mesh.attributes.get("custom_normal")
    if own is not None:
        mesh.attributes.remove(own)
    return placed


def _straying(placed: Placed, view: View, dense: int) -> np.ndarray:
    """Return the edges along which a place in the picture is not linear, or what a mirror shows of the world."""
    clip = view.clip(placed.positions)
    with np.errstate(divide="ignore", invalid="ignore"):
        spots = 0.5 * clip[:, :2] / clip[:, 3:] * view.resolution
    return np.union1d(edges_that_stray(placed.mesh, dense * spots, clip[:, 3]),
                      edges_off_world(placed.mesh, view, spots))


def lay_out(mesh: bpy.types.Mesh, result: bpy.types.Object, view: View, spots: np.ndarray,
            material: bpy.types.Material) -> None:
    """Write where in the picture of light the corners of a mesh lie, and what of the mirror the material asks for."""
    asked = asked_attributes([material])
    write_mirror_layers(mesh, mirrors_of(result), view, asked)
    if asked & LATER:
        write_later_tints(result, mesh)
    if len(mesh.loops):
        layer = light_layer(mesh)
        layer.uv.foreach_set("vector", spots.astype(np.float32).reshape(-1))
        layer.active = layer.active_render = True
    else:
        light_points(mesh).data.foreach_set("vector", spots.astype(np.float32).reshape(-1))


def write_colours(mesh: bpy.types.Mesh, spots: np.ndarray, texels: np.ndarray) -> None:
    """Write the nearest texel of each corner, or point, for solid view by attribute."""
    height, width = texels.shape[:2]
    column, row = np.clip(spots.reshape(-1, 2) * (width, height), 0, (width - 1, height - 1)).astype(np.int64).T
    colours = np.ones((len(row), 4), dtype=np.float32)
    colours[:, :3] = texels[row, column, :3]
    domain = "CORNER" if len(mesh.loops) else "POINT"
    known = mesh.color_attributes.get(COLOUR) or mesh.color_attributes.new(COLOUR, "BYTE_COLOR", domain)
    known.data.foreach_set("color", colours.reshape(-1))
    mesh.color_attributes.active_color = known
    mesh.color_attributes.render_color_index = mesh.color_attributes.active_color_index


def show_light(result: bpy.types.Object, mesh: bpy.types.Mesh, material: bpy.types.Material, told: str,
               whole: AllOrNothing) -> None:
    """Let a reflection show light by a prepared mesh; that keeps the materials of what it shows."""
    record = result.reflection_mesh
    keep_object(result, whole)
    _exchange(result, mesh, whole)
    _keep_users_materials(result)
    show_own_materials(result)
    whole.after(forget_previews)
    _put_on(result, material)
    earlier, record.light_material = record.light_material, material
    record.light = told
    if earlier is not None and earlier != material:
        whole.after(forget_light, earlier)


def record_of(view: View, unwrapped: Unwrapped, dense: int) -> str:
    """Return what a reflection remembers of its light: the view, and the size of its picture."""
    return json.dumps({"view": _fingerprint(view), "size": [int(side) for side in unwrapped.size], "dense": dense})


def keep_light(results: Iterable[bpy.types.Object], view: View, whole: AllOrNothing) -> None:
    """Show the light of results, whose meshes were written anew, on all of it that is found again; they keep their
    records even where that is none."""
    groups: dict = {}
    for result in results:
        record = result.reflection_mesh
        if record.light_material is not None and _known(record.light) is not None and can_be_lit(result):
            groups.setdefault((record.light_material, record.light), []).append(result)
    for (material, told), group in groups.items():
        known, shared = _known(told), {result.data: result for result in group}
        placed = {mesh: finished(prepared(result, view, known["dense"], whole)) for mesh, result in shared.items()}
        spots = (_same_spots(list(placed.values()), view, known)
                 or [_spots_again(one, view, material) for one in placed.values()])
        if any(one is None for one in spots):
            for one in placed.values():
                remove_new(one.mesh)
            continue
        for (own, result), where in zip(shared.items(), spots):
            lay_out(placed[own].mesh, result, view, where, material)
        for result in group:
            _exchange(result, placed[result.data].mesh, whole)
            _put_on(result, material)


def _same_spots(placed: list[Placed], view: View, known: dict) -> list | None:
    """Return where corners lie in a picture that was made for the same view; None if it was not."""
    if known["view"] != _fingerprint(view):
        return None
    unwrapped = unwrap(placed, view, known["dense"])
    return unwrapped.spots if [int(side) for side in unwrapped.size] == known["size"] else None


def _spots_again(placed: Placed, view: View, material: bpy.types.Material) -> np.ndarray | None:
    """Return where corners lie in a picture that was made for another view, by what they show; None if unknown."""
    if not placed.has_faces:
        return None
    return found_again(next(iter(images_of(material)), None), faces_of(placed, view).targets)


def is_lit(result: bpy.types.Object) -> bool:
    """Return True if a reflection shows its light."""
    light = result.reflection_mesh.light_material
    return light is not None and any(slot.material == light for slot in result.material_slots)


def forget_light(material: bpy.types.Material) -> None:
    """Remove a material of light, its groups of nodes and its images, if nothing else uses them."""
    if not still_there([material]) or material.users or material.library is not None:
        return
    images, groups = list(dict.fromkeys(images_of(material))), unblurred_in(material.node_tree)
    bpy.data.materials.remove(material)
    forget_unblurred(groups)
    bpy.data.batch_remove(unused(images))


def light_sentence(result: bpy.types.Object, outdated: bool) -> str:
    """Return what there is to say of a result's light; nothing of one that needs none."""
    if is_lit(result):
        return "The scene has changed since the reflection was lit. Click Light Reflection." if outdated else "Lit."
    return "Not lit yet. Click Light Reflection." if needs_light(result) else ""


def _exchange(result: bpy.types.Object, mesh: bpy.types.Mesh, whole: AllOrNothing) -> None:
    """Let a result show a prepared mesh in place of its own."""
    shared, name = result.data, result.data.name
    whole.undo(setattr, result, "data", shared)
    result.data = mesh
    result.reflection_mesh.faces = len(mesh.polygons)
    whole.after(setattr, mesh, "name", name)
    whole.after(forget_mesh, shared)


def _keep_users_materials(result: bpy.types.Object) -> None:
    """Let the mesh have the materials that the user has put in place of previews, so that they outlast the light."""
    for number, slot in enumerate(result.material_slots):
        material = slot.material
        if (slot.link == "OBJECT" and material not in (None, result.reflection_mesh.light_material)
                and MARK not in material):
            result.data.materials[number] = material


def _known(told: str) -> dict | None:
    try:
        known = json.loads(told[:LONGEST_RECORD])
        width, height = (int(side) for side in known["size"])
        return {"view": str(known["view"]), "size": [width, height], "dense": int(known["dense"])}
    except (ValueError, TypeError, KeyError, RecursionError):
        return None


def _fingerprint(view: View) -> str:
    """Return what tells one view from another, to single precision."""
    numbers = np.concatenate((view.camera_to_world.ravel(), view.projection.ravel(), view.resolution))
    return hashlib.sha256((numbers.astype(np.float32) + np.float32(0.0)).tobytes()).hexdigest()


def _put_on(result: bpy.types.Object, material: bpy.types.Material) -> None:
    for slot in result.material_slots:
        slot.link, slot.material = "OBJECT", material
