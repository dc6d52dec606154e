"""How much of what a mirror shows is its reflection, and what else it shows, as far as a preview needs to know."""
from __future__ import annotations

from dataclasses import dataclass

import bpy

from .. import compat
from ..reading.materials import is_mirror, reflecting_materials, surface_shader
from ..writing import NORMAL
from ..writing.nodes.copied_nodes import copied
from ..writing.nodes.shader_builder import ShaderBuilder, given, node_behind
from .mirror_coordinates import MirrorCoordinates

GLOSSY = {"BSDF_GLOSSY", "BSDF_METALLIC"}
REFLECTING = GLOSSY | {"BSDF_PRINCIPLED"}
WHITE = (1.0, 1.0, 1.0, 1.0)
GROUNDS = {"BSDF_DIFFUSE": "Color", "BSDF_PRINCIPLED": "Base Color"}
BLACK = (0.0, 0.0, 0.0, 1.0)  # of grounds whose colour is not one


@dataclass(frozen=True)
class Share:
    """What a mirror makes of what it reflects.

    Attributes
    ----------
    tint : tuple of float
        Its colour; white where it has none.
    kind : {'ALL', 'FRESNEL', 'FACING', 'EVEN'}
        What tells how much it reflects: by Fresnel's equations of an index of refraction, by a layer weight, or evenly.
    value : float
        The index, the blend, or how much.
    turned : bool
        Whether that tells what is not reflected.
    ground : tuple of float
        The colour of the rest.
    textured : bpy.types.Material or None
        Whose nodes tell the colour, where it changes over the mirror.
    """

    tint: tuple = WHITE
    kind: str = "ALL"
    value: float = 1.0
    turned: bool = False
    ground: tuple = BLACK
    textured: bpy.types.Material | None = None

    @classmethod
    def of(cls, mirror: bpy.types.Object | None) -> tuple[Share, ...]:
        """Of each of the materials of a mirror that reflect."""
        shares = () if mirror is None else tuple(map(cls.of_material, reflecting_materials(mirror)))
        return shares if len(set(shares)) > 1 else (*shares, cls())[:1]

    @classmethod
    def of_material(cls, material: bpy.types.Material) -> Share:
        shader = surface_shader(material.node_tree) if compat.uses_nodes(material) else None
        if shader is None:
            return cls()
        if shader.type == "MIX_SHADER":
            return cls._mixed(material, shader)
        if shader.type == "BSDF_PRINCIPLED" and not is_mirror(material):
            index = shader.inputs["IOR"]
            return cls() if index.is_linked else cls(kind="FRESNEL", value=index.default_value, ground=_ground(shader))
        return cls(**_tint(material, shader))

    @classmethod
    def _mixed(cls, material: bpy.types.Material, shader: bpy.types.Node) -> Share:
        first, second = (node_behind(socket) for socket in shader.inputs[1:3])
        glossy = [node is not None and node.type in GLOSSY for node in (first, second)]
        if glossy[0] == glossy[1]:
            return cls()
        gloss, ground = (first, second) if glossy[0] else (second, first)
        told = {**_tint(material, gloss), "turned": glossy[0], "ground": _ground(ground)}
        factor = shader.inputs[0]
        if not factor.is_linked:
            return cls(kind="EVEN", value=factor.default_value, **told)
        weight, output = node_behind(factor), factor.links[0].from_socket.name
        value = None if weight is None else weight.inputs.get("IOR") or weight.inputs.get("Blend")
        if weight is None or weight.type not in {"FRESNEL", "LAYER_WEIGHT"} or value.is_linked:
            return cls()
        if output == "Facing":
            return cls(kind="FACING", value=value.default_value, **told)
        index = value.default_value if weight.type == "FRESNEL" else 1.0 / max(1.0 - value.default_value, 1e-5)
        return cls(kind="FRESNEL", value=index, **told)

    @property
    def goes_by_place(self) -> bool:
        """Whether it is not the same all over the mirror."""
        return self.kind != "ALL" or self.textured is not None

    def tint_in(self, build: ShaderBuilder, mirror: bpy.types.Object):
        """Its colour, for nodes on what lies on `mirror`: one that changes over it is told by copies of its own nodes,
        by the mirror's coordinates."""
        if self.textured is None:
            return self.tint
        shader = surface_shader(self.textured.node_tree)
        if shader.type == "MIX_SHADER":
            shader = next(node for node in map(node_behind, shader.inputs[1:3]) if node and node.type in GLOSSY)
        link = _colour(shader).links[0]
        made = copied(_feeding(link.from_node), build.tree)
        MirrorCoordinates(build, mirror).take_over(list(made.values()))
        return made[link.from_node].outputs[list(link.from_node.outputs).index(link.from_socket)]

    def of_the_whole(self, build: ShaderBuilder, reflected: bpy.types.NodeSocket, opacity) -> bpy.types.NodeSocket:
        """What the mirror shows, a surface, of what it reflects, beside the colour of the rest of it; both are open
        where what is reflected is."""
        if self.kind == "ALL":
            return reflected
        rest = build.glow(self.ground)
        if opacity != 1.0:
            rest = build.mixed(opacity, build.add("ShaderNodeBsdfTransparent").outputs[0], rest)
        share = self.value if self.kind == "EVEN" else _weight(build, self.kind, self.value)
        return build.mixed(share, *((reflected, rest) if self.turned else (rest, reflected)))


def layer_weights_as_fresnel(build: ShaderBuilder) -> None:
    """Let Fresnel nodes, whose index may be told, tell what the Layer Weights of a tree tell as Fresnel."""
    for node in [node for node in build.tree.nodes if node.type == "LAYER_WEIGHT"]:
        links = list(node.outputs["Fresnel"].links)
        if not links:
            continue
        fresnel = build.add("ShaderNodeFresnel")
        rest = build.calculated("SUBTRACT", 1.0, given(node.inputs["Blend"]))
        build.feed(build.calculated("DIVIDE", 1.0, rest), fresnel.inputs["IOR"])
        if node.inputs["Normal"].is_linked:
            build.feed(given(node.inputs["Normal"]), fresnel.inputs["Normal"])
        for link in links:
            build.feed(fresnel.outputs[0], link.to_socket)


def _weight(build: ShaderBuilder, kind: str, value: float) -> bpy.types.NodeSocket:
    """How much a mirror reflects by the true angle, which the attribute `NORMAL` tells."""
    normal = build.add("ShaderNodeAttribute", attribute_name=NORMAL)
    if kind == "FACING":
        weight = build.add("ShaderNodeLayerWeight")
        weight.inputs["Blend"].default_value = value
    else:
        weight = build.add("ShaderNodeFresnel")
        # where a face shows the back of what is reflected, Cycles takes the eye to be inside
        inside = build.add("ShaderNodeNewGeometry").outputs["Backfacing"]
        index = build.add("ShaderNodeMapRange")
        for name, number in (("To Min", value), ("To Max", 1.0 / value)):
            index.inputs[name].default_value = number
        build.feed(inside, index.inputs["Value"])
        build.feed(index.outputs[0], weight.inputs["IOR"])
    build.feed(normal.outputs["Vector"], weight.inputs["Normal"])
    return weight.outputs["Facing" if kind == "FACING" else 0]


def _colour(gloss: bpy.types.Node) -> bpy.types.NodeSocket | None:
    return gloss.inputs.get("Color") or gloss.inputs.get("Base Color")


def _tint(material: bpy.types.Material, gloss: bpy.types.Node) -> dict:
    """The colour of what is glossy in a material, as arguments."""
    tint = _colour(gloss)
    if tint is None:
        return {}
    if not tint.is_linked:
        return {"tint": tuple(tint.default_value)}
    # in a group it is told by what the group is given
    return {"textured": material} if gloss.type in REFLECTING and gloss.id_data == material.node_tree else {}


def _feeding(node: bpy.types.Node) -> list[bpy.types.Node]:
    """A node and all that feed it."""
    found, open_ = {}, [node]
    while open_:
        node = open_.pop()
        if node not in found:
            found[node] = None
            open_ += [link.from_node for socket in node.inputs for link in socket.links]
    return list(found)


def _ground(shader: bpy.types.Node | None) -> tuple:
    colour = None if shader is None or shader.type not in GROUNDS else shader.inputs[GROUNDS[shader.type]]
    return BLACK if colour is None or colour.is_linked else tuple(colour.default_value)
