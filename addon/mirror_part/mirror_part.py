"""What a mirror makes of the light that it shows: its own shader, with light in place of what is glossy in it."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import bpy

from .. import compat
from ..faults import AllOrNothing, remove_new
from ..lamps import ShownLamp, lamp_light
from ..reading.materials import has_sharp_coat, index_of, is_opaque, is_sharp, one_output, surface_shader
from ..writing import NORMAL, UV_MAP, show_unblurred
from ..writing.nodes.copied_nodes import copied
from ..writing.nodes.shader_builder import ShaderBuilder, cut, given, node_behind
from .later_mirrors import LaterMirrors
from .mirror_coordinates import BACK, MirrorCoordinates
from .mirror_share import GLOSSY, layer_weights_as_fresnel
from .several_materials import by_material


@dataclass(frozen=True)
class Surroundings:
    """What a mirror makes of light goes by, beside its material.

    Attributes
    ----------
    mirror : bpy.types.Object or None
        On which its textures lie.
    lamps : tuple of ShownLamp
        That stand before what is shown.
    later : LaterMirrors
        That it shows mirrors in.
    behind : bool
        Whether the mirror itself is seen behind what shows the light.
    """

    mirror: bpy.types.Object | None = None
    lamps: tuple[ShownLamp, ...] = ()
    later: LaterMirrors = LaterMirrors()
    behind: bool = False


def new_object_material(name: str, image: bpy.types.Image, mirror: Sequence[bpy.types.Material | None], opaque: bool,
                        around: Surroundings, whole: AllOrNothing) -> bpy.types.Material:
    """A material that shows light that stays with objects as those of a `mirror` would: tinted, by Fresnel, mixed with
    what else they are; `None` shows all of the light.

    Tints go by the true angle at the mirror, which the attribute `NORMAL` tells, and several materials by the attribute
    `MATERIAL`. EEVEE has nodes of its own.
    """
    material, shaders = _merged(name, mirror, whole)
    tree = material.node_tree
    own = list(tree.nodes)
    build = _Builder(tree, image, around)
    if around.mirror is not None:
        MirrorCoordinates(build, around.mirror).take_over(own)
    parts = [build.part(one, shader) for one, shader in zip(mirror, shaders)]
    build.bend_normals()
    build.reflect_by_side()
    output = one_output(tree)
    shown = by_material(build, parts, build.mixed)
    if not opaque:
        clear = build.add("ShaderNodeBsdfTransparent").outputs[0]
        shown = build.mixed(build.light.outputs["Alpha"], clear, shown)
    tree.links.new(shown, output.inputs["Surface"])
    for name_ in ("Displacement", "Volume"):
        for link in list(output.inputs[name_].links):
            tree.links.remove(link)
    show_unblurred(tree, [build.light], output, whole)
    if around.behind and (around.later.unknown or not all(map(is_opaque, mirror))):
        _leave_to_the_mirror(build, shown, mirror, around.later)
    for node in tree.nodes:
        node.select = node == build.light
    tree.nodes.active = build.light
    return material


def _merged(name: str, mirror: Sequence[bpy.types.Material | None], whole: AllOrNothing
            ) -> tuple[bpy.types.Material, list[bpy.types.Node | None]]:
    """A new material with the nodes of all that have some, and the shader of each, None where it has none."""
    with_nodes = [one for one in mirror if one is not None and compat.uses_nodes(one)]
    material = with_nodes[0].copy() if with_nodes else bpy.data.materials.new(name)
    whole.undo(remove_new, material)
    material.name = name
    tree = compat.use_nodes(material)
    if not with_nodes:
        tree.nodes.clear()
        tree.nodes.new("ShaderNodeOutputMaterial")
    shader_of = {one: surface_shader(tree) for one in with_nodes[:1]}
    for other in with_nodes[1:]:
        nodes = [node for node in other.node_tree.nodes if node.type not in {"OUTPUT_MATERIAL", "FRAME"}]
        shader = surface_shader(other.node_tree)
        shader_of[other] = copied(nodes, tree).get(shader)
    return material, [shader_of.get(one) for one in mirror]


def _leave_to_the_mirror(build: ShaderBuilder, shown: bpy.types.NodeSocket,
                         mirror: Sequence[bpy.types.Material | None], later: LaterMirrors) -> None:
    """Let Cycles see a mirror that light goes through, glass or what is cut out, and nothing before it: that shows its
    reflection as well as what is behind it, and would show the former twice. So with what is seen by mirrors of which
    that is not all that they show."""
    clear = build.add("ShaderNodeBsdfTransparent").outputs[0]
    output = build.add("ShaderNodeOutputMaterial", target="CYCLES")
    parts = [shown if is_opaque(one) else clear for one in mirror]
    build.feed(later.behind(build, by_material(build, parts, build.mixed)), output.inputs["Surface"])


class _Builder(ShaderBuilder):
    """Adds nodes to a tree; `light` is the picture of the light, `lit` what the mirror meets."""

    def __init__(self, tree: bpy.types.NodeTree, image: bpy.types.Image, around: Surroundings) -> None:
        super().__init__(tree)
        where = self.add("ShaderNodeUVMap", uv_map=UV_MAP)
        self.light = self.add("ShaderNodeTexImage", name=image.name, image=image, interpolation="Linear",
                              extension="EXTEND")
        tree.links.new(where.outputs[0], self.light.inputs["Vector"])
        self.lit = around.later.leave(self, self.light.outputs["Color"])
        if around.lamps:
            self.lit = self.vector("ADD", self.lit, lamp_light(self, around.lamps))

    def part(self, material: bpy.types.Material | None, shader: bpy.types.Node | None) -> bpy.types.NodeSocket:
        """What one of the mirror's materials becomes, which has this shader."""
        if material is None or not compat.uses_nodes(material):
            return self.glow(self.lit)
        shown = None if shader is None else self.shown(shader)
        return self.glow(0.0) if shown is None else shown

    def shown(self, shader: bpy.types.Node) -> bpy.types.NodeSocket | None:
        """What a shader node becomes: light where it is glossy, itself where it is not."""
        if shader.type in GLOSSY:
            tint = given(shader.inputs.get("Color") or shader.inputs["Base Color"])
            if shader.type == "BSDF_METALLIC":
                tint = self.at_grazing(tint)
            return self.glow(self.blended("MULTIPLY", 1.0, tint, self.lit))
        if shader.type == "BSDF_PRINCIPLED":
            return self.principled(shader)
        if shader.type in {"MIX_SHADER", "ADD_SHADER"}:
            for socket in shader.inputs:
                behind = node_behind(socket) if socket.type == "SHADER" else None
                part = self.shown(behind) if behind is not None else None
                if part is not None:
                    self.tree.links.new(part, socket)
        return shader.outputs[0]

    def principled(self, shader: bpy.types.Node) -> bpy.types.NodeSocket:
        """Light by the reflection of a Principled BSDF and of its coat, over what else it is; clear where that is."""
        alpha = given(shader.inputs["Alpha"])
        cut(self.tree, shader.inputs["Alpha"], 1.0)
        whole = self.varnished(shader)
        return whole if alpha == 1.0 else self.mixed(alpha, self.add("ShaderNodeBsdfTransparent").outputs[0], whole)

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
        metal = None if metallic == 0.0 else self.at_grazing(given(shader.inputs["Base Color"]))
        if metallic == 1.0:
            return self.glow(self.blended("MULTIPLY", 1.0, metal, self.lit))
        glass = self.dielectric(shader)
        coat = self.blended("MULTIPLY", 1.0, given(shader.inputs["Specular Tint"]), glass)
        reflected = coat if metal is None else self.blended("MIX", metallic, coat, metal)
        cut(self.tree, shader.inputs["Specular IOR Level"], 0.0)
        cut(self.tree, shader.inputs["Metallic"], 0.0)
        rest = self.mixed(glass, shader.outputs[0], None)
        rest = rest if metal is None else self.mixed(metallic, rest, None)
        return self.added(self.glow(self.blended("MULTIPLY", 1.0, reflected, self.lit)), rest)

    def at_grazing(self, tint) -> bpy.types.NodeSocket:
        """The colour of a metal by the angle.

        C. Schlick, "An Inexpensive BRDF Model for Physically-based Rendering", 1994, as the Principled BSDF has it with
        a white edge tint.
        """
        facing = self.add("ShaderNodeLayerWeight")
        facing.inputs["Blend"].default_value = 0.5
        fifth = self.add("ShaderNodeMath", operation="POWER")
        fifth.inputs[1].default_value = 5.0
        self.feed(facing.outputs["Facing"], fifth.inputs[0])
        return self.blended("MIX", fifth.outputs[0], tint, (1.0, 1.0, 1.0, 1.0))

    def dielectric(self, shader: bpy.types.Node) -> bpy.types.NodeSocket:
        """How much a Principled BSDF that is no metal reflects, by the angle."""
        level, index = shader.inputs["Specular IOR Level"], shader.inputs["IOR"]
        fresnel = self.add("ShaderNodeFresnel")
        if level.is_linked or index.is_linked:
            self.feed(given(index), fresnel.inputs["IOR"])
        else:
            fresnel.inputs["IOR"].default_value = index_of(shader)
        return fresnel.outputs[0]

    def bend_normals(self) -> None:
        """Let nodes that go by the surface's normal take the mirror's."""
        normal = self.add("ShaderNodeAttribute", attribute_name=NORMAL)
        for node in list(self.tree.nodes):
            socket = node.inputs.get("Normal")
            if socket is not None and not socket.is_linked:
                self.feed(normal.outputs["Vector"], socket)

    def reflect_by_side(self) -> None:
        """Let Fresnel go by the side of the mirror that the eye sees. Cycles takes the eye to be within what turns its
        back, and a result turns its back wherever it shows that of what is reflected."""
        layer_weights_as_fresnel(self)
        nodes = [node for node in self.tree.nodes if node.type == "FRESNEL"]
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
