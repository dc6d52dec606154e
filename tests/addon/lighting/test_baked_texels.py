"""Texels that are baked of objects: all that lies in them counts the same, and none is dark for what lies beside it in
the picture."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from lamp_scenes import link, mirror_material, picture, principled, psnr, scene_of, shader_of


def light(samples: int = 64) -> None:
    assert bpy.ops.reflection_mesh.light(samples=samples, kind="OBJECTS", every=True) == {"FINISHED"}


def card_scene(context: bpy.types.Context, made: bpy.types.Material) -> None:
    """A card of that material before a wall mirror, under an even sky."""
    wall = scene_of(context)
    for obj in [obj for obj in context.scene.objects if obj.name in {"Box", "Floor"} or obj.type == "LIGHT"]:
        bpy.data.objects.remove(obj)
    context.scene.world.color = (0.8, 0.8, 0.8)
    card = parts.add("plane", "Card", size=9.0, location=(0.0, -8.0, 1.0), rotation=(-np.pi / 2, 0.0, 0.0))
    card.data.materials.append(made)
    parts.select(card, wall)
    context.view_layer.update()


def striped(output: str) -> tuple[bpy.types.Material, bpy.types.NodeSocket]:
    """A material that emits stripes along a side of the UV map, and where their number is put in."""
    made = parts.material("Stripes")
    tree = made.node_tree
    place, sides, times, wave, side = (tree.nodes.new(f"ShaderNode{kind}") for kind in (
        "TexCoord", "SeparateXYZ", "Math", "Math", "Math"))
    times.operation, wave.operation, side.operation = "MULTIPLY", "PINGPONG", "GREATER_THAN"
    wave.inputs[1].default_value, side.inputs[1].default_value = 0.5, 0.25
    link(tree, place.outputs["UV"], sides.inputs[0])
    link(tree, sides.outputs[output], times.inputs[0])
    link(tree, times.outputs[0], wave.inputs[0])
    link(tree, wave.outputs[0], side.inputs[0])
    glow = tree.nodes.new("ShaderNodeEmission")
    link(tree, side.outputs[0], glow.inputs["Color"])  # no brighter than paper: what is has more texels
    link(tree, glow.outputs[0], next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL").inputs[0])
    return made, times.inputs[1]


def image_of(result: bpy.types.Object) -> bpy.types.Image:
    """The picture that a result shows."""
    nodes = result.reflection_mesh.light_material.node_tree.nodes
    return next(node.image for node in nodes if node.type == "TEX_IMAGE")


def texels_across(result: bpy.types.Object) -> float:
    """How many texels lie along a side of what a result shows."""
    points = np.array([point.co for point in result.reflection_mesh.light_map.vertices]).reshape(-1, 3, 3)
    sides = np.linalg.norm(np.roll(points, -1, axis=1) - points, axis=2)
    return float(np.sort(sides, axis=1)[0, 1] * image_of(result).size[0])


@pytest.mark.thorough
@pytest.mark.parametrize("output", ["X", pytest.param("Y", marks=pytest.mark.slow)])
def test_all_that_lies_in_a_texel_counts_the_same(blank, output):
    """Of stripes one of which goes to a texel, half of them dark, every texel tells a half, wherever they begin."""
    made, number = striped(output)
    card_scene(blank, made)
    result = parts.generate()
    light()
    number.default_value = texels_across(result)
    light(1024)
    image = image_of(result)
    pixels = np.array(image.pixels[:]).reshape(*image.size, 4)[..., 0]
    points = np.array([point.co for point in result.reflection_mesh.light_map.vertices]).reshape(-1, 3, 3)[..., :2]
    rows, columns = (points.mean(axis=1) * image.size[0]).astype(int).T[::-1]
    found = [pixels[row - 3:row + 4, column - 3:column + 4] for row, column in zip(rows, columns)]
    assert np.abs(np.array(found) - 0.5).max() < 0.1


@pytest.mark.thorough
@pytest.mark.parametrize("shining", [False, True])
def test_a_pattern_goes_on_where_triangles_meet(blank, room, shining):
    """Stripes that end at a diagonal of texels, and begin again beyond it."""
    made, number = striped("X")
    number.default_value = 9.0
    tree = made.node_tree
    wave = next(node for node in tree.nodes if node.type == "MATH" and node.operation == "PINGPONG").outputs[0]
    shader = tree.nodes.new("ShaderNodeEmission" if shining else "ShaderNodeBsdfDiffuse")
    link(tree, wave, shader.inputs["Color"])
    link(tree, shader.outputs[0], next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL").inputs[0])
    card_scene(blank, made)
    reference = picture(room)
    parts.generate()
    light()
    # measured: 42.8 dB
    assert psnr(picture(room), reference) > 40.5


def test_halves_of_a_quad_lie_side_by_side(room):
    """Against the corners themselves: where two triangles of a rectangle meet in space, they meet in the picture; what
    is no parallelogram has room of its own."""
    rng = np.random.default_rng(4)
    quads = np.zeros((40, 4, 3))
    sides = rng.normal(size=(2, 40, 3)) * np.exp(rng.normal(size=(2, 40, 1)))
    along = (sides[0] * sides[1]).sum(axis=1, keepdims=True) / (sides[0]**2).sum(axis=1, keepdims=True)
    sides[1] -= along * sides[0]
    quads[:, 1], quads[:, 2], quads[:, 3] = sides[0], sides[0] + sides[1], sides[1]
    quads[::8] = np.array(((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)))
    kites = quads[:10] + 0.3 * rng.normal(size=(10, 4, 3))
    kites[:, 3] += kites[:, 0] - kites[:, 2]
    for corners in (quads, kites):
        split = np.array(((0, 1, 2), (2, 3, 0)))
        triangles = corners[:, split].reshape(-1, 3, 3)
        places = room("addon.baking.texels.atlas").packed(triangles, 20.0)
        one, other = places.spots[::2], places.spots[1::2]
        # corners 0 and 2 are ends of the diagonal
        apart = np.linalg.norm(one[:, (0, 2)] - other[:, (2, 0)], axis=2).max(axis=1)
        assert (apart < 1e-3).all() if corners is quads else (apart > 0.9).all()
        owner = np.full((places.size, places.size), -1)
        for number, spots in enumerate(places.spots):
            # of the texels round the triangle
            low, high = np.floor(spots.min(axis=0)).astype(int), np.ceil(spots.max(axis=0)).astype(int)
            rows, columns = np.mgrid[low[1]:high[1], low[0]:high[0]] + 0.5
            turns = [(end[0] - start[0]) * (rows - start[1]) - (end[1] - start[1]) * (columns - start[0])
                     for start, end in zip(spots, np.roll(spots, -1, axis=0))]
            # on the diagonal itself a texel is of both
            inside = (np.array(turns) > 1e-3).all(axis=0) | (np.array(turns) < -1e-3).all(axis=0)
            among = owner[low[1]:high[1], low[0]:high[0]]
            assert inside.any() and (among[inside] == -1).all()
            among[inside] = number


@pytest.mark.slow
@pytest.mark.parametrize("patterned", [False, True])
def test_no_diagonal_is_seen_on_a_wall_of_two_triangles(blank, room, patterned):
    """A wall with a lamp close to it, against Cycles: where its two triangles meet it is as bright as there."""
    made = principled("Plaster", (0.8, 0.8, 0.8), **{"Specular IOR Level": 0.0})
    if patterned:
        tree = made.node_tree
        noise = tree.nodes.new("ShaderNodeTexNoise")
        noise.inputs["Scale"].default_value = 60.0
        link(tree, noise.outputs["Color"], shader_of(made).inputs["Base Color"])
    card_scene(blank, made)
    blank.scene.world.color = (0.0, 0.0, 0.0)
    bpy.ops.object.light_add(type="POINT", location=(0.0, -7.2, 1.0))
    lamp = blank.object
    lamp.data.energy, lamp.visible_glossy, lamp.visible_camera = 25.0, False, False
    card = bpy.data.objects["Card"]
    parts.select(card, bpy.data.objects["Mirror"])
    reference = picture(room)
    parts.generate()
    light()
    error = (picture(room) - reference).mean(axis=2)[28:-6, 12:-12]
    # noise is one pixel's, a diagonal or a blotch is that of many side by side
    around = np.lib.stride_tricks.sliding_window_view(error, (5, 5))
    assert np.abs(np.median(around, axis=(2, 3))).max() < 0.005


@pytest.mark.thorough
def test_no_seam_is_seen_where_triangles_meet(blank, room):
    """Of a card that is one colour, also along its diagonal."""
    card_scene(blank, principled("Paper", (0.8, 0.8, 0.8), **{"Specular IOR Level": 0.0}))
    reference = picture(room)[20:-20, 20:-20]
    parts.generate()
    light()
    shown = picture(room)[20:-20, 20:-20]
    assert np.abs(shown - reference).mean() < 0.01
    card = shown[len(shown) // 3:]
    assert np.abs(card - np.median(card)).max() < 0.02


@pytest.mark.slow
def test_corners_have_no_spots(blank, room):
    """Of boxes that stand on a mirror: the mean of nine pixels is nowhere far from Cycles'."""
    scene_of(blank)
    scene = blank.scene
    for obj in [obj for obj in bpy.data.objects if obj.name in ("Mirror", "Box")]:
        bpy.data.objects.remove(obj)
    floor, lamp = bpy.data.objects["Floor"], next(obj for obj in bpy.data.objects if obj.type == "LIGHT")
    floor.data.materials[0], floor.location = mirror_material(""), (0.0, 0.0, 0.0)
    scene.camera.location, scene.camera.rotation_euler = (0.0, -4.0, 1.6), (1.25, 0.0, 0.0)
    lamp.location, lamp.rotation_euler, lamp.data.energy = (-2.0, -2.0, 3.0), (0.6, -0.5, 0.0), 150.0
    scene.world.color = (0.3, 0.35, 0.4)
    boxes = [parts.add("cube", "Box", size=0.6, location=(place, 0.1 * turn, 0.3), rotation=(0.0, 0.0, 0.3 * turn))
             for turn, place in enumerate((-0.9, 0.1, 1.0))]
    for box, colour in zip(boxes, ((0.7, 0.2, 0.1), (0.7, 0.7, 0.7), (0.1, 0.5, 0.2))):
        box.data.materials.append(principled("Paint", colour))
    # large enough to be denoised
    scene.render.resolution_x, scene.render.resolution_y, scene.cycles.samples = 144, 120, 128
    parts.select(*boxes, floor)
    reference = picture(room)
    parts.generate()
    light(64)
    apart = picture(room) - reference
    assert np.abs(room("addon.rendering").sum_around(apart) / 9.0).max() < 0.06
