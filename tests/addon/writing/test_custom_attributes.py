"""Attributes that materials ask for: a reflection shows them as Cycles shows them in the mirror, of any type, on any
domain; what no material asks for is not carried."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest

SIZE = 96
TYPES = {"FLOAT": ("value", 1), "INT": ("value", 1), "INT8": ("value", 1), "BOOLEAN": ("value", 1),
         "FLOAT2": ("vector", 2), "FLOAT_VECTOR": ("vector", 3), "FLOAT_COLOR": ("color", 4),
         "BYTE_COLOR": ("color", 4)}


def glow(name: str, output: str = "Color", kind: str = "ShaderNodeAttribute", **settings) -> bpy.types.Material:
    """A material that emits what one output of a node reads."""
    made = parts.material(name)
    tree = made.node_tree
    node = tree.nodes.new(kind)
    for key, value in settings.items():
        setattr(node, key, value)
    tree.links.new(node.outputs[output], tree.nodes["Emission"].inputs["Color"])
    return made


def add_attribute(obj: bpy.types.Object, name: str, kind: str, domain: str, seed: int = 1) -> None:
    """Random values, between 0 and 1 where the type has those."""
    attribute, (field, width) = obj.data.attributes.new(name, kind, domain), TYPES[kind]
    values = np.random.default_rng(seed).random(len(attribute.data) * width)
    if kind in {"INT", "INT8", "BOOLEAN"}:
        values = np.round(values)
    number = {"INT": np.int32, "INT8": np.int8, "BOOLEAN": bool}.get(kind, np.float32)
    attribute.data.foreach_set(field, values.astype(number))


def board_and_mirror(context: bpy.types.Context) -> bpy.types.Object:
    """A board of some quads behind the camera's back that a wall mirror shows; returns the board."""
    scene = context.scene
    scene.render.engine, scene.view_settings.view_transform = "CYCLES", "Standard"
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    board = parts.add("grid", "Board", x_subdivisions=5, y_subdivisions=4, size=3.0, location=(0.0, -7.5, 1.0),
                      rotation=(-np.pi / 2, 0.0, 0.3))
    mirror = parts.add_wall_mirror()
    mirror.data.materials.append(parts.material("Chrome", "GLOSSY"))
    mirror.data.materials[0].node_tree.nodes[0].inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    return board


def picture(room) -> np.ndarray:
    """What Cycles shows of the file, (height, width, 3), in linear light."""
    rendering, scene = room("addon.rendering"), bpy.context.scene.copy()
    try:
        rendering.with_cycles(scene)
        scene.cycles.samples, scene.cycles.use_denoising = 64, False
        return rendering.rendered(scene)[..., :3]
    finally:
        bpy.data.scenes.remove(scene)


def generated_as_mirrored(room, **options) -> bpy.types.Object:
    """The result, which a render shows as the mirror was."""
    parts.select(*[obj for obj in bpy.data.objects if obj.type == "MESH"])
    bpy.context.view_layer.objects.active = bpy.data.objects["Mirror"]
    mirrored = picture(room)
    assert mirrored.std() > 0.05
    result = parts.generate(**options)
    assert np.sqrt(np.square(picture(room) - mirrored).mean()) < 0.01
    return result


@pytest.mark.thorough
@pytest.mark.parametrize(("kind", "domain", "output"), [
    *((kind, domain, "Color") for kind in TYPES for domain in ("POINT", "CORNER", "FACE")),
    *((kind, "POINT", "Fac") for kind in TYPES)])
def test_attribute_nodes_show_what_the_mirror_shows(blank, room, kind, domain, output):
    board = board_and_mirror(blank)
    add_attribute(board, "warmth", kind, domain)
    board.data.materials.append(glow("Heat", output, attribute_name="warmth"))
    result = generated_as_mirrored(room)
    assert "warmth" in result.data.attributes


def test_colour_attribute_nodes_show_colours_of_faces(blank, room):
    board = board_and_mirror(blank)
    add_attribute(board, "paint", "FLOAT_COLOR", "FACE")
    board.data.materials.append(glow("Paint", kind="ShaderNodeVertexColor", layer_name="paint"))
    generated_as_mirrored(room)


def test_nodes_in_groups_ask_too(blank, room):
    board = board_and_mirror(blank)
    add_attribute(board, "warmth", "FLOAT_VECTOR", "POINT")
    group = bpy.data.node_groups.new("Asks", "ShaderNodeTree")
    group.interface.new_socket("Heat", in_out="OUTPUT", socket_type="NodeSocketColor")
    node = group.nodes.new("ShaderNodeAttribute")
    node.attribute_name = "warmth"
    group.links.new(node.outputs["Color"], group.nodes.new("NodeGroupOutput").inputs[0])
    made = parts.material("Heat")
    user = made.node_tree.nodes.new("ShaderNodeGroup")
    user.node_tree = group
    made.node_tree.links.new(user.outputs[0], made.node_tree.nodes["Emission"].inputs["Color"])
    board.data.materials.append(made)
    generated_as_mirrored(room)


def test_objects_of_which_one_has_it_as_a_number_one_as_a_vector_and_one_not_at_all(blank, room):
    """The last shows black, as in the mirror."""
    board = board_and_mirror(blank)
    add_attribute(board, "warmth", "INT", "FACE")
    heat = glow("Heat", attribute_name="warmth")
    board.data.materials.append(heat)
    for index, kind in enumerate(("FLOAT_VECTOR", "")):
        other = parts.add("grid", f"Other {index}", x_subdivisions=3, y_subdivisions=3, size=1.0,
                          location=(1.2 - 2.4 * index, -6.5, 2.0), rotation=(-np.pi / 2, 0.0, 0.0))
        other.data.materials.append(heat)
        if kind:
            add_attribute(other, "warmth", kind, "POINT", seed=2)
    generated_as_mirrored(room)


def test_attributes_that_modifiers_make(blank, room):
    """Of the evaluated mesh: here by Geometry Nodes."""
    board = board_and_mirror(blank)
    tree = bpy.data.node_groups.new("Heats", "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    nodes = {name: tree.nodes.new(name) for name in ("NodeGroupInput", "NodeGroupOutput", "GeometryNodeInputPosition",
                                                     "GeometryNodeStoreNamedAttribute")}
    store = nodes["GeometryNodeStoreNamedAttribute"]
    store.data_type, store.domain = "FLOAT_VECTOR", "POINT"
    store.inputs["Name"].default_value = "place"
    value = next(socket for socket in store.inputs if socket.name == "Value" and socket.enabled)
    tree.links.new(nodes["NodeGroupInput"].outputs[0], store.inputs["Geometry"])
    tree.links.new(nodes["GeometryNodeInputPosition"].outputs[0], value)
    tree.links.new(store.outputs[0], nodes["NodeGroupOutput"].inputs[0])
    board.modifiers.new("Heats", "NODES").node_group = tree
    board.data.materials.append(glow("Place", "Vector", attribute_name="place"))
    generated_as_mirrored(room)


def test_only_what_is_asked_for_is_carried(blank):
    board = board_and_mirror(blank)
    for name in ("warmth", "wind"):
        add_attribute(board, name, "FLOAT", "POINT")
    board.data.materials.append(glow("Heat", attribute_name="warmth"))
    parts.select(board, bpy.data.objects["Mirror"])
    names = set(parts.generate().data.attributes.keys())
    assert "warmth" in names and "wind" not in names


@pytest.mark.parametrize("name", ["path_length", "sharp_face", "material_index", "position"])
def test_names_that_a_result_needs_for_itself_stay_its_own(blank, name):
    board = board_and_mirror(blank)
    if name not in board.data.attributes:
        add_attribute(board, name, "BOOLEAN" if name == "sharp_face" else "INT", "FACE")
    board.data.materials.append(glow("Heat", attribute_name=name))
    parts.select(board, bpy.data.objects["Mirror"])
    result = parts.generate()
    kinds = {"path_length": "FLOAT", "position": "FLOAT_VECTOR", "material_index": "INT", "sharp_face": "BOOLEAN"}
    known = result.data.attributes.get(name)
    assert known is None or known.data_type == kinds[name]
    assert np.isfinite(parts.attribute(result, "position")).all() and not result.data.validate(verbose=True)


@pytest.mark.thorough
@pytest.mark.parametrize("kind", ["FLOAT", "FLOAT_VECTOR", "FLOAT_COLOR"])
def test_points_have_them_too(blank, room, kind):
    board = board_and_mirror(blank)
    add_attribute(board, "warmth", kind, "FACE")
    board.data.materials.append(glow("Heat", attribute_name="warmth"))
    board.modifiers.new("Finer", "SUBSURF").levels = 5
    board.modifiers[0].render_levels, board.modifiers[0].subdivision_type = 5, "SIMPLE"
    parts.select(board, bpy.data.objects["Mirror"])
    mirrored = picture(room)
    parts.generate(method="POINTS")
    # discs have one value each: borders of faces are ragged by half a disc
    assert np.sqrt(np.square(picture(room) - mirrored).mean()) < 0.06
