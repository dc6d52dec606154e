"""Texture coordinates of a mirror on a result that lies on it, so that its textures stay where they are."""
from __future__ import annotations

import bpy
import numpy as np

from ..writing.nodes.shader_builder import ShaderBuilder

NEARLY = 1e-4  # of a picture: what a map may stray from a linear one by
BY_UV = {"TEX_IMAGE"}
BY_BOX = {"TEX_CHECKER", "TEX_NOISE", "TEX_VORONOI", "TEX_WAVE", "TEX_MAGIC", "TEX_GRADIENT", "TEX_BRICK", "TEX_GABOR",
          "TEX_WHITE_NOISE", "TEX_MUSGRAVE"}


class MirrorCoordinates:
    """The coordinates of `mirror` as nodes of a tree, each made where it is asked for first.

    They go by where the mirror stands, so that its textures move with it.
    """

    def __init__(self, build: ShaderBuilder, mirror: bpy.types.Object) -> None:
        self.build, self.mirror, self.made = build, mirror, {}

    def take_over(self) -> None:
        """Let the nodes of the tree that go by the result's coordinates go by the mirror's."""
        for node in list(self.build.tree.nodes):
            if node.type == "TEX_COORD" and node.object is None:
                for name in ("Object", "Generated", "UV"):
                    self._feed(list(node.outputs[name].links), name)
            elif node.type == "UVMAP":
                self._feed(list(node.outputs[0].links), "UV", node.uv_map)
            elif node.type in BY_UV | BY_BOX:
                socket = node.inputs.get("Vector")
                if socket is not None and not socket.is_linked:
                    coordinates = self._named("UV" if node.type in BY_UV else "Generated")
                    if coordinates is not None:
                        self.build.feed(coordinates, socket)

    def _feed(self, links: list, name: str, uv_map: str = "") -> None:
        coordinates = self._named(name, uv_map) if links else None
        if coordinates is not None:
            for link in links:
                self.build.feed(coordinates, link.to_socket)

    def _named(self, name: str, uv_map: str = "") -> bpy.types.NodeSocket | None:
        """The coordinates of that name; None where they are not known all over the mirror."""
        key = name, uv_map
        if key not in self.made:
            at = self.build.add("ShaderNodeTexCoord", object=self.mirror).outputs["Object"]
            matrix = None if name == "Object" else self._matrix(name, uv_map)
            if name == "Object":
                self.made[key] = at
            else:
                self.made[key] = None if matrix is None else self._linear(at, matrix)
        return self.made[key]

    def _linear(self, at: bpy.types.NodeSocket, matrix: np.ndarray) -> bpy.types.NodeSocket:
        """What a matrix (3, 4) makes of a place."""
        both = self.build.add("ShaderNodeCombineXYZ")
        for row, socket in zip(matrix.tolist(), both.inputs):
            self.build.feed(self.build.calculated("ADD", self.build.dot(at, tuple(row[:3])), row[3]), socket)
        return both.outputs[0]

    def _matrix(self, name: str, uv_map: str) -> np.ndarray | None:
        """How coordinates follow from places in the mirror's own space, where they do so evenly."""
        if self.mirror.type != "MESH":
            return None
        mesh = self.mirror.data
        if name == "Generated":
            size, middle = np.array(mesh.texspace_size), np.array(mesh.texspace_location)
            scale = 0.5 / np.where(size == 0.0, 1.0, size)
            return np.column_stack((np.diag(scale), 0.5 - middle * scale))
        active = [one for one in mesh.uv_layers if one.active_render]
        layer = mesh.uv_layers.get(uv_map) if uv_map else next(iter(active), None)
        if layer is None or not len(mesh.loops) or self.mirror.modifiers:
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
