"""Materials drawn at random: what mirrors make of the light that they show, and what lit objects are made of."""
from __future__ import annotations

from collections.abc import Callable

import bpy
import numpy as np

from tests.fuzz.blender.scene_shapes import chosen

WHITE = (1.0, 1.0, 1.0, 1.0)
COORDINATES = ("UV", "Generated", "Object", "Normal")
SHADE = "Shade"  # an attribute of colours on some of the meshes


def mirror_material(rng: np.random.Generator, without: tuple[str, ...] = ()) -> tuple[str, bpy.types.Material]:
    """What a mirror is called and made of, none of the kinds `without`."""
    kind = chosen(rng, [kind for kind in MIRRORS if kind not in without])
    return kind, _made("Mirror", MIRRORS[kind], rng)


def object_material(rng: np.random.Generator, without: tuple[str, ...] = ()) -> tuple[str, bpy.types.Material]:
    """What an object is called and made of, none of the kinds `without`."""
    kind = chosen(rng, [kind for kind in OBJECTS if kind not in without])
    return kind, _made("Object", OBJECTS[kind], rng)


def node(tree: bpy.types.NodeTree, kind: str, **inputs) -> bpy.types.Node:
    """A new node, with values or links at inputs of these names: spaces are underscores."""
    made = tree.nodes.new(f"ShaderNode{kind}")
    for name, value in inputs.items():
        socket = made.inputs[name.replace("_", " ")]
        if isinstance(value, bpy.types.NodeSocket):
            _link(tree, value, socket)
        else:
            socket.default_value = value
    return made


def _made(name: str, surface: Callable, rng: np.random.Generator) -> bpy.types.Material:
    material = bpy.data.materials.new(name)
    if bpy.app.version < (5, 0, 0):
        material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    _link(tree, surface(rng, tree), tree.nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    return material


def _link(tree: bpy.types.NodeTree, start: bpy.types.NodeSocket, end: bpy.types.NodeSocket) -> None:
    tree.links.new(start, end)


def colour(rng: np.random.Generator, least: float = 0.1) -> tuple:
    return (*rng.uniform(least, 0.95, 3).tolist(), 1.0)


def texture(rng: np.random.Generator, tree: bpy.types.NodeTree, least: float = 0.05) -> bpy.types.NodeSocket:
    """Colours of a texture by coordinates of one kind: no finer than the picture, which has to tell it from noise."""
    place = tree.nodes.new("ShaderNodeTexCoord").outputs[chosen(rng, COORDINATES)]
    kind = chosen(rng, ["TexNoise", "TexChecker", "TexVoronoi", "TexWave", "TexMagic", "TexGradient", "TexImage"])
    if kind == "TexChecker":
        pair = colour(rng, least), colour(rng, least)
        return node(tree, kind, Vector=place, Scale=2.0, Color1=pair[0], Color2=pair[1]).outputs[0]
    if kind == "TexImage":
        made = node(tree, kind, Vector=place)
        made.image, made.interpolation = _image(rng, least), chosen(rng, ["Linear", "Closest"])
        made.projection = chosen(rng, ["FLAT", "BOX"])
        return made.outputs[0]
    made = node(tree, kind, Vector=place)
    if "Scale" in made.inputs:
        made.inputs["Scale"].default_value = chosen(rng, [1.0, 2.5])
    ramp = node(tree, "ValToRGB", Fac=made.outputs["Fac" if "Fac" in made.outputs else 0])
    for stop in ramp.color_ramp.elements:
        stop.color = colour(rng, least)
    return ramp.outputs[0]


def _image(rng: np.random.Generator, least: float) -> bpy.types.Image:
    image = bpy.data.images.new("Picture", 8, 8)
    pixels = np.ones((64, 4), dtype=np.float32)
    pixels[:, :3] = rng.uniform(least, 1.0, (64, 3))
    image.pixels.foreach_set(pixels.ravel())
    image.pack()
    return image


def _colour_or_texture(rng: np.random.Generator, tree: bpy.types.NodeTree, least: float = 0.1):
    return texture(rng, tree, least) if rng.random() < 0.5 else colour(rng, least)


def _principled(tree: bpy.types.NodeTree, base, **inputs) -> bpy.types.NodeSocket:
    return node(tree, "BsdfPrincipled", Base_Color=base, **inputs).outputs[0]


def _gloss(tree: bpy.types.NodeTree, tint=WHITE, roughness: float = 0.0) -> bpy.types.NodeSocket:
    return node(tree, "BsdfAnisotropic", Color=tint, Roughness=roughness).outputs[0]


def _mixed(tree: bpy.types.NodeTree, share, first, second) -> bpy.types.NodeSocket:
    made = tree.nodes.new("ShaderNodeMixShader")
    if isinstance(share, float):
        made.inputs[0].default_value = share
    else:
        _link(tree, share, made.inputs[0])
    _link(tree, first, made.inputs[1])
    _link(tree, second, made.inputs[2])
    return made.outputs[0]


def _metal(rng: np.random.Generator, tree: bpy.types.NodeTree) -> bpy.types.NodeSocket:
    return _principled(tree, colour(rng, 0.4), Metallic=1.0, Roughness=0.0)


def _textured_metal(rng: np.random.Generator, tree: bpy.types.NodeTree) -> bpy.types.NodeSocket:
    return _principled(tree, texture(rng, tree, 0.3), Metallic=1.0, Roughness=0.0)


def _painted_metal(rng: np.random.Generator, tree: bpy.types.NodeTree) -> bpy.types.NodeSocket:
    shade = tree.nodes.new("ShaderNodeAttribute")
    shade.attribute_name = SHADE
    return _principled(tree, shade.outputs["Color"], Metallic=1.0, Roughness=0.0)


def _blurred(rng: np.random.Generator, tree: bpy.types.NodeTree) -> bpy.types.NodeSocket:
    return _gloss(tree, colour(rng, 0.5), chosen(rng, [0.05, 0.1]))


def _open(rng: np.random.Generator, tree: bpy.types.NodeTree) -> bpy.types.NodeSocket:
    return _principled(tree, colour(rng, 0.4), Metallic=1.0, Roughness=0.0, Alpha=chosen(rng, [0.5, 0.8]))


def _over_paint(rng: np.random.Generator, tree: bpy.types.NodeTree) -> bpy.types.NodeSocket:
    share = tree.nodes.new(f"ShaderNode{chosen(rng, ['Fresnel', 'LayerWeight'])}").outputs[-1]
    paint = node(tree, "BsdfDiffuse", Color=_colour_or_texture(rng, tree)).outputs[0]
    return _mixed(tree, share, paint, _gloss(tree))


def _coated(rng: np.random.Generator, tree: bpy.types.NodeTree) -> bpy.types.NodeSocket:
    return _principled(tree, _colour_or_texture(rng, tree), Roughness=1.0, Coat_Weight=1.0, Coat_Roughness=0.0)


def _half_mirror(rng: np.random.Generator, tree: bpy.types.NodeTree) -> bpy.types.NodeSocket:
    paint = node(tree, "BsdfDiffuse", Color=colour(rng)).outputs[0]
    return _mixed(tree, chosen(rng, [0.3, 0.7]), paint, _gloss(tree, colour(rng, 0.5)))


def _shining(rng: np.random.Generator, tree: bpy.types.NodeTree) -> bpy.types.NodeSocket:
    both = tree.nodes.new("ShaderNodeAddShader")
    _link(tree, _gloss(tree, colour(rng, 0.5)), both.inputs[0])
    _link(tree, node(tree, "Emission", Color=colour(rng), Strength=0.1).outputs[0], both.inputs[1])
    return both.outputs[0]


def _plain(rng: np.random.Generator, tree: bpy.types.NodeTree) -> bpy.types.NodeSocket:
    return _principled(tree, colour(rng), Roughness=1.0)


def _textured(rng: np.random.Generator, tree: bpy.types.NodeTree) -> bpy.types.NodeSocket:
    return _principled(tree, texture(rng, tree), Roughness=1.0)


def _glossy(rng: np.random.Generator, tree: bpy.types.NodeTree) -> bpy.types.NodeSocket:
    return _principled(tree, _colour_or_texture(rng, tree), Roughness=chosen(rng, [0.3, 0.5]))


def _leafy(rng: np.random.Generator, tree: bpy.types.NodeTree) -> bpy.types.NodeSocket:
    place = tree.nodes.new("ShaderNodeTexCoord").outputs[chosen(rng, COORDINATES)]
    checks = node(tree, "TexChecker", Vector=place, Scale=2.0)
    return _principled(tree, colour(rng), Roughness=1.0, Alpha=checks.outputs[1])


def _veiled(rng: np.random.Generator, tree: bpy.types.NodeTree) -> bpy.types.NodeSocket:
    return _mixed(tree, 0.5, node(tree, "BsdfTransparent", Color=colour(rng, 0.7)).outputs[0],
                  node(tree, "BsdfDiffuse", Color=_colour_or_texture(rng, tree)).outputs[0])


def _waxen(rng: np.random.Generator, tree: bpy.types.NodeTree) -> bpy.types.NodeSocket:
    return _principled(tree, colour(rng, 0.4), Roughness=1.0, Subsurface_Weight=1.0,
                       Subsurface_Radius=(0.2, 0.1, 0.05), Subsurface_Scale=0.3)


def _bumpy(rng: np.random.Generator, tree: bpy.types.NodeTree) -> bpy.types.NodeSocket:
    place = tree.nodes.new("ShaderNodeTexCoord").outputs[chosen(rng, COORDINATES[:3])]
    height = node(tree, "TexNoise", Vector=place, Scale=3.0).outputs[0]
    bump = node(tree, "Bump", Height=height, Distance=0.5).outputs[0]
    return _principled(tree, colour(rng, 0.4), Roughness=1.0, Normal=bump)


def _random_by_object(rng: np.random.Generator, tree: bpy.types.NodeTree) -> bpy.types.NodeSocket:
    ramp = node(tree, "ValToRGB", Fac=tree.nodes.new("ShaderNodeObjectInfo").outputs["Random"])
    for stop in ramp.color_ramp.elements:
        stop.color = colour(rng)
    return _principled(tree, ramp.outputs[0], Roughness=1.0)


def _painted(rng: np.random.Generator, tree: bpy.types.NodeTree) -> bpy.types.NodeSocket:
    shade = tree.nodes.new("ShaderNodeVertexColor")
    shade.layer_name = SHADE
    return _principled(tree, shade.outputs["Color"], Roughness=1.0)


def _glowing(rng: np.random.Generator, tree: bpy.types.NodeTree) -> bpy.types.NodeSocket:
    return node(tree, "Emission", Color=_colour_or_texture(rng, tree), Strength=chosen(rng, [0.3, 1.0])).outputs[0]


def _glowing_and_lit(rng: np.random.Generator, tree: bpy.types.NodeTree) -> bpy.types.NodeSocket:
    return _principled(tree, colour(rng), Roughness=1.0, Emission_Color=texture(rng, tree), Emission_Strength=0.3)


def _translucent(rng: np.random.Generator, tree: bpy.types.NodeTree) -> bpy.types.NodeSocket:
    return _mixed(tree, 0.5, node(tree, "BsdfTranslucent", Color=colour(rng, 0.4)).outputs[0],
                  node(tree, "BsdfDiffuse", Color=colour(rng)).outputs[0])


def _two_sided(rng: np.random.Generator, tree: bpy.types.NodeTree) -> bpy.types.NodeSocket:
    side = tree.nodes.new("ShaderNodeNewGeometry").outputs["Backfacing"]
    return _mixed(tree, side, node(tree, "BsdfDiffuse", Color=colour(rng)).outputs[0],
                  node(tree, "BsdfDiffuse", Color=_colour_or_texture(rng, tree)).outputs[0])


def _velvet(rng: np.random.Generator, tree: bpy.types.NodeTree) -> bpy.types.NodeSocket:
    return _principled(tree, colour(rng), Roughness=1.0, Sheen_Weight=1.0, Sheen_Roughness=0.6)


MIRRORS: dict[str, Callable] = {
    "metal": _metal, "textured metal": _textured_metal, "painted metal": _painted_metal, "blurred": _blurred,
    "open": _open, "mirror over paint": _over_paint, "coated": _coated, "half mirror": _half_mirror,
    "shining mirror": _shining}
OBJECTS: dict[str, Callable] = {
    "plain": _plain, "textured": _textured, "glossy": _glossy, "leafy": _leafy, "veiled": _veiled, "waxen": _waxen,
    "bumpy": _bumpy, "random": _random_by_object, "painted": _painted, "glowing": _glowing,
    "glowing and lit": _glowing_and_lit, "translucent": _translucent, "two-sided": _two_sided, "velvet": _velvet}
