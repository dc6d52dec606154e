"""What a mirror makes of the light that it shows: its own shader, with light in place of what is glossy in it."""
from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import bpy

from .. import compat
from ..lamps import ShownLamp, lamp_light
from ..reading.materials import has_sharp_coat, index_of, is_opaque, is_sharp, sends_light, surface_shader
from ..writing import NORMAL
from ..writing.nodes.copied_nodes import copied
from ..writing.nodes.opened_groups import groups_of_shaders, open_groups
from ..writing.nodes.shader_builder import ShaderBuilder, cut, given, node_behind
from .later_mirrors import LaterMirrors
from .layer_weights import layer_weights_as_fresnel
from .metal_colour import conductor_colour, metal_colour
from .mirror_coordinates import BACK, MirrorCoordinates
from .several_materials import by_material

GLOSSY = {"BSDF_GLOSSY", "BSDF_METALLIC"}


@dataclass(frozen=True)
class Surroundings:
    """What a mirror makes of light goes by, beside its material.

    Attributes
    ----------
    mirrors : tuple of bpy.types.Object
        On which its textures lie, the parts of one mirror; empty where that does not matter.
    lamps : tuple of ShownLamp
        That stand before what is shown.
    later : LaterMirrors
        That it shows mirrors in.
    behind : bool
        Whether the mirror itself is seen behind what shows the light.
    bent : bool
        Whether the attribute `NORMAL` tells how the mirror stands; else faces stand as it does.
    """

    mirrors: tuple[bpy.types.Object, ...] = ()
    lamps: tuple[ShownLamp, ...] = ()
    later: LaterMirrors = LaterMirrors()
    behind: bool = False
    bent: bool = True


def copied_shaders(mirror: Iterable[bpy.types.Material], tree: bpy.types.NodeTree
                   ) -> dict[bpy.types.Material, bpy.types.Node | None]:
    """The shaders of materials that have nodes, copied into a tree with all that feeds them."""
    shader_of = {}
    for material in dict.fromkeys(mirror):
        opened = material.copy() if groups_of_shaders(material.node_tree) else material
        if opened != material:
            open_groups(opened.node_tree)
        nodes = [node for node in opened.node_tree.nodes if node.type not in {"OUTPUT_MATERIAL", "FRAME"}]
        shader_of[material] = copied(nodes, tree).get(surface_shader(opened.node_tree))
        if opened != material:
            bpy.data.materials.remove(opened)
    return shader_of


class MirrorPart(ShaderBuilder):
    """Adds to a tree what a mirror makes of `light`, a colour; `lit` is what it meets of that."""

    def __init__(self, tree: bpy.types.NodeTree, light: bpy.types.NodeSocket, around: Surroundings) -> None:
        super().__init__(tree)
        self.around, self.lit = around, around.later.leave(self, light)
        if around.lamps:
            self.lit = self.vector("ADD", self.lit, lamp_light(self, around.lamps))

    def surface(self, mirror: Sequence[bpy.types.Material | None], shaders: Sequence[bpy.types.Node | None],
                own: Sequence[bpy.types.Node]) -> bpy.types.NodeSocket:
        """What materials become that have these shaders and nodes of their `own` in the tree; all other nodes that are
        there stay as they are."""
        others = set(self.tree.nodes) - set(own)
        if self.around.mirrors:
            MirrorCoordinates(self, self.around.mirrors).take_over(list(own))
        parts = [self.part(one, shader) for one, shader in zip(mirror, shaders, strict=True)]
        nodes = [node for node in self.tree.nodes if node not in others]
        layer_weights_as_fresnel(self, nodes)
        nodes = [node for node in self.tree.nodes if node not in others]
        self.bend_normals(nodes)
        self.reflect_by_side(nodes)
        return by_material(self, parts, self.mixed)

    def before_the_mirror(self, shown: bpy.types.NodeSocket, mirror: Sequence[bpy.types.Material | None]
                          ) -> bpy.types.NodeSocket:
        """What Cycles is to see of a surface that lies before the mirror. One that light goes through, glass or what is
        cut out, shows its reflection as well as what is behind it, and would show the former twice: before that, and
        before what is seen by mirrors of which that is not all that they show, there is nothing."""
        if not self.around.behind or all(map(is_opaque, mirror)) and not self.around.later.unknown:
            return shown
        clear = self.clear()
        parts = [shown if is_opaque(one) else clear for one in mirror]
        return self.around.later.behind(self, by_material(self, parts, self.mixed))

    def clear(self) -> bpy.types.NodeSocket:
        return self.add("ShaderNodeBsdfTransparent").outputs[0]

    def part(self, material: bpy.types.Material | None, shader: bpy.types.Node | None) -> bpy.types.NodeSocket:
        """What one of the mirror's materials becomes, which has this shader."""
        if material is None or not compat.uses_nodes(material):
            return self.glow(self.lit)
        shown = None if shader is None else self.shown(shader)
        return self.glow(0.0) if shown is None else shown

    def shown(self, shader: bpy.types.Node) -> bpy.types.NodeSocket | None:
        """What a shader node becomes: light where it is glossy, itself where it is not."""
        if shader.type in GLOSSY:
            return self.glow(self.blended("MULTIPLY", 1.0, self.gloss(shader), self.lit))
        if shader.type == "BSDF_PRINCIPLED":
            return self.principled(shader)
        if shader.type in {"MIX_SHADER", "ADD_SHADER"}:
            for socket in shader.inputs:
                behind = node_behind(socket) if socket.type == "SHADER" else None
                part = self.shown(behind) if behind is not None else None
                if part is not None:
                    self.tree.links.new(part, socket)
        return shader.outputs[0]

    def gloss(self, shader: bpy.types.Node):
        """The colour of a glossy shader, a socket or a colour."""
        if shader.type != "BSDF_METALLIC":
            return given(shader.inputs["Color"])
        # there is one kind alone before Blender 4.5
        by_index = getattr(shader, "fresnel_type", "F82") == "PHYSICAL_CONDUCTOR"
        colour, names = (conductor_colour, ("IOR", "Extinction")) if by_index else (
            metal_colour, ("Base Color", "Edge Tint"))
        return colour(self, *(given(shader.inputs[name]) for name in names))

    def principled(self, shader: bpy.types.Node) -> bpy.types.NodeSocket:
        """Light by the reflection of a Principled BSDF and of its coat, over what else it is; clear where that is."""
        alpha = given(shader.inputs["Alpha"])
        cut(self.tree, shader.inputs["Alpha"], 1.0)
        whole = self.varnished(shader)
        return whole if alpha == 1.0 else self.mixed(alpha, self.clear(), whole)

    def varnished(self, shader: bpy.types.Node) -> bpy.types.NodeSocket:
        """Light by the coat, if there is one, over what is below it."""
        coat = self.coat(shader)
        # under varnish paint may be matte
        below = shader.outputs[0] if coat is not None and not is_sharp(shader) else self.below_coat(shader)
        if coat is None:
            return below
        return self.added(self.glow(self.blended("MULTIPLY", 1.0, coat, self.lit)), self.mixed(coat, below, None))

    def coat(self, shader: bpy.types.Node) -> bpy.types.NodeSocket | None:
        """How much the sharp coat of a Principled BSDF reflects, by the angle; None where it has none."""
        if not has_sharp_coat(shader):
            return None
        fresnel = self.add("ShaderNodeFresnel")
        self.feed(given(shader.inputs["Coat IOR"]), fresnel.inputs["IOR"])
        share = self.calculated("MULTIPLY", fresnel.outputs[0], given(shader.inputs["Coat Weight"]))
        cut(self.tree, shader.inputs["Coat Weight"], 0.0)
        return share

    def below_coat(self, shader: bpy.types.Node) -> bpy.types.NodeSocket:
        """Light by the reflection of what is below the coat, over what else that is."""
        metallic = given(shader.inputs["Metallic"])
        metal = None if metallic == 0.0 else metal_colour(
            self, *(given(shader.inputs[name]) for name in ("Base Color", "Specular Tint")))
        if metallic == 1.0:
            own = self.glow(self.blended("MULTIPLY", 1.0, metal, self.lit))
            return self.added(own, self.shining(shader)) if sends_light(shader) else own
        glass = self.dielectric(shader)
        coat = self.blended("MULTIPLY", 1.0, given(shader.inputs["Specular Tint"]), glass)
        reflected = coat if metal is None else self.blended("MIX", metallic, coat, metal)
        cut(self.tree, shader.inputs["Specular IOR Level"], 0.0)
        cut(self.tree, shader.inputs["Metallic"], 0.0)
        rest = self.mixed(glass, shader.outputs[0], None)
        rest = rest if metal is None else self.mixed(metallic, rest, None)
        return self.added(self.glow(self.blended("MULTIPLY", 1.0, reflected, self.lit)), rest)

    def shining(self, shader: bpy.types.Node) -> bpy.types.NodeSocket:
        """The light of a Principled BSDF's own."""
        glow = self.add("ShaderNodeEmission")
        for name, socket in (("Emission Color", "Color"), ("Emission Strength", "Strength")):
            self.feed(given(shader.inputs[name]), glow.inputs[socket])
        return glow.outputs[0]

    def dielectric(self, shader: bpy.types.Node) -> bpy.types.NodeSocket:
        """How much a Principled BSDF that is no metal reflects, by the angle."""
        level, index = shader.inputs["Specular IOR Level"], shader.inputs["IOR"]
        fresnel = self.add("ShaderNodeFresnel")
        if level.is_linked or index.is_linked:
            self.feed(given(index), fresnel.inputs["IOR"])
        else:
            fresnel.inputs["IOR"].default_value = index_of(shader)
        return fresnel.outputs[0]

    def bend_normals(self, nodes: Iterable[bpy.types.Node]) -> None:
        """Let nodes that go by the surface's normal take the mirror's."""
        normal = self.unit_vector(NORMAL) if self.around.bent else \
            self.add("ShaderNodeNewGeometry").outputs["True Normal"]
        for node in nodes:
            socket = node.inputs.get("Normal")
            if socket is not None and not socket.is_linked:
                self.feed(normal, socket)

    def reflect_by_side(self, nodes: Iterable[bpy.types.Node]) -> None:
        """Let Fresnel go by the side of the mirror that the eye sees. Cycles takes the eye to be within what turns its
        back, and a result turns its back wherever it shows that of what is reflected."""
        nodes = [node for node in nodes if node.type == "FRESNEL"]
        if not nodes:
            return
        shown_back = self.add("ShaderNodeNewGeometry").outputs["Backfacing"]
        seen_back = self.add("ShaderNodeAttribute", attribute_name=BACK).outputs["Fac"]
        inside = self.calculated("ABSOLUTE", self.calculated("SUBTRACT", shown_back, seen_back))
        for node in nodes:
            index = given(node.inputs["IOR"])
            choice = self.add("ShaderNodeMix")
            for value, socket in ((inside, choice.inputs[0]), (index, choice.inputs[2]),
                                  (self.calculated("DIVIDE", 1.0, index), choice.inputs[3])):
                self.feed(value, socket)
            self.feed(choice.outputs[0], node.inputs["IOR"])
