"""Results before they are lit: the colours of what they show, which no lamp touches, in the mirror's tint."""
from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from functools import partial

import bpy

from ...core import View
from .. import compat
from ..baking import write_mirror_layers, write_mirror_normals
from ..faults import AllOrNothing
from ..lamps import ShownLamp, lamp_light, lamps_before
from ..mirror_part import (
    MATERIAL,
    WHITE,
    LaterMirrors,
    Share,
    by_material,
    opacity_of,
    write_later_tints,
)
from ..reading.materials import (
    asked_attributes,
    is_mirror,
    one_output,
    reflecting_materials,
    shines,
    surface_shader,
)
from ..writing import PREVIEW as MARK
from ..writing.nodes.shader_builder import ShaderBuilder, given, node_behind

GREY = (0.8, 0.8, 0.8, 1.0)  # of what has no material
AS_THEY_ARE = {"BSDF_TRANSPARENT", "HOLDOUT"}
SIDEWAYS = 0.45  # of the colour of what faces the eye, shown where it does not: a head light, so that shapes are seen


def shows_preview(result: bpy.types.Object) -> bool:
    """Whether a result shows a preview of what it would be with light."""
    return any(slot.link == "OBJECT" and slot.material is not None and MARK in slot.material
               for slot in result.material_slots)


def show_previews(results: Iterable[bpy.types.Object], view: View, shown: list[ShownLamp], whole: AllOrNothing) -> None:
    """Let results that show the materials of their meshes to `view` show previews of them, and lamps that
    are `shown` with them; the meshes keep theirs."""
    made: dict = {}
    for result in results:
        lamps, later = lamps_before(result, shown), _later(result)
        shares, faces = Share.of(result.reflection_mesh.mirror), len(result.data.polygons) > 0
        if any(share.goes_by_place for share in shares) and not (faces and write_mirror_normals(result.data, view)):
            shares = tuple(Share(share.tint) for share in shares)
        mirror = result.reflection_mesh.mirror if any(share.textured for share in shares) else None
        asked: set = {MATERIAL} if len(shares) > 1 else set()
        # a slot that has a material of its own has it from the user, and so what stands in place of what was made
        for slot in [slot for slot, made in zip(result.material_slots, result.reflection_mesh.materials)
                     if slot.link == "DATA" and slot.material == made.material]:
            key = slot.material, shares, later, tuple(map(id, lamps)), mirror
            if key not in made:
                made[key] = _preview(slot.material, (shares, mirror), later, lamps)
                whole.undo(bpy.data.materials.remove, made[key])
            asked |= asked_attributes([made[key]]) if mirror is not None else set()
            slot.link = "OBJECT"
            slot.material = made[key]
        if asked and faces:
            write_mirror_layers(result, view, asked)
        if later != LaterMirrors():
            write_later_tints(result)


def forget_previews() -> None:
    """Remove the previews that nothing shows any more."""
    bpy.data.batch_remove([material for material in bpy.data.materials
                           if MARK in material and not material.users and material.library is None])


def _later(result: bpy.types.Object) -> LaterMirrors:
    """What a preview knows of later mirrors: in a window, and on what is a mirror by its role alone, nothing is behind
    it that would know better."""
    found, record = LaterMirrors.of(result), result.reflection_mesh
    mirrors = not record.window and any(is_mirror(one) or shines(one) for one in reflecting_materials(record.mirror))
    return replace(found, unknown=found.unknown and mirrors)


def _preview(source: bpy.types.Material | None, mirrors: tuple[tuple[Share, ...], bpy.types.Object | None],
             later: LaterMirrors, lamps: tuple[ShownLamp, ...]) -> bpy.types.Material:
    """What shows a source's material in the shares of a mirror, which is given where they are textured."""
    shares, mirror = mirrors
    if source is not None and compat.uses_nodes(source):
        material = source.copy()
        tree = material.node_tree
    else:
        material = bpy.data.materials.new("Reflection")
        tree = compat.use_nodes(material)
        tree.nodes.clear()
        tree.nodes.new("ShaderNodeOutputMaterial")
    material.name = f"{'Reflection' if source is None else source.name} Preview"
    material[MARK] = True
    plain = GREY if source is None else tuple(source.diffuse_color)
    build = _Builder(tree, plain)
    tint = by_material(build, [share.tint_in(build, mirror) for share in shares], partial(build.blended, "MIX"))
    build.tint = later.leave(build, tint)
    if source is None or not compat.uses_nodes(source):
        shader = build.add("ShaderNodeBsdfDiffuse")
        build.feed(plain, shader.inputs["Color"])
        tree.links.new(shader.outputs[0], tree.get_output_node("ALL").inputs["Surface"])
    shader = surface_shader(tree)
    if shader is not None:
        surface, opacity = build.shown(shader), opacity_of(tree, shader)
        if lamps:
            surface = build.with_lamps(surface, lamps, opacity)
        wholes = [share.of_the_whole(build, surface, opacity) for share in shares]
        build.put_out(by_material(build, wholes, build.mixed), later)
    return material


class _Builder(ShaderBuilder):
    """Puts what shines in its own colour into the place of what lamps shine on."""

    def __init__(self, tree: bpy.types.NodeTree, plain: tuple) -> None:
        super().__init__(tree)
        self.tint, self.plain = WHITE, plain

    def tinted(self, colour):
        return colour if self.tint == WHITE else self.blended("MULTIPLY", 1.0, colour, self.tint)

    def shaded(self, colour) -> bpy.types.NodeSocket:
        """A colour that shines, less where the surface turns away from the eye."""
        at = self.add("ShaderNodeNewGeometry")
        facing = self.add("ShaderNodeVectorMath", operation="DOT_PRODUCT")
        self.feed(self.normal(at), facing.inputs[0])
        self.feed(at.outputs["Incoming"], facing.inputs[1])
        share = self.add("ShaderNodeMapRange")
        self.feed(self.calculated("ABSOLUTE", facing.outputs["Value"], 0.0), share.inputs["Value"])
        share.inputs["To Min"].default_value = SIDEWAYS
        shown = self.glow(self.tinted(colour))
        self.feed(share.outputs[0], shown.node.inputs["Strength"])
        return shown

    def normal(self, at: bpy.types.Node) -> bpy.types.NodeSocket:
        """The normal of what is shown, in world space; `at` tells that of the mesh."""
        name = compat.normals_attribute()
        if name == "custom_normal":
            return at.outputs["Normal"]
        known = self.add("ShaderNodeAttribute", attribute_name=name)
        turned = self.add("ShaderNodeVectorTransform", vector_type="NORMAL", convert_from="OBJECT", convert_to="WORLD")
        self.feed(known.outputs["Vector"], turned.inputs[0])
        return turned.outputs[0]

    def with_lamps(self, surface: bpy.types.NodeSocket, lamps: tuple[ShownLamp, ...], opacity) -> bpy.types.NodeSocket:
        """A surface with the light of what lamps stand before it; what is open leaves its share to what lies behind,
        before which they stand as well."""
        own = self.glow(self.tinted(lamp_light(self, lamps)))
        self.feed(opacity, own.node.inputs["Strength"])
        return self.added(surface, own)

    def put_out(self, surface: bpy.types.NodeSocket, later: LaterMirrors) -> None:
        """Let Cycles and EEVEE show a surface; exporters begin at what the material was before."""
        known = one_output(self.tree)
        for engine in ("CYCLES", "EEVEE"):
            output = self.add("ShaderNodeOutputMaterial", target=engine)
            self.feed(later.behind(self, surface) if engine == "CYCLES" else surface, output.inputs["Surface"])
            for socket in known.inputs:
                if socket.is_linked and socket.name != "Surface":
                    self.feed(given(socket), output.inputs[socket.name])
        known.is_active_output = True

    def shown(self, shader: bpy.types.Node) -> bpy.types.NodeSocket:
        """What stands for a shader node, which stays as it is."""
        if shader.type in AS_THEY_ARE:
            return shader.outputs[0]
        if shader.type == "MIX_SHADER":
            return self.mixed(given(shader.inputs[0]), *map(self.behind, shader.inputs[1:]))
        if shader.type == "ADD_SHADER":
            both = self.add("ShaderNodeAddShader")
            for part, socket in zip(map(self.behind, shader.inputs), both.inputs):
                if part is not None:
                    self.feed(part, socket)
            return both.outputs[0]
        if shader.type == "EMISSION":
            own = self.glow(self.tinted(given(shader.inputs["Color"])))
            self.feed(given(shader.inputs["Strength"]), own.node.inputs["Strength"])
            return own
        colour = shader.inputs.get("Base Color") or shader.inputs.get("Color")
        shown = self.shaded(self.plain if colour is None else given(colour))
        return self.principled(shader, shown) if shader.type == "BSDF_PRINCIPLED" else shown

    def behind(self, socket: bpy.types.NodeSocket) -> bpy.types.NodeSocket | None:
        """What stands for the shader that feeds a socket."""
        node = node_behind(socket)
        return None if node is None else self.shown(node)

    def principled(self, shader: bpy.types.Node, shown: bpy.types.NodeSocket) -> bpy.types.NodeSocket:
        """With what a Principled BSDF emits, and open where it is."""
        strength = given(shader.inputs["Emission Strength"])
        if strength != 0.0:
            own = self.glow(self.tinted(given(shader.inputs["Emission Color"])))
            self.feed(strength, own.node.inputs["Strength"])
            shown = self.added(shown, own)
        alpha = given(shader.inputs["Alpha"])
        if alpha == 1.0:
            return shown
        return self.mixed(alpha, self.add("ShaderNodeBsdfTransparent").outputs[0], shown)
