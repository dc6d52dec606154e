"""Light that mirrors throw, in Blender: as bright as in Cycles, one object per mirror and lamp, and back again."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from caustic_scene import (
    AIM,
    ALBEDO,
    LAMPS,
    SIZE,
    TINT,
    add_lamp,
    inner,
    light_and_lamp_behind,
    paint,
    rendered,
    scene_of,
)


@pytest.mark.feature("caustics")
@pytest.mark.parametrize("kind", LAMPS)
def test_it_is_as_bright_as_the_lamp_behind_a_flat_mirror(blank, tmp_path, kind):
    floor, mirror, lamp = scene_of(kind)
    blank.scene.cycles.max_bounces = 0  # light from floor to mirror to floor is noise here
    light, expected = light_and_lamp_behind(mirror, lamp, tmp_path)
    ratio = (light / np.maximum(expected, 1e-12))[inner(light)]
    assert len(ratio) > 500
    assert np.abs(np.median(ratio, axis=0) - 1.0).max() < 2e-3
    assert np.percentile(np.abs(ratio - 1.0), 75) < 0.01


def emission(lamp: bpy.types.Object) -> bpy.types.Node:
    """The node by which a lamp shines, from now on."""
    lamp.data.use_nodes = True
    return next(node for node in lamp.data.node_tree.nodes if node.type == "EMISSION")


@pytest.mark.thorough
@pytest.mark.parametrize("colour", ["plain", 2500.0, 6500.0])
def test_a_lamps_nodes_colour_and_strengthen_its_light(blank, tmp_path, capfd, colour):
    """As Cycles shows it; what is plugged into them is told, but for what is the same everywhere, and portals are no
    lamps."""
    floor, mirror, lamp = scene_of()
    blank.scene.cycles.max_bounces = 0
    shader, tree = emission(lamp), lamp.data.node_tree
    shader.inputs["Color"].default_value, shader.inputs["Strength"].default_value = (0.2, 1.0, 0.6, 1.0), 3.0
    if colour != "plain":
        warm, strength = tree.nodes.new("ShaderNodeBlackbody"), tree.nodes.new("ShaderNodeValue")
        warm.inputs[0].default_value, strength.outputs[0].default_value = colour, 3.0
        tree.links.new(warm.outputs[0], shader.inputs["Color"])
        tree.links.new(strength.outputs[0], shader.inputs["Strength"])
    light, expected = light_and_lamp_behind(mirror, lamp, tmp_path)
    ratio = (light / np.maximum(expected, 1e-12))[inner(light)]
    # the observer's colours are sums of a few waves; blue is the smallest of a warm light's
    assert len(ratio) > 500 and np.abs(np.median(ratio, axis=0) - 1.0).max() < (2e-3 if colour == "plain" else 0.03)
    assert "tell more than one colour" not in capfd.readouterr().out
    if colour != "plain":
        return
    tree.links.new(tree.nodes.new("ShaderNodeTexChecker").outputs[0], shader.inputs["Color"])
    mirror.hide_render = False
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    assert "The nodes of 'Lamp' tell more than one colour" in capfd.readouterr().out
    tree.links.remove(tree.nodes["Light Output"].inputs["Surface"].links[0])
    assert "gives no light" in parts.refusal(bpy.ops.reflection_mesh.caustics)
    lamp.data.type = "AREA"
    lamp.data.cycles.is_portal = True
    assert "no lamp" in parts.refusal(bpy.ops.reflection_mesh.caustics)


def test_a_metal_is_whiter_at_a_grazing_angle(blank, room):
    tint = room("addon.illumination").Tint
    mirror = parts.add("plane", "Mirror")
    mirror.data.materials.append(paint("Metal", "PRINCIPLED", TINT, "Base Color"))
    found = tint.of(mirror).at(np.array([[1.0, 0.5, 0.0]]))
    schlick = np.array(TINT) + (1.0 - np.array(TINT)) * 0.5**5
    assert np.allclose(found[0, 0], TINT) and np.allclose(found[0, 1], schlick) and np.allclose(found[0, 2], 1.0)


def test_one_object_per_mirror_and_lamp_updated_in_place_and_cleared(blank):
    floor, mirror, lamp = scene_of(shadow_soft_size=0.1)
    other = add_lamp("Other", "SUN", (0.0, -1.0, 3.0))
    other.data.angle = 0.1
    parts.select(floor, lamp, other, mirror)
    before = parts.state()
    for _ in range(2):
        assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
        made = sorted(obj.name for obj in bpy.data.objects if obj.reflection_mesh.role == "CAUSTICS")
        assert made == ["Mirror Caustics Lamp", "Mirror Caustics Other"]
        assert len(bpy.data.meshes) == len(before["data"]["meshes"]) + 2
        assert len(bpy.data.materials) == len(before["data"]["materials"]) + 2
    result = bpy.data.objects["Mirror Caustics Lamp"]
    record = result.reflection_mesh
    assert (record.mirror, record.lamp, [source.object for source in record.sources]) == (mirror, lamp, [floor])
    assert record.faces == len(result.data.polygons) > 0
    assert not any(getattr(result, name) for name in ("visible_diffuse", "visible_volume_scatter", "visible_shadow"))
    assert {"irradiance", "caustic_light", "mirror_position", "image_parity", "source_object", "source_face",
            "UVMap"} <= set(result.data.attributes.keys())
    heights = np.array([(result.matrix_world @ vertex.co).z for vertex in result.data.vertices])
    assert 0.0 < heights.min() and heights.max() < 0.01
    linked = lamp.light_linking.receiver_collection
    assert [child.light_linking.link_state for child in linked.collection_objects] == ["EXCLUDE"]
    assert bpy.ops.reflection_mesh.clear() == {"FINISHED"}
    assert parts.state() == before and lamp.light_linking.receiver_collection is None


def test_the_lamp_lights_the_mirror_again_when_the_last_of_its_light_goes(blank):
    """A copy that is cleared leaves it; and what was deleted by hand leaves nothing behind that Clear does not find."""
    floor, mirror, lamp = scene_of(shadow_soft_size=0.1)
    collections = list(bpy.data.collections)
    assert bpy.ops.reflection_mesh.caustics() == {"FINISHED"}
    result = bpy.data.objects["Mirror Caustics"]
    linked = lamp.light_linking.receiver_collection
    copy = result.copy()
    blank.scene.collection.objects.link(copy)
    blank.view_layer.update()
    parts.select(copy)
    assert bpy.ops.reflection_mesh.clear() == {"FINISHED"}
    assert lamp.light_linking.receiver_collection == linked and list(linked.objects) == [mirror]
    parts.select(result)
    bpy.ops.object.delete()
    assert bpy.ops.reflection_mesh.clear() == {"FINISHED"}
    assert lamp.light_linking.receiver_collection is None and list(bpy.data.collections) == collections
    assert bpy.ops.reflection_mesh.clear() == {"CANCELLED"}


@pytest.mark.thorough
def test_the_light_is_there_once(blank, tmp_path):
    """Cycles' own light from a lamp of some size goes where the mesh brings it."""
    floor, mirror, lamp = scene_of(shadow_soft_size=0.3)
    own = rendered(tmp_path, 400)
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT", eyes=4) == {"FINISHED"}
    ours = rendered(tmp_path, 64)
    assert bpy.ops.reflection_mesh.clear() == {"FINISHED"}
    bpy.context.scene.cycles.caustics_reflective = False
    none = rendered(tmp_path, 64)
    light = ours - none
    assert abs(light.sum() / (own - none).sum() - 1.0) < 0.1
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    # where the file has no caustics there are none to leave out
    assert lamp.light_linking.receiver_collection is None


def test_a_texture_colours_the_light(blank, tmp_path):
    floor, mirror, lamp = scene_of()
    image = bpy.data.images.new("Halves", 2, 1)
    image.pixels.foreach_set(np.array([1, 0, 0, 1, 0, 0, 1, 1], dtype=np.float32))
    tree = floor.active_material.node_tree
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image, node.interpolation = image, "Closest"
    tree.links.new(node.outputs["Color"], tree.nodes[0].inputs["Color"])
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    with_light = rendered(tmp_path)
    bpy.data.objects["Mirror Caustics"].hide_render = True
    light = with_light - rendered(tmp_path)
    left, right = light[:, :SIZE // 2 - 1].sum(axis=(0, 1)), light[:, SIZE // 2 + 1:].sum(axis=(0, 1))
    assert left[0] > 100.0 * left[2] and right[2] > 100.0 * right[0]


def test_what_stands_in_the_way_takes_no_part_and_shades(blank):
    floor, mirror, lamp = scene_of()

    def nearest() -> float:
        """How near to the wall's shadow on the mirror light is thrown from."""
        assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
        places = parts.attribute(bpy.data.objects["Mirror Caustics"], "mirror_position")
        faces = places[parts.corners(bpy.data.objects["Mirror Caustics"])].mean(axis=1)
        return np.linalg.norm(faces - np.array(AIM), axis=1).min()
    before = nearest()
    middle = 0.5 * (AIM + lamp.location)
    parts.add("cube", "Wall", size=0.2, location=middle)
    parts.select(floor, lamp, mirror)
    # at half the way its shadow is twice as wide
    assert before < 0.1 and 0.19 < nearest() < 0.25


def test_it_is_told_what_is_missing(blank):
    floor, mirror, lamp = scene_of()
    lamp.data.energy = 0.0
    assert "gives no light" in parts.refusal(bpy.ops.reflection_mesh.caustics)
    lamp.data.energy = 10.0
    floor.location.z = 50.0
    blank.view_layer.update()
    assert "throws none" in parts.refusal(bpy.ops.reflection_mesh.caustics)
    lamp.location = AIM
    blank.view_layer.update()
    assert "lies on the mirror" in parts.refusal(bpy.ops.reflection_mesh.caustics)
    lamp.hide_render = True
    assert "no lamp" in parts.refusal(bpy.ops.reflection_mesh.caustics)


def test_a_stop_in_the_middle_leaves_nothing(blank, room):
    floor, mirror, lamp = scene_of()
    before = parts.state()
    place, reading = room("addon.operators.caustics"), room("addon.reading")
    settings = room("core").Settings()
    wanted = place.Asked(2, lambda mirror: settings, True)
    steps = place.throwing(blank, reading.choose(blank), [lamp], wanted)
    for share, _ in steps:
        if share > 0.5:
            break
    steps.close()
    assert parts.state() == before


def test_the_verb_writes_a_file(blank, room, tmp_path):
    scene_of()
    path = tmp_path / "lit.blend"
    run = room("addon.command_line.verbs").run
    assert run(["caustics", "--mirror", "Mirror", "--diffuse", "Floor", "--eyes", "2", "--output", str(path)]) == 0
    bpy.ops.wm.open_mainfile(filepath=str(path))
    assert bpy.data.objects["Mirror Caustics"].reflection_mesh.lamp == bpy.data.objects["Lamp"]
    assert run(["caustics", "--eyes", "0", "--output", str(path)]) == 1


@pytest.mark.slow
def test_cycles_is_let_follow_all_layers_until_the_light_is_cleared(blank, tmp_path, capfd):
    scene_of(shadow_soft_size=0.1)
    cycles = blank.scene.cycles
    cycles.transparent_max_bounces = 5
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT", eyes=4) == {"FINISHED"}
    assert cycles.transparent_max_bounces == 5
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT", eyes=8) == {"FINISHED"}
    told = "Cycles followed 5 transparent layers, and 8 or more of light have to be passed"
    assert told in capfd.readouterr().out
    assert cycles.transparent_max_bounces == 16
    seen = rendered(tmp_path)
    cycles.transparent_max_bounces = 5
    dark = (rendered(tmp_path) < 0.9 * seen).all(axis=2)
    cycles.transparent_max_bounces = 256
    assert np.allclose(seen, rendered(tmp_path)) and dark.sum() > 100
    cycles.transparent_max_bounces = 16
    # what goes by hand is brought back as what is cleared is
    bpy.data.objects.remove(bpy.data.objects["Mirror Caustics"])
    assert bpy.ops.reflection_mesh.clear() == {"FINISHED"}
    assert cycles.transparent_max_bounces == 5
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT", eyes=8) == {"FINISHED"}
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT", eyes=20) == {"FINISHED"}
    assert cycles.transparent_max_bounces == 40
    assert bpy.ops.reflection_mesh.clear() == {"FINISHED"}
    assert cycles.transparent_max_bounces == 5
    assert "reflection_mesh_transparent_layers" not in blank.scene


def test_a_number_of_layers_that_the_user_changed_stays(blank):
    scene_of(shadow_soft_size=0.1)
    cycles = blank.scene.cycles
    cycles.transparent_max_bounces = 5
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT", eyes=8) == {"FINISHED"}
    cycles.transparent_max_bounces = 50
    assert bpy.ops.reflection_mesh.clear() == {"FINISHED"}
    assert cycles.transparent_max_bounces == 50


@pytest.mark.thorough
def test_layers_that_a_shiny_floor_mirrors_once_more_are_followed(blank):
    floor, _, _ = scene_of(shadow_soft_size=0.1)
    cycles = blank.scene.cycles
    floor.data.materials[0] = varnish = paint("Varnish", "PRINCIPLED", ALBEDO, "Base Color")
    values = varnish.node_tree.nodes[0].inputs
    values["Metallic"].default_value = 0.0
    for eyes, specular, followed in ((4, 0.5, 8), (5, 0.0, 8), (5, 0.5, 20)):
        cycles.transparent_max_bounces = 8
        values["Specular IOR Level"].default_value = specular
        assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT", eyes=eyes) == {"FINISHED"}
        assert cycles.transparent_max_bounces == followed


def test_what_is_lit_as_well_as_it_mirrors_stays_lit(blank, room, tmp_path, capfd):
    """A frame of the mirror's own object, or water over its ground, is not taken out of what the lamp lights."""
    floor, mirror, lamp = scene_of(shadow_soft_size=0.1)
    mirror.data.materials.append(paint("Wood", "DIFFUSE", ALBEDO))
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    assert "which is lit as well as it mirrors" in capfd.readouterr().out
    assert lamp.light_linking.receiver_collection is None
    # what has the role alone makes none
    mirror.data.materials.clear()
    mirror.data.materials.append(floor.active_material)
    mirror.reflection_mesh.role = "MIRROR"
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    assert "as it mirrors" not in capfd.readouterr().out and lamp.light_linking.receiver_collection is None


@pytest.mark.thorough
@pytest.mark.parametrize("gloss", ["PRINCIPLED", "mixed"])
def test_a_glossy_floor_counts_its_layers_twice(blank, gloss):
    """What it mirrors of itself, as by a wall that it shows, lies under as many again."""
    floor, mirror, lamp = scene_of(shadow_soft_size=0.1)
    tree = floor.active_material.node_tree
    if gloss == "mixed":
        both, shine = tree.nodes.new("ShaderNodeMixShader"), tree.nodes.new("ShaderNodeBsdfAnisotropic")
        both.inputs[0].default_value = 0.2
        tree.links.new(tree.nodes[0].outputs[0], both.inputs[1])
        tree.links.new(shine.outputs[0], both.inputs[2])
        tree.links.new(both.outputs[0], tree.get_output_node("ALL").inputs["Surface"])
    else:
        floor.data.materials[0] = paint("Varnish", "PRINCIPLED", ALBEDO, "Base Color")
        floor.active_material.node_tree.nodes[0].inputs["Metallic"].default_value = 0.0
        floor.active_material.node_tree.nodes[0].inputs["Roughness"].default_value = 0.3
    blank.scene.cycles.transparent_max_bounces = 8
    # six layers that are passed there and back
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT", eyes=6) == {"FINISHED"}
    assert blank.scene.cycles.transparent_max_bounces >= 12
