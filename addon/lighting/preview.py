"""Results before they are lit: the colours of what they show, which no lamp touches, as the mirror reflects them."""
from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import bpy

from ...core import View
from .. import compat
from ..faults import AllOrNothing
from ..lamps import ShownLamp, lamps_before
from ..mirror_part import (
    OWN_NORMAL,
    LaterMirrors,
    MirrorPart,
    Surroundings,
    asks_for_places,
    copied_shaders,
    knows_mirror_normals,
    write_later_tints,
    write_mirror_layers,
    write_mirror_normals,
)
from ..reading import mirrors_of
from ..reading.materials import (
    asked_attributes,
    feeding,
    is_mirror,
    one_output,
    reflecting_materials,
    shines,
    surface_shader,
)
from ..writing import NORMAL
from ..writing import PREVIEW as MARK
from ..writing.nodes.shader_builder import ShaderBuilder, given, node_behind
from .needs_light import is_plain

GREY = (0.8, 0.8, 0.8, 1.0)  # of what has no material
BLACK = (0.0, 0.0, 0.0)
OPEN = {"BSDF_TRANSPARENT", "HOLDOUT"}
SIDEWAYS = 0.45  # of the colour of what faces the eye, shown where it does not: a head light, so that shapes are seen
LEAST_OPEN = 1.0 / 256.0  # opacity: what is as open as that shows what shines in it, and hardly its mirror


def shows_preview(result: bpy.types.Object) -> bool:
    """Return True if a result shows a preview, because its light is not computed yet."""
    return any(slot.link == "OBJECT" and slot.material is not None and MARK in slot.material
               for slot in result.material_slots)


def show_previews(results: Iterable[bpy.types.Object], view: View, shown: list[ShownLamp], whole: AllOrNothing) -> None:
    """Let results that show the materials of their meshes to `view` show previews of them, and lamps that
    are `shown` with them; the meshes keep theirs."""
    made: dict = {}
    for result in results:
        mirror, faces = _mirror_materials(result), len(result.data.polygons) > 0
        around = Surroundings(tuple(mirrors_of(result)) if asks_for_places(mirror) else (),
                              lamps_before(result.data, shown, mirrors_of(result)), _later(result),
                              not result.reflection_mesh.window,
                              faces and knows_mirror_normals(result.data))
        asked: set = set()
        # a slot that has a material of its own has it from the user, and so what stands in place of what was made
        for slot in [slot for slot, made in zip(result.material_slots, result.reflection_mesh.materials)
                     if slot.link == "DATA" and slot.material == made.material]:
            key = slot.material, mirror, replace(around, lamps=tuple(map(id, around.lamps)))
            if key not in made:
                made[key] = _preview(slot.material, mirror, around)
                whole.undo(bpy.data.materials.remove, made[key])
            asked |= asked_attributes([made[key]])
            slot.link = "OBJECT"
            slot.material = made[key]
        if faces and asked & {NORMAL, OWN_NORMAL}:
            write_mirror_normals(result.data, view)
        if faces:
            write_mirror_layers(result.data, mirrors_of(result), view, asked)
        if around.later != LaterMirrors():
            write_later_tints(result, result.data)


def forget_previews() -> None:
    """Remove the previews that nothing shows any more."""
    bpy.data.batch_remove([material for material in bpy.data.materials
                           if MARK in material and not material.users and material.library is None])


def _mirror_materials(result: bpy.types.Object) -> tuple:
    """The materials of a result's mirror that reflect; None where all of the light is shown, as by what is a mirror by
    its role alone."""
    known = tuple(one if _mirrors(one) and not is_plain(one) else None
                  for one in reflecting_materials(mirrors_of(result)))
    return known if len(set(known)) > 1 else (*known, None)[:1]


def _later(result: bpy.types.Object) -> LaterMirrors:
    """Return the later mirrors of a result, for its preview.

    `unknown` is False if the mirror is a window, or a mirror by its role alone. Then nothing behind the result shows
    the reflection, and the preview must not be transparent.
    """
    found, record = LaterMirrors.of(result), result.reflection_mesh
    mirrors = not record.window and any(map(_mirrors, reflecting_materials(mirrors_of(result))))
    return replace(found, unknown=found.unknown and mirrors)


def _mirrors(material: bpy.types.Material) -> bool:
    return is_mirror(material) or shines(material)


def _preview(source: bpy.types.Material | None, mirror: tuple, around: Surroundings) -> bpy.types.Material:
    """Create a preview material: the unlit colours of the material `source`, as the materials of a mirror reflect them.

    Parameters
    ----------
    source : bpy.types.Material or None
        Material of the source object. It is copied. None is grey.
    mirror : tuple of bpy.types.Material or None
        Materials of the mirror. None shows all of the light.
    """
    if source is not None and compat.uses_nodes(source):
        material = source.copy()
        tree = material.node_tree
    else:
        material = bpy.data.materials.new("Reflection")
        tree = compat.use_nodes(material)
        tree.nodes.clear()
        paint, output = (tree.nodes.new(f"ShaderNode{kind}") for kind in ("BsdfDiffuse", "OutputMaterial"))
        paint.inputs["Color"].default_value = GREY if source is None else tuple(source.diffuse_color)
        tree.links.new(paint.outputs[0], output.inputs["Surface"])
    material.name = f"{'Reflection' if source is None else source.name} Preview"
    material[MARK] = True
    shader = surface_shader(tree)
    if shader is None:
        return material
    colour = colour_of(shader)
    if colour is not None and not colour.is_linked:
        # viewports in Solid show no nodes
        material.diffuse_color = (*colour.default_value[:3], 1.0)
    build = _Source(tree, GREY if source is None else tuple(source.diffuse_color))
    light, opacity = build.shown(shader)
    if opacity != 1.0:
        # as bright as it is where it is opaque
        opacity = build.calculated("MAXIMUM", opacity, LEAST_OPEN)
        light = build.vector("SCALE", light, Scale=build.calculated("DIVIDE", 1.0, opacity))
    reflecting = MirrorPart(tree, light, around)
    before = set(tree.nodes)
    shader_of = copied_shaders([one for one in mirror if one is not None and compat.uses_nodes(one)], tree)
    surface = reflecting.surface(mirror, [shader_of.get(one) for one in mirror],
                                 [node for node in tree.nodes if node not in before])
    if opacity != 1.0:
        surface = build.mixed(opacity, reflecting.clear(), surface)
    build.put_out(reflecting.before_the_mirror(surface, mirror), surface)
    build.forget_unused(before)
    return material


def colour_of(shader: bpy.types.Node) -> bpy.types.NodeSocket | None:
    """Return the input that tells the colour of a shader node; None for one without a colour, as a mix."""
    return shader.inputs.get("Base Color") or shader.inputs.get("Color")


class _Source(ShaderBuilder):
    """Tells, as colours, what shines in its own colour in place of what lamps shine on."""

    def __init__(self, tree: bpy.types.NodeTree, plain: tuple) -> None:
        super().__init__(tree)
        self.plain = plain

    def shown(self, shader: bpy.types.Node | None) -> tuple:
        """Return the unlit colour of a shader node, multiplied by its opacity, and its opacity, a socket or a number.

        The node itself is not changed. Without a node the colour is an opaque black.
        """
        if shader is None or shader.type in OPEN:
            return self.combined(*BLACK), 1.0 if shader is None else 0.0
        if shader.type == "MIX_SHADER":
            share = given(shader.inputs[0])
            (first, one), (second, other) = (self.shown(node_behind(socket)) for socket in shader.inputs[1:])
            opacity = 1.0 if one == other == 1.0 else self._blended_numbers(share, one, other)
            return self.blended("MIX", share, first, second), opacity
        if shader.type == "ADD_SHADER":
            (first, one), (second, other) = (self.shown(node_behind(socket)) for socket in shader.inputs)
            # both at once hide as little as they let through together
            opacity = 1.0 if one == other == 1.0 else self.calculated(
                "MAXIMUM", self.calculated("SUBTRACT", self.calculated("ADD", one, other), 1.0), 0.0)
            return self.vector("ADD", first, second), opacity
        if shader.type == "EMISSION":
            return self.scaled(given(shader.inputs["Color"]), given(shader.inputs["Strength"])), 1.0
        colour = colour_of(shader)
        shown = self.shaded(self.plain if colour is None else given(colour))
        return self.principled(shader, shown) if shader.type == "BSDF_PRINCIPLED" else (shown, 1.0)

    def principled(self, shader: bpy.types.Node, shown: bpy.types.NodeSocket) -> tuple:
        """With what a Principled BSDF emits, and open where it is."""
        strength, alpha = given(shader.inputs["Emission Strength"]), given(shader.inputs["Alpha"])
        if strength != 0.0:
            shown = self.vector("ADD", shown, self.scaled(given(shader.inputs["Emission Color"]), strength))
        return (shown, 1.0) if alpha == 1.0 else (self.scaled(shown, alpha), alpha)

    def shaded(self, colour) -> bpy.types.NodeSocket:
        """A colour that shines, less where the surface turns away from the eye."""
        at = self.add("ShaderNodeNewGeometry")
        facing = self.dot(self.normal(at), at.outputs["Incoming"])
        share = self.add("ShaderNodeMapRange")
        self.feed(self.calculated("ABSOLUTE", facing), share.inputs["Value"])
        share.inputs["To Min"].default_value = SIDEWAYS
        return self.scaled(colour, share.outputs[0])

    def scaled(self, colour, factor) -> bpy.types.NodeSocket:
        return self.vector("SCALE", colour if isinstance(colour, bpy.types.NodeSocket) else colour[:3], Scale=factor)

    def normal(self, at: bpy.types.Node) -> bpy.types.NodeSocket:
        """The normal of what is shown, in world space; `at` tells that of the mesh."""
        name = compat.normals_attribute()
        if name == "custom_normal":
            return at.outputs["Normal"]
        known = self.add("ShaderNodeAttribute", attribute_name=name)
        turned = self.add("ShaderNodeVectorTransform", vector_type="NORMAL", convert_from="OBJECT", convert_to="WORLD")
        self.feed(known.outputs["Vector"], turned.inputs[0])
        return turned.outputs[0]

    def put_out(self, for_cycles: bpy.types.NodeSocket, for_eevee: bpy.types.NodeSocket) -> None:
        """Let Cycles and EEVEE show a surface; exporters begin at what the material was before."""
        known = one_output(self.tree)
        for engine, surface in (("CYCLES", for_cycles), ("EEVEE", for_eevee)):
            output = self.add("ShaderNodeOutputMaterial", target=engine)
            self.feed(surface, output.inputs["Surface"])
            for socket in known.inputs:
                if socket.is_linked and socket.name != "Surface":
                    self.feed(given(socket), output.inputs[socket.name])
        known.is_active_output = True

    def forget_unused(self, kept: set) -> None:
        """Remove those of the nodes, but for some that are `kept`, which nothing shows."""
        outputs = [node for node in self.tree.nodes if node.type == "OUTPUT_MATERIAL"]
        shown = {*outputs, *feeding(*outputs)}
        for node in [node for node in self.tree.nodes if node not in kept and node not in shown]:
            self.tree.nodes.remove(node)

    def _blended_numbers(self, share, one, other) -> bpy.types.NodeSocket:
        node = self.add("ShaderNodeMix")
        for value, socket in ((share, node.inputs[0]), (one, node.inputs[2]), (other, node.inputs[3])):
            self.feed(value, socket)
        return node.outputs[0]
