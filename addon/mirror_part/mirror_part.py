"""Build shaders that show the reflected light: the mirror's own shader, with its glossy parts replaced by emission of
that light.
"""
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
    """Inputs of a mirror's shader other than its materials.

    Attributes
    ----------
    mirrors : tuple of bpy.types.Object
        Objects that the mirror consists of, whose texture coordinates and attributes its shader uses. Empty if it uses
        none.
    lamps : tuple of ShownLamp
        Lamps that may be visible in the mirror, in front of the source objects.
    later : LaterMirrors
        Further mirrors that are visible in the mirror.
    behind : bool
        True if the mirror itself is visible behind the result. False if it is hidden as a window.
    bent : bool
        True if the attribute `NORMAL` has the mirror's normals. If False, the true normals of the faces are used.
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
    """Builder of the shader of a lit reflection: the mirror's own shader, with emission in place of glossy reflection.

    Parameters
    ----------
    tree : bpy.types.NodeTree
        Shader nodes are added to it.
    light : bpy.types.NodeSocket
        Colour of the light that the source sends to the mirror.
    around : Surroundings
        Other inputs.

    Attributes
    ----------
    lit : bpy.types.NodeSocket
        The light that reaches the mirror: `light` times the reflectance of the later mirrors, plus the light of lamps.
        Later mirrors are those after the first one on a path from the eye with several reflections. The lamps are those
        that a path meets between the mirror and the source, so that the mirror shows them in front of it.
    """

    def __init__(self, tree: bpy.types.NodeTree, light: bpy.types.NodeSocket, around: Surroundings) -> None:
        super().__init__(tree)
        self.around, self.lit = around, around.later.leave(self, light)
        if around.lamps:
            self.lit = self.vector("ADD", self.lit, lamp_light(self, around.lamps))

    def surface(self, mirror: Sequence[bpy.types.Material | None], shaders: Sequence[bpy.types.Node | None],
                own: Sequence[bpy.types.Node]) -> bpy.types.NodeSocket:
        """Return a surface shader in which each face has its own material, with emission in place of glossy reflection.

        Parameters
        ----------
        mirror : sequence of bpy.types.Material or None
            The mirror's materials. None shows all of the light.
        shaders : sequence of bpy.types.Node or None
            The surface shader of each material, copied into the tree.
        own : sequence of bpy.types.Node
            All copied nodes of the materials. Other nodes that the tree already has are not changed.
        """
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
        """Return the surface shader for Cycles, transparent where the mirror behind the result shows the reflection
        itself.

        Parts of the mirror that transmit light, such as glass or cut-outs, must stay visible to show the objects behind
        them. They also show their own reflection, so the result would add it a second time. The same holds for faces
        that are seen in later mirrors whose appearance is not known completely.

        Parameters
        ----------
        shown : bpy.types.NodeSocket
            The shader that shows the reflected light.
        mirror : sequence of bpy.types.Material or None
            The mirror's materials. None counts as opaque.
        """
        if not self.around.behind or all(map(is_opaque, mirror)) and not self.around.later.unknown:
            return shown
        clear = self.clear()
        parts = [shown if is_opaque(one) else clear for one in mirror]
        return self.around.later.behind(self, by_material(self, parts, self.mixed))

    def clear(self) -> bpy.types.NodeSocket:
        return self.add("ShaderNodeBsdfTransparent").outputs[0]

    def part(self, material: bpy.types.Material | None, shader: bpy.types.Node | None) -> bpy.types.NodeSocket:
        """Return the surface for one of the mirror's materials. `shader` is its surface shader, copied into the tree.

        A material that is None or has no nodes shows all of the light. A material without a surface shader is black.
        """
        if material is None or not compat.uses_nodes(material):
            return self.glow(self.lit)
        shown = None if shader is None else self.shown(shader)
        return self.glow(0.0) if shown is None else shown

    def shown(self, shader: bpy.types.Node) -> bpy.types.NodeSocket | None:
        """Replace the glossy parts of a shader node by emission of the reflected light. Return the new shader socket.

        Shaders behind Mix and Add Shader nodes are replaced in place. Other shaders are returned unchanged.
        """
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
        """Return the reflectance of a Principled BSDF's sharp coat at the viewing angle. Remove the coat from the node.

        None if there is no sharp coat.
        """
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
        """Return the Fresnel reflectance of the non-metallic part of a Principled BSDF at the viewing angle."""
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
