"""Light on deformed meshes, by linked lamps, in mirrors in mirrors, of bright lamps and skies."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from lamp_scenes import SIZE, link, outdated, picture, principled, psnr, scene_of, shine


def light(samples: int = 64) -> None:
    assert bpy.ops.reflection_mesh.light(samples=samples) == {"FINISHED"}


@pytest.mark.parametrize("by", [
    "modifier", *(pytest.param(by, marks=pytest.mark.slow) for by in ("shape key", "armature"))])
def test_generated_coordinates_are_those_before_anything_deforms_what_is_reflected(blank, room, by):
    """A box that is bent, with a pattern that lies on it as before."""
    scene_of(blank, "Generated")
    box = bpy.data.objects["Box"]
    box.scale = (1.4, 1.4, 1.4)
    if by == "modifier":
        fine = box.modifiers.new("Fine", "SUBSURF")
        fine.subdivision_type, fine.levels, fine.render_levels = "SIMPLE", 3, 3
        stretched = box.modifiers.new("Stretched", "SIMPLE_DEFORM")
        stretched.deform_method, stretched.factor, stretched.deform_axis = "TWIST", 3.0, "Z"
    elif by == "armature":
        frame = bpy.data.objects.new("Frame", bpy.data.armatures.new("Frame"))
        blank.scene.collection.objects.link(frame)
        blank.view_layer.objects.active = frame
        bpy.ops.object.mode_set(mode="EDIT")
        frame.data.edit_bones.new("Bone").tail = (0.0, 0.0, 1.0)
        bpy.ops.object.mode_set(mode="OBJECT")
        frame.pose.bones["Bone"].scale = (1.0, 0.4, 1.5)
        frame.matrix_world = box.matrix_world
        box.vertex_groups.new(name="Bone").add([0, 2, 3, 4, 7], 1.0, "REPLACE")
        box.modifiers.new("Bent", "ARMATURE").object = frame
        parts.select(*(bpy.data.objects[name] for name in ("Box", "Floor", "Mirror")))
    else:
        box.shape_key_add(name="Basis")
        key = box.shape_key_add(name="Larger")
        key.data.foreach_set("co", np.array([(x, 0.7 * y + z, z - 0.8 * x) for x, y, z in (
            vertex.co for vertex in box.data.vertices)], dtype=np.float32).ravel())
        key.value = 1.0
    kept = set(bpy.data.shape_keys), set(bpy.data.scenes)
    reference, other = picture(room), picture(room, seed=7)
    parts.generate()
    light()
    assert psnr(picture(room), reference) > psnr(other, reference)
    assert (set(bpy.data.shape_keys), set(bpy.data.scenes)) == kept


@pytest.mark.parametrize("name", [pytest.param("is_shadow_catcher", marks=pytest.mark.slow), "is_holdout"])
def test_what_the_camera_does_not_see_as_it_is_mirrors_do(blank, room, name):
    scene_of(blank)
    setattr(bpy.data.objects["Floor"], name, True)
    reference, other = picture(room), picture(room, seed=7)
    parts.generate()
    light(64)
    assert psnr(picture(room), reference) > psnr(other, reference)


@pytest.mark.parametrize(("link", "name", "state"), [
    ("receiver_collection", "Floor", "INCLUDE"), *(pytest.param(*case, marks=pytest.mark.slow) for case in (
        ("receiver_collection", "Floor", "EXCLUDE"), ("blocker_collection", "Box", "EXCLUDE")))])
def test_lamps_light_what_they_are_linked_to(blank, room, link, name, state):
    """What is told of lies in a collection within the one that the lamp is linked to."""
    scene_of(blank)
    blank.scene.cycles.samples = 64
    linked, inner = bpy.data.collections.new("Linked"), bpy.data.collections.new("Inner")
    linked.children.link(inner)
    inner.objects.link(bpy.data.objects[name])
    linked.collection_children[0].light_linking.link_state = state
    lamp = bpy.data.objects["Area"]
    lamp.location, lamp.rotation_euler = (1.5, -2.0, 4.5), (0.0, 0.0, 0.0)
    setattr(lamp.light_linking, link, linked)
    blank.view_layer.update()
    reference = picture(room)
    parts.generate()
    light(32)
    assert psnr(picture(room), reference) > 37.5
    assert set(bpy.data.collections) == {linked, inner} and getattr(lamp.light_linking, link) == linked
    assert not linked.objects and list(inner.objects) == [bpy.data.objects[name]]


@pytest.mark.parametrize("turned", [False, pytest.param(True, marks=pytest.mark.slow)])
def test_mirrors_in_mirrors_show_the_side_that_they_see(blank, room, turned):
    """A card whose one side is red, and whose other is blue: the wall shows one of them, and in the mirror behind the
    eye the other."""
    wall = scene_of(blank, "Backfacing")
    blank.scene.cycles.samples = 64
    box = bpy.data.objects["Box"]
    card = parts.add("plane", "Card", size=2.0, location=(2.2, -0.5, 1.0),
                     rotation=((-1.0 if turned else 1.0) * np.pi / 2, 0.0, 0.0))
    card.data.materials.append(box.data.materials[0])
    bpy.data.objects.remove(box)
    behind = parts.add("plane", "Behind", size=30.0, location=(0.0, -6.3, 1.0), rotation=(-np.pi / 2, 0.0, 0.0))
    behind.data.materials.append(wall.data.materials[0])
    parts.select(card, bpy.data.objects["Floor"], behind, wall)
    reference, other = picture(room), picture(room, seed=7)
    inside = slice(SIZE // 5, -SIZE // 5)
    red, blue = ((reference[inside, inside, one] - reference[inside, inside, 2 - one] > 0.2).sum() for one in (0, 2))
    assert red > 30 and blue > 30
    parts.generate(depth=5)
    light(64)
    # on the card, but for its outline before what mirrors show after the last bounce: there Cycles' paths end in black
    ended = np.pad(reference.max(axis=2) < 0.05, 2)
    beside = np.logical_or.reduce([ended[y:y + SIZE, x:x + SIZE] for y in range(5) for x in range(5)])
    card = (np.abs(reference[..., 0] - reference[..., 2]) > 0.2) & ~beside
    lit, noise = (-10.0 * np.log10(((one - reference)[card]**2).mean()) for one in (picture(room), other))
    assert lit > noise


@pytest.mark.parametrize("bounces", [0, pytest.param(1, marks=pytest.mark.slow)])
def test_lamps_light_no_more_bounces_than_they_may(blank, room, bounces):
    """Of a lamp's two objects each is out: what mirrors show is lit a bounce later."""
    scene_of(blank)
    lamp = bpy.data.objects["Area"]
    twin = lamp.copy()
    blank.scene.collection.objects.link(twin)
    twin.location = 2.0, -3.0, 3.0
    # what lights all the same
    point = bpy.data.objects.new("Point", bpy.data.lights.new("Point", "POINT"))
    blank.scene.collection.objects.link(point)
    point.location, point.data.energy, point.data.shadow_soft_size = (-1.0, -2.0, 3.0), 80.0, 0.5
    for one, most in ((lamp, bounces), (point, 7)):
        one.data.cycles.max_bounces = most
    reference, other = picture(room), picture(room, seed=7)
    parts.generate()
    light(64)
    assert psnr(picture(room), reference) > psnr(other, reference)
    assert (lamp.data.cycles.max_bounces, point.data.cycles.max_bounces) == (bounces, 7)
    assert not (lamp.hide_render or twin.hide_render or point.hide_render)


@pytest.mark.slow
def test_it_is_exposed_once(blank, room):
    scene_of(blank)
    blank.scene.cycles.film_exposure = 0.4
    reference = picture(room)
    parts.generate()
    light(64)
    assert psnr(picture(room), reference) > 46.5


@pytest.mark.slow
def test_a_lamp_s_body_is_as_bright_as_the_mirror_shows_it(blank, room):
    """Cycles clamps what lamps light at ten, seen in a mirror, and what shines itself not before the second one."""
    scene_of(blank)
    bulb = parts.add("uv_sphere", "Bulb", radius=0.4, location=(-1.0, -1.5, 1.6))
    bulb.data.materials.append(principled("Bulb", (0.0, 0.0, 0.0), **{
        "Emission Color": (1.0, 0.5, 0.25, 1.0), "Emission Strength": 200.0}))
    bulb.visible_camera = False
    parts.select(bulb, *(bpy.data.objects[name] for name in ("Box", "Floor", "Mirror")))
    blank.scene.cycles.film_exposure = 0.004
    assert blank.scene.cycles.sample_clamp_indirect == 10.0
    reference = picture(room)
    assert (reference[..., 0] > 0.85).sum() > 50
    parts.generate()
    light(16)
    assert psnr(picture(room), reference) > 48.0


def test_a_world_is_mapped_no_larger_than_its_light_needs(blank, room):
    """Cycles maps the light of the world for each bake anew."""
    swiftly = room("addon.rendering.swift_world").swiftly_sampled
    scene_of(blank)
    for width, columns in ((0, 512), (512, None), (2048, 1024)):
        blank.scene.world = bpy.data.worlds.new("World")
        world = shine(blank.scene, width)
        swift = swiftly(world)
        assert (swift != world) == (columns is not None) and world.cycles.sampling_method == "AUTOMATIC"
        if swift != world:
            assert (swift.cycles.sampling_method, swift.cycles.sample_map_resolution) == ("MANUAL", columns)
    world.cycles.sampling_method = "NONE"
    assert swiftly(world) == world


@pytest.mark.slow
def test_the_sun_of_a_picture_of_the_sky_is_found(blank, room):
    scene_of(blank)
    bpy.data.lights.remove(next(iter(bpy.data.lights)))
    world = shine(blank.scene, 2048)
    reference, other = picture(room), picture(room, seed=7)
    parts.generate()
    light(64)
    assert psnr(picture(room), reference) > psnr(other, reference)
    assert set(bpy.data.worlds) == {world} and blank.scene.world == world


@pytest.mark.parametrize("output", [
    "UV", *(pytest.param(output, marks=pytest.mark.slow) for output in ("Object", "UV map"))])
def test_textures_of_the_mirror_stay_where_they_are_on_it(blank, room, output):
    """Also when it is moved; what is reflected is one colour."""
    wall = scene_of(blank, "", "Textured tint")
    tree = wall.data.materials[0].node_tree
    checks = next(node for node in tree.nodes if node.type == "TEX_CHECKER")
    place = tree.nodes.new("ShaderNodeUVMap" if output == "UV map" else "ShaderNodeTexCoord")
    link(tree, place.outputs[0 if output == "UV map" else output], checks.inputs["Vector"])
    checks.inputs["Scale"].default_value = 3.1
    card = parts.add("plane", "Card", size=30.0, location=(0.0, -8.0, 1.0), rotation=(-np.pi / 2, 0.0, 0.0))
    card.data.materials.append(parts.material("Card"))
    for other in [obj for obj in blank.scene.objects if obj.name in {"Box", "Floor"} or obj.type == "LIGHT"]:
        other.hide_render = True
    parts.select(card, wall)
    result = parts.generate()
    for turn in (0.0, 0.1):
        wall.rotation_euler.z = turn
        blank.view_layer.update()
        parts.select(result)
        parts.generate()
        light(1)
        shown = picture(room)
        result.hide_render = True
        assert np.quantile(np.abs(shown - picture(room))[20:-20, 20:-20], 0.97) < 0.02
        result.hide_render = False


@pytest.mark.slow
def test_floors_and_walls_are_denoised(blank, room):
    """Of a floor in a soft shadow, few samples show what many do."""
    wall = scene_of(blank)
    lamp = next(obj for obj in blank.scene.objects if obj.type == "LIGHT")
    lamp.data.size = 6.0
    box = bpy.data.objects["Box"]
    box.visible_camera = box.visible_glossy = False
    parts.select(bpy.data.objects["Floor"], wall)
    blank.scene.cycles.samples *= 8
    reference = picture(room)
    blank.scene.cycles.samples = 16
    few = of_the_reflected_floor(picture(room), reference)
    parts.generate()
    light(16)
    # measured: 40.6 dB, and 32.3 by as many samples that are not denoised; two pictures of 1024 differ by 47.7
    assert of_the_reflected_floor(picture(room), reference) > few + 7.8


def of_the_reflected_floor(one: np.ndarray, other: np.ndarray) -> float:
    """PSNR over the pixels of the floor's image in the mirror."""
    return float(-10.0 * np.log10(((one - other)[34:46, 20:-20]**2).mean()))


@pytest.mark.slow
def test_it_is_right_from_elsewhere_too(blank, room):
    wall = scene_of(blank, "UV", "Fresnel")
    result = parts.generate()
    light(64)
    shown = result.reflection_mesh.light_material
    camera = blank.scene.camera
    camera.location.x += 0.6
    camera.location.z += 0.4
    wall.rotation_euler.z += 0.05
    blank.view_layer.update()
    assert outdated(room, result)
    reference = picture(room)
    parts.select(result)
    parts.generate()
    # it is still shown, and has to be made again
    assert {slot.material for slot in result.material_slots} == {shown} and outdated(room, result)
    assert psnr(picture(room), reference) > 42.0
    # but not where what is reflected changes
    bpy.data.objects["Box"].location.x += 0.2
    blank.view_layer.update()
    parts.generate()
    assert all(slot.material != shown for slot in result.material_slots)
