"""A mirror whose caustics are a mesh goes on to show the lamp, as before; and no caustics come of that."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from caustic_scene import AIM, add_mesh_lamp, aim, rendered, scene_of
from mathutils import Vector

SIZES = {"POINT": {"shadow_soft_size": 0.2}, "SPOT": {"shadow_soft_size": 0.2, "spot_size": 1.0},
         "SUN": {"angle": 0.2}, "AREA": {"size": 0.4}}


def looked_into(kind: str = "POINT") -> tuple:
    """The scene of `scene_of`, seen so that the mirror shows the lamp."""
    floor, mirror, lamp = scene_of(kind, **SIZES[kind]) if kind in SIZES else with_mesh(kind)
    scene, camera = bpy.context.scene, bpy.context.scene.camera
    behind = Vector((2.0 * AIM.x - lamp.location.x, *lamp.location[1:]))
    camera.location = AIM + 1.2 * (AIM - behind).normalized()  # just above the floor
    camera.rotation_euler = (behind - camera.location).to_track_quat("-Z", "Y").to_euler()
    camera.data.type, camera.data.lens = "PERSP", 20.0
    # Cycles by default
    scene.cycles.blur_glossy, scene.cycles.max_bounces = 1.0, 3
    return floor, mirror, lamp


def with_mesh(kind: str) -> tuple:
    """The scene of `scene_of` with a mesh that emits; a sheet shows its back."""
    floor, mirror, lamp = scene_of()
    bpy.data.objects.remove(lamp)
    lamp = add_mesh_lamp(kind.removesuffix(" back"))
    lamp.scale = (2.0, 2.0, 2.0)
    if kind.endswith("back"):
        lamp.rotation_euler.rotate_axis("X", np.pi)
    parts.select(floor, lamp, mirror)
    return floor, mirror, lamp


def of_lamp(picture: np.ndarray) -> np.ndarray:
    """Pixels that show a lamp."""
    return picture[..., 0] > 0.5 * picture.max()


@pytest.mark.thorough
@pytest.mark.parametrize("kind", [*SIZES, "panel", "panel back", "ball", "box"])
def test_the_mirror_shows_the_lamp_and_throws_no_light_of_it(blank, tmp_path, kind):
    floor, mirror, lamp = looked_into(kind)
    before = rendered(tmp_path)
    bpy.context.scene.cycles.caustics_reflective = False
    without = rendered(tmp_path)
    bpy.context.scene.cycles.caustics_reflective = True
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    bpy.data.objects["Mirror Caustics"].hide_render = True
    found = rendered(tmp_path)
    shown = of_lamp(without)
    assert 10 < shown.sum() < 1000
    assert np.abs(found[shown].mean(axis=0) / before[shown].mean(axis=0) - 1.0).max() < 0.01
    # what Cycles finds by chance is not little
    by_chance = before[~shown].mean() - without[~shown].mean()
    assert by_chance > 0.05 * without[~shown].mean()
    assert np.abs(found[~shown].mean() - without[~shown].mean()) < 0.1 * by_chance
    lamp.children[0].hide_render = True
    assert rendered(tmp_path)[shown].mean() < 0.5 * before[shown].mean()


def test_it_goes_where_the_lamp_goes_and_has_its_nodes(blank, tmp_path):
    floor, mirror, lamp = looked_into("SPOT")
    lamp.data.use_nodes = True
    tree = lamp.data.node_tree
    shader = next(node for node in tree.nodes if node.type == "EMISSION")
    warm = tree.nodes.new("ShaderNodeBlackbody")
    warm.inputs[0].default_value = 3000.0
    tree.links.new(warm.outputs[0], shader.inputs["Color"])
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    bpy.data.objects["Mirror Caustics"].hide_render = True
    aim(lamp, lamp.location + Vector((0.0, 0.25, 0.1)))
    found = rendered(tmp_path)
    assert bpy.ops.reflection_mesh.clear() == {"FINISHED"}
    expected = rendered(tmp_path)
    shown = of_lamp(expected)
    assert shown.sum() >= 8 and np.abs(found[shown].mean(axis=0) / expected[shown].mean(axis=0) - 1.0).max() < 0.01


def thrown_as_by_live(room) -> None:
    """Makes light anew, and neither leaves anything more out nor brings it back."""
    context, light = bpy.context, room("addon.operators.caustics")
    asked = light.Asked(1, room("addon.settings").Wanted(context.scene), False)
    lamps = room("addon.illumination").chosen_lamps(context)
    for _ in light.throwing(context, room("addon.reading").choose(context), lamps, asked):
        pass


def test_it_is_made_anew_with_the_light_and_as_bright_as_the_lamp(blank, room):
    floor, mirror, lamp = looked_into()
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    made = parts.state()["data"]
    lamp.data.energy, lamp.data.shadow_soft_size = 30.0, 0.1
    thrown_as_by_live(room)
    glint, = lamp.children
    assert (glint.data.energy, round(glint.data.shadow_soft_size, 6)) == (30.0, 0.1)
    lamp.data.use_nodes = True
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    assert parts.state()["data"] == made and [child.data.energy for child in lamp.children] == [30.0]


def test_it_counts_as_no_lamp(blank, room):
    floor, mirror, lamp = looked_into("AREA")
    fresh, lamps = room("addon.freshness.lamps").lamps_of, room("addon.lamps").lamps_that_show
    before, shown = fresh(bpy.context), len(lamps(bpy.context))
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    bpy.context.view_layer.update()
    glint, = lamp.children
    assert fresh(bpy.context) == before and len(lamps(bpy.context)) == shown == 1
    parts.select(floor, glint, mirror)
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    assert [obj.name for obj in bpy.data.objects if obj.reflection_mesh.role == "CAUSTICS"] == ["Mirror Caustics"]


def test_it_goes_with_the_light_and_with_the_lamp(blank):
    floor, mirror, lamp = looked_into()
    before = parts.state()["data"]
    for remove in ((), (bpy.data.objects["Lamp"],)):
        parts.select(floor, lamp, mirror)
        assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
        assert len(lamp.children) == 1
        for obj in remove:
            bpy.data.objects.remove(obj)
            bpy.data.lights.remove(bpy.data.lights["Lamp"])
        assert bpy.ops.reflection_mesh.clear() == {"FINISHED"}
        after = parts.state()["data"]
        gone = {"objects": ["Lamp"], "lights": ["Lamp"]} if remove else {}
        assert after == {kind: [name for name in names if name not in gone.get(kind, ())]
                         for kind, names in before.items()}


def test_two_mirrors_share_it(blank):
    floor, mirror, lamp = looked_into()
    other = parts.add("plane", "Other", size=1.2, location=(-AIM.x, 0.0, 1.0), rotation=(0.0, np.pi / 2, 0.0))
    other.data.materials.append(mirror.active_material)
    before = parts.state()["data"]
    parts.select(floor, lamp, other, mirror)
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    glint, = lamp.children
    assert set(glint.light_linking.receiver_collection.objects) == {mirror, other}
    parts.select(other)
    assert bpy.ops.reflection_mesh.clear() == {"FINISHED"}
    assert list(glint.light_linking.receiver_collection.objects) == [mirror]
    parts.select(mirror)
    assert bpy.ops.reflection_mesh.clear() == {"FINISHED"} and parts.state()["data"] == before


def test_a_copy_of_the_lamp_leaves_none_behind(blank):
    floor, mirror, lamp = looked_into()
    before = parts.state()["data"]
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    glint, = lamp.children
    copy, image = lamp.copy(), glint.copy()
    image.parent = copy
    for obj in (copy, image):
        blank.scene.collection.objects.link(obj)
    parts.select(mirror)
    assert bpy.ops.reflection_mesh.clear() == {"FINISHED"}
    assert copy.light_linking.receiver_collection is None
    bpy.data.objects.remove(copy)
    assert parts.state()["data"] == before


def test_one_whose_mirrors_were_unlinked_by_hand_is_made_anew_and_goes(blank):
    floor, mirror, lamp = looked_into()
    before = parts.state()["data"]
    for _ in range(2):
        assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
        glint, = lamp.children
        assert list(glint.light_linking.receiver_collection.objects) == [mirror]
        bpy.data.collections.remove(glint.light_linking.receiver_collection)
    assert bpy.ops.reflection_mesh.clear() == {"FINISHED"} and parts.state()["data"] == before


@pytest.mark.thorough
def test_the_shell_of_a_mesh_is_made_anew_and_follows_it(blank, room):
    floor, mirror, lamp = with_mesh("ball")
    other = parts.add("plane", "Other", size=1.2, location=(-AIM.x, 0.0, 1.0), rotation=(0.0, np.pi / 2, 0.0))
    other.data.materials.append(mirror.active_material)
    before = parts.state()["data"]
    parts.select(floor, lamp, other, mirror)
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    made = parts.state()["data"]
    shell, = lamp.children
    strength = lamp.active_material.node_tree.nodes["Emission"].inputs["Strength"]
    strength.default_value = 3.0
    parts.select(floor, lamp, other, mirror)
    thrown_as_by_live(room)
    shines = [node.inputs["Strength"].default_value for node in shell.active_material.node_tree.nodes
              if node.name == room("addon.illumination.not_twice.shining_shell").SHINE]
    assert shines == [3.0]
    lamp.modifiers.new("Finer", "SUBSURF")
    lamp.keyframe_insert("location")
    parts.select(floor, lamp, other, mirror)
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT", leave_out=True) == {"FINISHED"}
    assert all(parts.state()["data"][kind] == names for kind, names in made.items() if kind != "actions")
    shell, = lamp.children
    bpy.context.view_layer.update()
    assert [one.type for one in shell.modifiers] == ["SUBSURF", "SOLIDIFY"]
    assert np.array(shell.matrix_world) == pytest.approx(np.array(lamp.matrix_world))
    assert set(shell.light_linking.receiver_collection.objects) == {mirror, other}
    lamp.animation_data_clear()
    assert bpy.ops.reflection_mesh.clear() == {"FINISHED"} and not lamp.children
    assert {kind: names for kind, names in parts.state()["data"].items() if kind != "actions"} == {
        kind: names for kind, names in before.items() if kind != "actions"}


def test_nothing_but_the_mirror_sees_the_shell(blank, tmp_path):
    """The camera, another mirror and a diffuse floor see the mesh as before; no reflection shows its shell."""
    floor, mirror, lamp = with_mesh("box")
    camera = bpy.context.scene.camera
    camera.location, camera.data.type = (2.4, 0.0, 2.2), "PERSP"
    camera.rotation_euler = (Vector((-1.2, 0.0, 1.2)) - camera.location).to_track_quat("-Z", "Y").to_euler()
    other = parts.add("plane", "Other", size=2.4, location=(-2.0, 0.0, 1.2), rotation=(0.0, np.pi / 2, 0.0))
    other.data.materials.append(mirror.active_material.copy())
    parts.select(floor, lamp, mirror)
    bpy.context.scene.cycles.caustics_reflective = False
    before = rendered(tmp_path, 64)
    bpy.context.scene.cycles.caustics_reflective = True
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"} and len(lamp.children) == 1
    bpy.data.objects["Mirror Caustics"].hide_render = True
    bpy.context.scene.cycles.caustics_reflective = False
    after = rendered(tmp_path, 64)
    assert (before > 5.0).sum() > 10
    assert np.abs(after - before).max() < 0.02 * before.max()
    parts.select(other)
    assert bpy.ops.reflection_mesh.generate("EXEC_DEFAULT") == {"FINISHED"}
    shown = next(obj for obj in bpy.data.objects if obj.reflection_mesh.role == "REFLECTION")
    assert lamp.children[0] not in [source.object for source in shown.reflection_mesh.sources]


def test_a_mesh_whose_materials_come_of_nodes_has_no_shell(blank):
    floor, mirror, lamp = with_mesh("ball")
    group = bpy.data.node_groups.new("Paint", "GeometryNodeTree")
    for direction in ("INPUT", "OUTPUT"):
        group.interface.new_socket("Geometry", in_out=direction, socket_type="NodeSocketGeometry")
    painted = group.nodes.new("GeometryNodeSetMaterial")
    painted.inputs["Material"].default_value = lamp.active_material
    group.links.new(group.nodes.new("NodeGroupInput").outputs[0], painted.inputs[0])
    group.links.new(painted.outputs[0], group.nodes.new("NodeGroupOutput").inputs[0])
    lamp.modifiers.new("Paint", "NODES").node_group = group
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    assert "Mirror Caustics" in bpy.data.objects and not lamp.children


@pytest.mark.thorough
@pytest.mark.parametrize("kind", ["POINT", "ball"])
def test_three_mirrors_show_one_lamp(blank, kind):
    """Each in turn is added to those that the lamp's one image is for; nothing is left of the steps between."""
    floor, mirror, lamp = looked_into(kind)
    others = []
    for way in (0.8, -0.8):
        other = mirror.copy()
        other.location.y += 2.0 * way
        bpy.context.scene.collection.objects.link(other)
        others.append(other)
    bpy.context.view_layer.update()
    parts.select(floor, lamp, mirror, *others)
    lights = len(bpy.data.lights)
    for _ in range(2):
        assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
        glint, = lamp.children
        assert {obj.name for obj in glint.light_linking.receiver_collection.objects} == {
            mirror.name, *(other.name for other in others)}
        assert glint.name == f"{lamp.name} Glint" and len(bpy.data.lights) == lights + (kind == "POINT")
        assert kind != "POINT" or glint.data.name == glint.name
    assert bpy.ops.reflection_mesh.clear() == {"FINISHED"}
    assert not lamp.children and len(bpy.data.lights) == lights
