"""Colours that change over a mirror, in the light that it throws, shown by nodes that know where it comes from."""
from __future__ import annotations

import bpy
import numpy as np

from ....core import CausticMesh
from ...faults import AllOrNothing
from ...reading import DiffuseScene, all_nodes, materials_of, read_scene
from ...reading.materials import feeding
from ...writing import Attribute
from ...writing.nodes.copied_nodes import copied
from ..receiver_places import MARK, NORMAL, PLACES, asked_by, show_by_places, stored, uv
from .mirror_parts import MirrorPart
from .tint import Texture, Tint

PER_COLOUR = "mirror_light_{}"
"""The attribute that tells by how much light grows with the colour of the textured tint of that number, in W/m2."""
BY_PLACE = {"RGB", "VALUE", "VALTORGB", "CURVE_RGB", "CURVE_VEC", "CURVE_FLOAT", "MIX", "MIX_RGB", "MATH", "VECT_MATH",
            "MAPPING", "INVERT", "HUE_SAT", "GAMMA", "BRIGHTCONTRAST", "CLAMP", "MAP_RANGE", "SEPARATE_COLOR",
            "COMBINE_COLOR", "SEPRGB", "COMBRGB", "SEPXYZ", "COMBXYZ", "RGBTOBW", "BLACKBODY", "VECTOR_ROTATE", "GROUP",
            "GROUP_INPUT", "GROUP_OUTPUT", "REROUTE", "FRAME", "TEX_COORD", "UVMAP", "TEX_BRICK", "TEX_CHECKER",
            "TEX_GABOR", "TEX_GRADIENT", "TEX_IMAGE", "TEX_MAGIC", "TEX_MUSGRAVE", "TEX_NOISE", "TEX_VORONOI",
            "TEX_WAVE", "TEX_WHITE_NOISE", "ATTRIBUTE", "VERTEX_COLOR"}
"""Nodes that tell a colour by a place on the object alone."""
ASKING = {"TEX_COORD", "UVMAP", "ATTRIBUTE", "VERTEX_COLOR"}
"""Those of them that read what is on the object."""


def textured(mirror: bpy.types.Object) -> list[Tint]:
    """Return the tints of a mirror with a known texture, in the order of its materials."""
    found: list[Tint] = []
    for material in materials_of(mirror):
        tint = Tint.of_material(material)
        if tint.texture is not None and _by_place(tint.texture) and not any(tint.same(other) for other in found):
            found.append(tint)
    return found


def places_on_mirror(depsgraph: bpy.types.Depsgraph, mirror: bpy.types.Object) -> DiffuseScene | None:
    """Return the mirror with its coordinates if any of its tints is textured, else None."""
    return read_scene(depsgraph, [mirror], unmirrored=True) if textured(mirror) else None


def stains(tints: list[Tint], whole: AllOrNothing) -> list[tuple[Tint, bpy.types.NodeTree]]:
    """Return textured tints, each with a node group that computes its colour at the point of reflection."""
    return [(tint, _colour_group(tint.texture, whole)) for tint in tints if tint.texture is not None]


def _colour_group(texture: Texture, whole: AllOrNothing) -> bpy.types.NodeTree:
    group = bpy.data.node_groups.new(f"{texture.material.name} Thrown", "ShaderNodeTree")
    whole.undo(bpy.data.node_groups.remove, group)
    group[MARK] = True
    group.interface.new_socket("Color", in_out="OUTPUT", socket_type="NodeSocketColor")
    output, colour = group.nodes.new("NodeGroupOutput"), texture.plugged_in
    if colour is None:  # any more
        return group
    made = copied([colour.node, *feeding(colour.node)], group)
    group.links.new(made[colour.node].outputs[list(colour.node.outputs).index(colour)], output.inputs[0])
    show_by_places(group, whole, {name: _attribute(name) for name in _asked(texture)})
    return group


def mirror_attributes(lit: list[tuple[MirrorPart, np.ndarray, CausticMesh]], tints: list[Tint],
                      mirror: DiffuseScene | None) -> tuple[Attribute, ...]:
    """Return the attributes that nodes of textured tints read at the corners of the faces of caustics.

    Parameters
    ----------
    lit : list of (MirrorPart, (m, 3, 3) float64, CausticMesh)
        With the light in W/m2 that a perfect first mirror would reflect.
    """
    if mirror is None or not tints:
        return ()
    grown = [[light * tint.by_colour(mesh.cosine[:, :, 0]) if part.tint.same(tint) else np.zeros(light.shape)
              for part, light, mesh in lit] for tint in tints]
    found = [Attribute(PER_COLOUR.format(number), "FLOAT_VECTOR", "CORNER", np.concatenate(one).astype(np.float32))
             for number, one in enumerate(grown)]
    triangle = np.concatenate([part.triangle[mesh.met[:, 0]] for part, _, mesh in lit])
    places = np.concatenate([mesh.mirror_position[mesh.triangles] for *_, mesh in lit])
    sides = np.concatenate([np.where(mesh.cosine[:, :, :1] < 0.0, -1.0, 1.0) for *_, mesh in lit]).astype(np.float32)
    weights = _weights(mirror.mesh.positions[mirror.mesh.triangles[triangle]], places).astype(np.float32)
    for name in sorted({name for tint in tints for name in _asked(tint.texture)}):
        values = np.matmul(weights, _values(mirror, name)[triangle])
        if name == NORMAL:
            # flip normals on back faces, and normalise them, since interpolation shortens them
            values *= sides / np.maximum(np.linalg.norm(values, axis=2, keepdims=True), 1e-12)
        # numbers alone stand for themselves three times, colours without how opaque they are
        values = np.repeat(values, 3, axis=2) if values.shape[2] == 1 else values[:, :, :3]
        values = np.pad(values, ((0, 0), (0, 0), (0, 3 - values.shape[2])))
        found.append(Attribute(_attribute(name), "FLOAT_VECTOR", "CORNER", values))
    return tuple(found)


def _values(mirror: DiffuseScene, name: str):
    """Return coordinates, or a stored attribute, at the corners of a mirror's triangles."""
    if name in (*PLACES, NORMAL):
        return {"Generated": mirror.generated, "Object": mirror.own_places, NORMAL: mirror.own_normals}[name]
    nothing = np.zeros((len(mirror.mesh.triangles), 3, 3), dtype=np.float32)
    if name.startswith(stored("")):
        asked = name.removeprefix(stored("")) or mirror.active_colour
        return (mirror.colours | mirror.numbers).get(asked, ("", mirror.uv_maps.get(asked, nothing)))[1]
    return mirror.uv_maps.get(name.removeprefix(uv("")) or mirror.active_uv, nothing)


def _weights(corners: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Return barycentric coordinates (m, 3, 3) of points `places` (m, 3, 3) in triangles with `corners` (m, 3, 3)."""
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    normal, away = np.cross(first, second), places - corners[:, :1]
    squared = np.maximum((normal**2).sum(axis=1), 1e-300)[:, None]
    v = (np.cross(away, second[:, None]) * normal[:, None]).sum(axis=2) / squared
    w = (np.cross(first[:, None], away) * normal[:, None]).sum(axis=2) / squared
    return np.stack((1.0 - v - w, v, w), axis=2)


def _attribute(name: str) -> str:
    if name in (*PLACES, NORMAL):
        return f"mirror_{name.lower()}"
    if name.startswith(stored("")):
        return f"mirror_stored {name.removeprefix(stored(''))}".strip()
    return f"mirror_uv {name.removeprefix(uv(''))}".strip()


def _by_place(texture: Texture) -> bool:
    """Return True if a texture's colour depends on the position on the mirror only."""
    colour = texture.plugged_in
    return colour is not None and all(
        node.type in BY_PLACE and not (node.type in ASKING and _elsewhere(node))
        for node in _nodes(colour.node))


def _elsewhere(node: bpy.types.Node) -> bool:
    """Return True if a node reads data of other objects, data that depends on the view, or the alpha of a colour."""
    if node.type in {"ATTRIBUTE", "VERTEX_COLOR"}:
        return getattr(node, "attribute_type", "GEOMETRY") != "GEOMETRY" or node.outputs["Alpha"].is_linked
    known = {"Generated", "UV", NORMAL} | ({"Object"} if getattr(node, "object", None) is None else set())
    return node.from_instancer or (node.type == "TEX_COORD"
                                   and any(one.is_linked and one.name not in known for one in node.outputs))


def _asked(texture: Texture) -> set[str]:
    colour = texture.plugged_in
    return set() if colour is None else asked_by(_nodes(colour.node))


def _nodes(node: bpy.types.Node) -> list[bpy.types.Node]:
    """Return a node, the nodes that feed it, and those in groups among them."""
    found = [node, *feeding(node)]
    return found + [inner for one in found if one.type == "GROUP" for inner in all_nodes(one.node_tree)]
