"""Texture coordinates and attributes of a mirror on a result that lies on it, so that its textures stay where they
are."""
from __future__ import annotations

from collections.abc import Iterable, Sequence

import bpy
import numpy as np

from .. import compat
from ..reading.materials import all_nodes
from ..writing.nodes.box_projection import project_by
from ..writing.nodes.shader_builder import ShaderBuilder

GENERATED = "Generated"
"""The layer that tells these coordinates of the parts of a mirror."""
LONGEST_NAME = 60  # of an attribute, which Blender cuts
BACK = "mirror_back"
"""The attribute that is 1 on faces in which the eye sees the mirror's back, by which Cycles turns Fresnel over."""
OWN_NORMAL, OWN_PLACE = "mirror_own_normal", "mirror_own_place"
"""The attributes with the mirror's unit normal at each point, and with where that is seen, in the mirror's own space: a
result may lie before the mirror, or behind it."""
NAMED = {"ATTRIBUTE": "attribute_name", "VERTEX_COLOR": "layer_name"}
NEARLY = 1e-4  # of a picture: what a map may stray from a linear one by
BY_UV = {"TEX_IMAGE"}
BY_BOX = {"TEX_CHECKER", "TEX_NOISE", "TEX_VORONOI", "TEX_WAVE", "TEX_MAGIC", "TEX_GRADIENT", "TEX_BRICK", "TEX_GABOR",
          "TEX_WHITE_NOISE", "TEX_MUSGRAVE"}


def own_layer(name: str) -> str:
    """Return the name under which a result stores the mirror's attribute `name`. A result has attributes of its source
    objects too, so the mirror's ones get a prefix.
    """
    return f"Mirror {name}"[:LONGEST_NAME]


def asks_for_places(materials: Iterable[bpy.types.Material | None]) -> bool:
    """Return True if a material of a mirror may vary over it: it has nodes for coordinates, attributes or textures."""
    asking = {"TEX_COORD", "UVMAP", *NAMED, *BY_UV, *BY_BOX}
    return any(node.type in asking for material in materials if material is not None and compat.uses_nodes(material)
               for node in all_nodes(material.node_tree))


class MirrorCoordinates:
    """The coordinates and attributes of a mirror, or of the parts of one, as nodes of a tree, each made where it is
    asked for first."""

    def __init__(self, build: ShaderBuilder, mirrors: Sequence[bpy.types.Object]) -> None:
        self.build, self.mirrors, self.made = build, mirrors, {}
        self.meshes = [mirror.data for mirror in mirrors if mirror.type == "MESH"]

    def take_over(self, nodes: list) -> None:
        """Let those of the nodes that go by the result's coordinates and attributes go by the mirror's."""
        for node in nodes:
            if node.type == "TEX_COORD" and node.object is None:
                for link in list(node.outputs["Normal"].links):
                    self.build.feed(self._normal(), link.to_socket)
                for name in ("Object", "Generated", "UV"):
                    self._feed(list(node.outputs[name].links), name)
            elif node.type == "UVMAP":
                self._feed(list(node.outputs[0].links), "UV", node.uv_map)
            elif node.type in NAMED and getattr(node, "attribute_type", "GEOMETRY") == "GEOMETRY":
                self._rename(node, NAMED[node.type])
            elif node.type in BY_UV | BY_BOX:
                socket = node.inputs.get("Vector")
                if socket is not None and not socket.is_linked:
                    coordinates = self._named("UV" if node.type in BY_UV else "Generated")
                    if coordinates is not None:
                        self.build.feed(coordinates, socket)
        for node in nodes:
            if node.type == "TEX_IMAGE" and node.projection == "BOX":
                project_by(self.build, node, self._normal())

    def _rename(self, node: bpy.types.Node, field: str) -> None:
        """Let a node read the mirror's attribute, which the result knows by another name."""
        for mesh in self.meshes:
            colours = mesh.color_attributes
            name = getattr(node, field)
            if not name and node.type == "VERTEX_COLOR" and colours.render_color_index >= 0:
                name = colours[colours.render_color_index].name
            if name in mesh.attributes:
                setattr(node, field, own_layer(name))
                return

    def _feed(self, links: list, name: str, uv_map: str = "") -> None:
        coordinates = self._named(name, uv_map) if links else None
        if coordinates is not None:
            for link in links:
                self.build.feed(coordinates, link.to_socket)

    def _named(self, name: str, uv_map: str = "") -> bpy.types.NodeSocket | None:
        """The coordinates of that name; None where they are not known all over the mirror."""
        key = name, uv_map
        if key not in self.made:
            matrix = None if name == "Object" else self._matrix(name, uv_map)
            if name == "Object":
                self.made[key] = self.build.add("ShaderNodeAttribute", attribute_name=OWN_PLACE).outputs["Vector"]
            elif matrix is not None:
                self.made[key] = self._linear(self._named("Object"), matrix)
            elif name == "UV":
                self.made[key] = self._layer(uv_map)
            else:
                self.made[key] = self._attribute(GENERATED) if len(self.mirrors) > 1 else None
        return self.made[key]

    def _normal(self) -> bpy.types.NodeSocket:
        return self.build.unit_vector(OWN_NORMAL)

    def _layer(self, uv_map: str) -> bpy.types.NodeSocket | None:
        """A UV map that is not linear all over the mirror, from the result's corners."""
        layer = self._uv_layer(uv_map)
        return None if layer is None else self._attribute(layer.name)

    def _attribute(self, name: str) -> bpy.types.NodeSocket:
        return self.build.add("ShaderNodeAttribute", attribute_name=own_layer(name)).outputs["Vector"]

    def _uv_layer(self, uv_map: str) -> bpy.types.MeshUVLoopLayer | None:
        """The UV map of that name, or the active one."""
        layers = [layer for mesh in self.meshes for layer in mesh.uv_layers
                  if (layer.name == uv_map if uv_map else layer.active_render)]
        return next(iter(layers), None)

    def _linear(self, at: bpy.types.NodeSocket, matrix: np.ndarray) -> bpy.types.NodeSocket:
        """Return the vector that an affine matrix (3, 4) maps the position `at` to."""
        return self.build.combined(*(self.build.calculated("ADD", self.build.dot(at, tuple(row[:3])), row[3])
                                     for row in matrix.tolist()))

    def _matrix(self, name: str, uv_map: str) -> np.ndarray | None:
        """Return the affine matrix (3, 4) from positions in the mirror's own space to generated or UV coordinates.

        Parameters
        ----------
        name : {"Generated", "UV"}
        uv_map : str
            Name of the UV map. Empty for the active one.

        Returns
        -------
        matrix : (3, 4) float64 or None
            None if there is no such matrix: the UV map is missing, is not affine, or may be changed by modifiers, or
            the mirror has several parts or no mesh.
        """
        # parts have each their own
        if len(self.mirrors) > 1 or not self.meshes:
            return None
        mesh, = self.meshes
        if name == "Generated":
            size, middle = np.array(mesh.texspace_size), np.array(mesh.texspace_location)
            scale = 0.5 / np.where(size == 0.0, 1.0, size)
            return np.column_stack((np.diag(scale), 0.5 - middle * scale))
        layer = self._uv_layer(uv_map)
        if layer is None or not len(mesh.loops) or self.mirrors[0].modifiers:
            return None
        places, corners = (np.empty(size, dtype=kind) for size, kind in (
            ((len(mesh.vertices), 3), np.float32), (len(mesh.loops), np.int32)))
        uv = np.empty((len(mesh.loops), 2), dtype=np.float32)
        mesh.attributes["position"].data.foreach_get("vector", places.reshape(-1))
        mesh.attributes[".corner_vert"].data.foreach_get("value", corners)
        layer.uv.foreach_get("vector", uv.reshape(-1))
        known = np.column_stack((places[corners], np.ones(len(corners)))).astype(np.float64)
        found = np.linalg.lstsq(known, uv, rcond=1e-9)[0]
        if np.abs(known @ found - uv).max() > NEARLY:
            return None
        return np.vstack((found.T, np.zeros(4)))
