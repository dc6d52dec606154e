"""What nearer faces hide whole is left out of dense scenes, unless light comes through, or the user asks for it."""
import bpy
import numpy as np
import parts
import pytest


def opened(what: str) -> bpy.types.Material:
    """A material that lets light through, in one of the ways that there are."""
    material = parts.material(f"Open by {what}", "PRINCIPLED" if what in ("alpha", "alpha by a texture", "transmission")
                              else "EMISSION")
    nodes, links = material.node_tree.nodes, material.node_tree.links
    shader = next((node for node in nodes if node.type == "BSDF_PRINCIPLED"), None)
    if what == "alpha":
        shader.inputs["Alpha"].default_value, shader.inputs["Metallic"].default_value = 0.5, 0.0
    elif what == "transmission":
        shader.inputs["Transmission Weight"].default_value = 1.0
    elif what == "alpha by a texture":
        links.new(nodes.new("ShaderNodeTexNoise").outputs[0], shader.inputs["Alpha"])
    elif what == "a group":
        tree = bpy.data.node_groups.new("Group", "ShaderNodeTree")
        tree.nodes.new("ShaderNodeBsdfTransparent")
        nodes.new("ShaderNodeGroup").node_tree = tree
    else:
        nodes.new(what)
    return material


@pytest.mark.parametrize("what", ["alpha", "alpha by a texture", "transmission", "a group", "ShaderNodeBsdfTransparent",
                                  "ShaderNodeBsdfGlass", "ShaderNodeBsdfRefraction", "ShaderNodeHoldout"])
def test_materials_that_let_light_through(blank, room, what):
    assert not room("addon.reading.materials.opaque_materials").is_opaque(opened(what))


@pytest.mark.parametrize("kind", ["EMISSION", "GLOSSY", "PRINCIPLED"])
def test_opaque_materials(blank, room, kind):
    is_opaque = room("addon.reading.materials.opaque_materials").is_opaque
    assert is_opaque(parts.material("Opaque", kind)) and is_opaque(None)


@pytest.fixture
def dense_scene(blank):
    """A ball that mirrors two dense plates, one behind the other."""
    ball = parts.add("uv_sphere", "Ball", segments=24, ring_count=16, radius=1.0, location=(0.0, 0.0, 1.0))
    ball.data.polygons.foreach_set("use_smooth", np.ones(len(ball.data.polygons), dtype=bool))
    ball.data.materials.append(parts.material("Chrome", "GLOSSY"))
    plates = [parts.add("grid", name, x_subdivisions=80, y_subdivisions=80, size=size, location=(0.0, -3.0, height))
              for name, size, height in (("Near", 4.0, -0.2), ("Far", 1.5, -0.4))]
    for plate in plates:
        plate.data.materials.append(parts.material("Paint"))
    parts.select(*plates, ball)
    return ball, *plates


def shown(result: bpy.types.Object, name: str) -> int:
    """How many faces of the result show an object."""
    index = [source.object.name for source in result.reflection_mesh.sources].index(name)
    return int((parts.attribute(result, "source_object") == index).sum())


def test_what_is_hidden_whole_is_left_out(dense_scene, room):
    near, far = (shown(parts.generate(), name) for name in ("Near", "Far"))
    assert near > 2000 and far < 200
    counts = room("addon.writing.records").counts(bpy.context.object)
    assert counts["whole"] > 2000 and counts["hidden"] > 2000


def test_all_of_the_geometry_where_it_is_asked_for(dense_scene):
    assert shown(parts.generate(hidden_faces=True), "Far") > 2000


def test_all_of_the_geometry_where_light_comes_through(dense_scene):
    _, near, _ = dense_scene
    near.data.materials[0] = opened("alpha")
    assert shown(parts.generate(), "Far") > 2000


def test_a_glass_object_keeps_nothing_but_what_lies_behind_it(dense_scene):
    """Check that one transparent source does not keep the hidden faces of all others, which took ten times as many."""
    ball, near, far = dense_scene
    before = {obj: shown(parts.generate(), obj.name) for obj in (near, far)}
    glass = parts.add("uv_sphere", "Glass", segments=16, ring_count=8, radius=0.25, location=(-0.6, -2.2, 1.2))
    glass.data.materials.append(opened("ShaderNodeBsdfGlass"))
    parts.select(near, far, glass, ball)
    result = parts.generate()
    after = {obj: shown(result, obj.name) for obj in (near, far)}
    assert shown(result, "Glass") > 100 and after[far] < 200
    assert before[near] <= 1.02 * after[near] and after[near] < 1.1 * before[near]
