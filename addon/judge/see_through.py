"""Materials in codes that still let through what their own materials let through: openings, and clear glass.

A code must not be mixed with another one. So a surface is either open at a place or not: a mix of shaders shows the one
that has more than half of it. Rays pass an opening straight, clear glass too: a reflection mesh is not refracted.
"""
from __future__ import annotations

from functools import partial

import bpy

from ..reading.materials import all_nodes, feeding, is_opaque, is_sharp, one_output
from ..writing.nodes.shader_builder import ShaderBuilder, given, node_behind

HALF = 0.5  # share of the light; a surface that transmits more counts as open
GLASS = {"BSDF_GLASS", "BSDF_REFRACTION"}
ALWAYS, BEFORE_MIRRORS, NEVER = "ALWAYS", "BEFORE_MIRRORS", "NEVER"
"""Places in which glass and textures let a ray through: on all of its way, before a mirror, or nowhere.

What is behind these in a mirror is not judged: both are evaluated on the reflection mesh from another place.
"""


class SeeThrough:
    """Dresses materials in one code.

    Parameters
    ----------
    code : bpy.types.NodeTree
        A group of shader nodes, without inputs, for what is not open.
    textures : str
        One of `ALWAYS`, `BEFORE_MIRRORS` and `NEVER`. What is as open everywhere, or from one side, is open for all.
    by_side_alone : bool
        Only what is open from one side counts, so that a mirror reflects however little it reflects.
    owned : list
        Takes what is made.
    """

    def __init__(self, code: bpy.types.NodeTree, textures: str, by_side_alone: bool, owned: list) -> None:
        self._code, self._textures, self._by_side_alone, self._owned = code, textures, by_side_alone, owned

    def dressed(self, material: bpy.types.Material | None) -> bpy.types.Material | None:
        """Return a copy of a material that shows the code where it is not open; None if it is open nowhere."""
        if is_opaque(material) or (self._by_side_alone and not any(map(_asks_for_side, all_nodes(material.node_tree)))):
            return None
        made = material.copy()
        self._owned.append(made)
        made.cycles.emission_sampling = "NONE"
        output = one_output(made.node_tree)
        if output is None:
            return None
        for name in ("Volume", "Displacement"):
            for link in list(output.inputs[name].links):
                made.node_tree.links.remove(link)
        build = ShaderBuilder(made.node_tree)
        surface = output.inputs["Surface"]
        # a material without a surface is fog
        build.feed(self._shown(build, surface) if surface.is_linked else self._open(build), surface)
        return made

    def _shown(self, build: ShaderBuilder, socket: bpy.types.NodeSocket,
               textured: bool = False) -> bpy.types.NodeSocket:
        """Return the output that replaces the shader linked to a socket.

        Set `textured` for shaders that are present only at some places.
        """
        node = node_behind(socket)
        if node is None or node.mute:
            return self._coded(build)
        if node.type == "MIX_SHADER":
            return self._of_mix(build, node, textured)
        if node.type == "ADD_SHADER":
            # light that is added to what comes through does not close the surface
            parts = [self._shown(build, one, textured) for one in node.inputs]
            return next((part for part in parts if getattr(part.node, "node_tree", None) != self._code), parts[0])
        if node.type == "GROUP" and node.node_tree is not None:
            return self._of_group(node, _source(socket), textured)
        return self._of_closure(build, node, textured)

    def _of_mix(self, build: ShaderBuilder, node: bpy.types.Node, textured: bool) -> bpy.types.NodeSocket:
        by_side = _asks_for_side(node)
        if self._by_side_alone and not by_side:
            return self._coded(build)
        textured |= _is_textured(node.inputs[0]) and not by_side
        first, second = (self._shown(build, socket, textured) for socket in node.inputs[1:3])
        return self._chosen(build, given(node.inputs[0]), first, second)

    def _of_group(self, node: bpy.types.Node, source: bpy.types.NodeSocket, textured: bool) -> bpy.types.NodeSocket:
        node.node_tree = node.node_tree.copy()
        self._owned.append(node.node_tree)
        end = next(one for one in node.node_tree.nodes if one.type == "GROUP_OUTPUT" and one.is_active_output)
        socket = next(one for one in end.inputs if one.identifier == source.identifier)
        inside = ShaderBuilder(node.node_tree)
        inside.feed(self._shown(inside, socket, textured), socket)
        return source

    def _of_closure(self, build: ShaderBuilder, node: bpy.types.Node, textured: bool) -> bpy.types.NodeSocket:
        opened, coded = partial(self._open, build), partial(self._coded, build)
        if node.type == "BSDF_TRANSPARENT":
            colour = given(node.inputs["Color"])
            bright = build.dot(colour[:3] if isinstance(colour, tuple) else colour, (1.0 / 3.0,) * 3)
            return self._chosen(build, bright, coded(), opened(textured or _is_textured(node.inputs["Color"])))
        if self._by_side_alone:
            return coded()
        if node.type in GLASS:
            return opened(True) if is_sharp(node) else coded()
        if node.type == "BSDF_PRINCIPLED":
            glass, alpha = node.inputs["Transmission Weight"], node.inputs["Alpha"]
            solid = coded()
            if (glass.is_linked or glass.default_value > HALF) and is_sharp(node):
                solid = self._chosen(build, given(glass), solid, opened(True))
            return self._chosen(build, given(alpha), opened(textured or _is_textured(alpha)), solid)
        return coded()

    def _chosen(self, build: ShaderBuilder, share, first: bpy.types.NodeSocket,
                second: bpy.types.NodeSocket) -> bpy.types.NodeSocket:
        """Return the second of two shaders where its share is above one half, else the first."""
        return build.mixed(build.calculated("GREATER_THAN", share, HALF), first, second)

    def _coded(self, build: ShaderBuilder) -> bpy.types.NodeSocket:
        return build.add("ShaderNodeGroup", node_tree=self._code).outputs[0]

    def _open(self, build: ShaderBuilder, textured: bool = False) -> bpy.types.NodeSocket:
        """Return an opening. If it is `textured` and textures do not count, return the code."""
        if textured and self._textures == NEVER:
            return self._coded(build)
        clear = build.add("ShaderNodeBsdfTransparent")
        build.feed(1.0, clear.inputs["Color"])
        if textured and self._textures == BEFORE_MIRRORS:
            path = build.add("ShaderNodeLightPath")
            return self._chosen(build, path.outputs["Glossy Depth"], clear.outputs[0], self._coded(build))
        return clear.outputs[0]


def _source(socket: bpy.types.NodeSocket) -> bpy.types.NodeSocket:
    """Return the output that feeds a socket, ignoring reroutes."""
    source = socket.links[0].from_socket
    while source.node.type == "REROUTE":
        source = source.node.inputs[0].links[0].from_socket
    return source


def _is_textured(socket: bpy.types.NodeSocket) -> bool:
    """Return True for a socket whose value may differ from place to place."""
    node = node_behind(socket)
    return node is not None and node.type != "VALUE"


def _asks_for_side(node: bpy.types.Node) -> bool:
    """Return True for a mix of shaders whose factor depends on the side that is seen."""
    behind = node_behind(node.inputs[0]) if node.type == "MIX_SHADER" else None
    return behind is not None and any(one.type == "NEW_GEOMETRY" and one.outputs["Backfacing"].is_linked
                                      for one in [behind, *feeding(behind)])
