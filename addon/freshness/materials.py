"""Digests of materials: which ones objects show, as far as a result depends on that, and what these are made of.

Nodes are gone through again only where Blender has told that they may be other ones.
"""
from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from hashlib import blake2b

import bpy

from .. import compat
from ..reading import all_nodes, is_mirror, is_opaque
from ..reading import materials_of as shown_by
from .image_contents import image_content

SIZE = 12   # bytes of a digest
DEEPEST = 4  # settings inside a node's settings: the points of a curve of a mapping
KINDS = (bpy.types.Material, bpy.types.NodeTree, bpy.types.Image, bpy.types.Text)
COLOURS = ("diffuse_color", "metallic", "roughness")  # properties of a material besides its nodes

RENDERED = ("displacement_method", "use_transparent_shadow", "pass_index", "blend_method", "use_backface_culling")
CYCLES = ("emission_sampling", "use_bump_map_correction", "displacement_method", "volume_step_rate",
          "homogeneous_volume")

_colours: dict[int, bytes] = {}
_contents: dict[int, bytes] = {}


def forget_materials(changed: Iterable[bpy.types.ID] | None = None) -> None:
    """Go through the nodes of all materials anew when they are asked for next, where one of them is among what has
    `changed`, or nobody knows."""
    if changed is None or any(isinstance(item, KINDS) for item in changed):
        _colours.clear()
        _contents.clear()


def content_of(material: bpy.types.Material) -> bytes:
    """Return a digest of everything that renders show of a material. Unlike `colours_of`, it includes the contents of
    images and the present values of animated properties, and ignores the names of data that nodes refer to.
    """
    known = _contents.get(material.session_uid)
    if known is None:
        plain = [name for name in RENDERED if hasattr(material, name)]
        known = content_of_data(material, (*COLOURS, *plain), CYCLES)
        # the place of an object that a node refers to is not reported as a change of the material
        if not any(getattr(node, "object", None) for node in all_nodes(material.node_tree)):
            _contents[material.session_uid] = known
    return known


def content_of_data(data: bpy.types.Material | bpy.types.Light | bpy.types.World, plain: Iterable[str],
                    of_cycles: Iterable[str]) -> bytes:
    """Return the content of data with nodes: its values `plain`, and those `of_cycles`."""
    cycles = getattr(data, "cycles", None)
    known = [list(made_of(data, plain, _content)), [getattr(cycles, name, None) for name in of_cycles]]
    return blake2b(repr(known).encode(), digest_size=SIZE).digest()


def _content(item: bpy.types.ID) -> object:
    """Return a digest of data that a node refers to: of its content, or of its transform."""
    if isinstance(item, bpy.types.Image):
        return image_content(item)
    if isinstance(item, bpy.types.Object):
        return [tuple(row) for row in item.matrix_world]
    if isinstance(item, bpy.types.Text):
        return item.as_string()
    # groups are gone through with the tree
    return None


def materials_of(objects: list) -> str:
    """Return a digest of the materials that objects show, and of which of these are mirrors or transparent."""
    return _digest(repr([[(material.name_full, is_mirror(material), is_opaque(material)) if material else None
                          for material in shown_by(obj)] for obj in objects]).encode())


def colours_of(objects: list) -> str:
    """Return a digest of the contents of the materials of objects."""
    told = blake2b(digest_size=SIZE)
    for material in [material for obj in objects for material in shown_by(obj)]:
        if material is None:
            told.update(b"none")
            continue
        if material.session_uid not in _colours:
            _colours[material.session_uid] = repr(list(made_of(material, COLOURS))).encode()
        told.update(_colours[material.session_uid])
    return told.hexdigest()


def _digest(told: bytes) -> str:
    return blake2b(told, digest_size=SIZE).hexdigest()


def made_of(data: bpy.types.Material | bpy.types.Light | bpy.types.World, plain: Iterable[str],
            content: Callable | None = None) -> Iterator:
    """Yield the nodes of a data-block with their settings, and its own settings `plain` by name.

    Data that nodes refer to is represented by name, and animated values are ignored. With `content`, such data is
    represented by the result of `content`, and animated data by its present values.
    """
    yield [_plain(getattr(data, name)) for name in plain]
    if not compat.uses_nodes(data):
        return
    trees: dict = {}
    for node in all_nodes(data.node_tree):
        trees[node.id_data] = None
        # animated values differ in each frame, and results of other frames are not outdated by them
        if content is not None or node.id_data.animation_data is None:
            yield list(_values(node, _own_settings(node), 0, content))
            yield [_plain(socket.default_value) for socket in node.inputs if hasattr(socket, "default_value")]
        yield node.name, node.bl_idname, node.mute
    for tree in trees:
        yield sorted((link.from_node.name, link.from_socket.identifier, link.to_node.name, link.to_socket.identifier)
                     for link in tree.links)


def _own_settings(node: bpy.types.Node) -> list[str]:
    """Return the settings of a type of node, without those that every node has."""
    return [name for name in node.bl_rna.properties.keys() if name not in bpy.types.Node.bl_rna.properties]


def _values(struct, names: Iterable[str], depth: int, content: Callable | None) -> Iterator:
    """Yield the values of settings, including those of nested settings."""
    for name in names:
        kind, value = struct.bl_rna.properties[name].type, getattr(struct, name)
        if isinstance(value, bpy.types.ID):
            yield name, value.name_full if content is None else content(value)
        elif kind not in {"POINTER", "COLLECTION"}:
            yield name, _plain(value)
        elif value is not None and depth < DEEPEST:
            for item in [value] if kind == "POINTER" else value:
                inner = [key for key in item.bl_rna.properties.keys() if key != "rna_type"]
                yield name, list(_values(item, inner, depth + 1, content))


def _plain(value):
    """Return a value in a form that can be written; arrays and sets become ordered."""
    if isinstance(value, str | bool | int | float) or value is None:
        return value
    if isinstance(value, bpy.types.ID):
        return value.name_full
    return sorted(value) if isinstance(value, set) else tuple(value)
