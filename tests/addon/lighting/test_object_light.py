"""Light that stays with the objects: as near to Cycles as light of the picture, and as right after the camera or the
mirror have moved."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from lamp_scenes import leaves_no_trace, link, lit_state, picture, principled, psnr, scene_of, shine

# gloss and glass go by where they are seen from: they are right in a flat mirror from where the light was made
SOURCES = ("Generated", "Object", "Normal", "UV", "Camera", "Window", "Reflection", "Bump", "Normal map", "Random",
           "Instances", "View distance", "Attribute", "Gloss", "Alpha", "Backfacing", "Light path")
MIRRORS = ("Tint", "Textured tint", "Fresnel", "Layer weight")


def light(samples: int = 64) -> None:
    assert bpy.ops.reflection_mesh.light(samples=samples, kind="OBJECTS") == {"FINISHED"}


@pytest.mark.parametrize(("source", "mirror"), [*((kind, "") for kind in SOURCES), *(("UV", kind) for kind in MIRRORS)])
def test_it_is_what_the_mirror_shows(blank, room, source, mirror):
    scene_of(blank, source, mirror)
    reference, other = picture(room), picture(room, seed=7)
    parts.generate()
    before = psnr(picture(room), reference)
    light(64)
    lit, noise = psnr(picture(room), reference), psnr(other, reference)
    assert lit > min(38.0, noise - 1.5)
    assert lit > before + 6.0


@pytest.mark.parametrize("by", ["modifier", "shape key", "armature"])
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
    assert psnr(picture(room), reference) > min(38.0, psnr(other, reference) - 1.5)
    assert (set(bpy.data.shape_keys), set(bpy.data.scenes)) == kept


def test_what_catches_shadows_is_what_mirrors_show_of_it(blank, room):
    scene_of(blank)
    bpy.data.objects["Floor"].is_shadow_catcher = True
    reference, other = picture(room), picture(room, seed=7)
    parts.generate()
    light(64)
    assert psnr(picture(room), reference) > min(38.0, psnr(other, reference) - 1.5)


@pytest.mark.parametrize(("link", "name", "state"), [
    ("receiver_collection", "Floor", "INCLUDE"), ("receiver_collection", "Floor", "EXCLUDE"),
    ("blocker_collection", "Box", "EXCLUDE")])
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
    assert psnr(picture(room), reference) > 30.0
    assert set(bpy.data.collections) == {linked, inner} and getattr(lamp.light_linking, link) == linked
    assert not linked.objects and list(inner.objects) == [bpy.data.objects[name]]


def test_it_is_exposed_once(blank, room):
    scene_of(blank)
    blank.scene.cycles.film_exposure = 0.4
    reference = picture(room)
    parts.generate()
    light(64)
    assert psnr(picture(room), reference) > 38.0


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
    assert psnr(picture(room), reference) > 40.0


def test_a_bake_waits_no_longer_for_the_world_than_its_light_needs(blank, room):
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


def test_the_sun_of_a_picture_of_the_sky_is_found(blank, room):
    scene_of(blank)
    bpy.data.lights.remove(next(iter(bpy.data.lights)))
    world = shine(blank.scene, 2048)
    reference, other = picture(room), picture(room, seed=7)
    parts.generate()
    light(64)
    assert psnr(picture(room), reference) > min(38.0, psnr(other, reference) - 1.5)
    assert set(bpy.data.worlds) == {world} and blank.scene.world == world


@pytest.mark.parametrize("output", ["UV", "Object", "UV map"])
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
    light(1)
    for turn in (0.0, 0.1):
        wall.rotation_euler.z = turn
        blank.view_layer.update()
        parts.select(result)
        parts.generate()
        shown = picture(room)
        result.hide_render = True
        assert np.quantile(np.abs(shown - picture(room))[20:-20, 20:-20], 0.97) < 0.02
        result.hide_render = False


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
    few = psnr(picture(room), reference)
    blank.scene.cycles.samples = 64 * 8
    parts.generate()
    light(1)
    assert psnr(picture(room), reference) > few + 11.0


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
    assert not result.reflection_mesh.light_stale
    reference, other = picture(room), picture(room, seed=7)
    parts.select(result)
    parts.generate()
    assert {slot.material for slot in result.material_slots} == {shown} and not result.reflection_mesh.light_stale
    assert psnr(picture(room), reference) > min(38.0, psnr(other, reference) - 1.5)
    # but not where what is reflected changes
    bpy.data.objects["Box"].location.x += 0.2
    blank.view_layer.update()
    assert result.reflection_mesh.light_stale


def test_another_mesh_does_not_show_it(blank):
    scene_of(blank)
    result = parts.generate(tolerance=4.0)
    light(1)
    bpy.data.objects["Box"].modifiers.new("Finer", "SUBSURF").levels = 1
    parts.select(result)
    parts.generate(tolerance=4.0)
    assert result.reflection_mesh.light_stale
    assert all(slot.link == "DATA" for slot in result.material_slots)


def test_what_is_hidden_meanwhile_takes_no_part(blank):
    """A result remembers it for when it is shown again; its light stays what it is."""
    wall = scene_of(blank)
    other = parts.add("cube", "Other", size=0.5, location=(-1.0, -1.5, 1.0))
    other.hide_render = True
    parts.select(bpy.data.objects["Box"], other, wall)
    result = parts.generate(tolerance=4.0)
    assert [source.object.name for source in result.reflection_mesh.sources] == ["Box", "Other"]
    light(1)
    parts.select(result)
    parts.generate(tolerance=4.0)
    assert not result.reflection_mesh.light_stale
    assert {slot.material for slot in result.material_slots} == {result.reflection_mesh.light_material}
    other.hide_render = False
    parts.generate(tolerance=4.0)
    assert result.reflection_mesh.light_stale and len(set(parts.attribute(result, "source_object"))) == 2
    bpy.data.objects["Box"].hide_render = True
    with pytest.raises(RuntimeError, match="shows an object that is hidden now"):
        light(1)


@pytest.mark.parametrize(("stage", "times"), [("Reading", 1), ("Measuring", 1), ("Copying", 1), ("Copying", 2),
                                              ("Cycles bakes", 1), ("Cycles bakes", 2), *(("Writing", times)
                                                                                          for times in range(1, 8))])
def test_stopped_after_any_step_it_leaves_no_trace(blank, room, stage, times):
    scene_of(blank, "Alpha")
    result = parts.generate()
    before = lit_state()
    steps = room("addon.operators.light").lighting(blank, [result], 1, "OBJECTS")
    while times:
        times -= next(steps)[1].startswith(stage)
    steps.close()
    assert lit_state() == before


@pytest.mark.parametrize("failing", ["kept_map", "new_object_material", "show_object_light"])
def test_an_error_leaves_no_trace(blank, room, monkeypatch, failing):
    leaves_no_trace(blank, room, monkeypatch, ("addon.operators.light", failing), "OBJECTS")


def test_clear_takes_it_away(blank):
    scene_of(blank, "Alpha", "Tint")
    before = parts.state()
    parts.generate()
    light(1)
    # one kind of light takes the other's place
    bpy.ops.reflection_mesh.light(samples=1, kind="PICTURE")
    assert "Reflection Light" not in bpy.data.meshes
    light(1)
    assert {image.name for image in bpy.data.images} - {"Render Result"} == {"Reflection Light"}
    assert "Reflection Light" in bpy.data.meshes
    bpy.ops.reflection_mesh.clear()
    assert parts.state()["data"] == before["data"]


def test_what_moves_is_lit_on_the_objects(blank):
    scene_of(blank)
    result = parts.generate(tolerance=4.0)
    bpy.ops.reflection_mesh.light(samples=1)
    assert result.reflection_mesh.light_map is None
    blank.scene.camera.keyframe_insert("location", frame=1)
    bpy.ops.reflection_mesh.light(samples=1)
    assert result.reflection_mesh.light_map is not None


def test_of_many_objects_the_light_is_made_in_the_picture(blank, room):
    """Each would be baked by itself, half a second and more: a shelf of instanced books took two minutes."""
    scene_of(blank)
    mirror, box = bpy.data.objects["Mirror"], bpy.data.objects["Box"]
    few = room("addon.baking.seen_sources").FEW
    # at two seconds and more for each, a still is lit within a minute
    assert few <= 24
    books = [bpy.data.objects.new(f"Book {number}", box.data) for number in range(few)]
    for number, book in enumerate(books):
        book.location, book.scale = (-2.0 + 4.0 * number / few, -3.0, 2.0), (0.02, 0.1, 0.2)
        blank.scene.collection.objects.link(book)
    blank.scene.camera.keyframe_insert("location", frame=1)
    for shown, kept in ((books[:few - 2], True), (books, False)):
        parts.select(*shown, box, bpy.data.objects["Floor"], mirror)
        result = parts.generate()
        assert room("addon.baking").are_few([result]) == kept
    assert bpy.ops.reflection_mesh.light(samples=1) == {"FINISHED"}
    assert result.reflection_mesh.light_map is None and result.reflection_mesh.light_material is not None


def test_it_is_saved_with_the_file(blank, tmp_path):
    scene_of(blank)
    parts.generate(tolerance=4.0)
    light(1)
    size = len(bpy.data.meshes["Reflection Light"].vertices)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "lit.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "lit.blend"))
    result = bpy.data.objects["Mirror Reflection"]
    assert len(result.reflection_mesh.light_map.vertices) == size
    shown = result.reflection_mesh.light_material
    parts.select(result)
    parts.generate(tolerance=4.0)
    assert {slot.material for slot in result.material_slots} == {shown}


def test_points_are_not_lit_so(blank):
    scene_of(blank)
    parts.generate(method="POINTS")
    with pytest.raises(RuntimeError, match="light it in the picture"):
        light(1)


def covered(corners: np.ndarray, size: int) -> np.ndarray:
    """Texels (size, size) whose middles lie in a triangle (3, 2)."""
    rows, columns = np.mgrid[:size, :size] + 0.5
    sides = []
    for start, end in zip(corners, np.roll(corners, -1, axis=0)):
        sides.append((end[0] - start[0]) * (rows - start[1]) - (end[1] - start[1]) * (columns - start[0]))
    return (np.array(sides) >= 0.0).all(axis=0) | (np.array(sides) <= 0.0).all(axis=0)


def interpolated(picture: np.ndarray, at: np.ndarray) -> np.ndarray:
    """What a texture shows at places (n, k, 2), counted in texels, linearly between their middles."""
    low = np.floor(at - 0.5).astype(int)
    part = at - 0.5 - low
    column, row = (np.clip(np.stack((low[..., axis], low[..., axis] + 1)), 0, len(picture) - 1) for axis in (0, 1))
    across = [(1.0 - part[..., 0]) * picture[line, column[0]] + part[..., 0] * picture[line, column[1]] for line in row]
    return (1.0 - part[..., 1]) * across[0] + part[..., 1] * across[1]


def test_triangles_have_room_of_their_own(room):
    """Against every texel: none is of two triangles, and none is without."""
    atlas = room("addon.baking.texels.atlas")
    rng = np.random.default_rng(3)
    corners = rng.normal(size=(90, 1, 3)) + rng.normal(size=(90, 3, 3)) * np.exp(0.7 * rng.normal(size=(90, 1, 1)))
    corners[:6, 2] = corners[:6, 0] + 1e-4 * rng.normal(size=(6, 3))
    packed = atlas.packed(corners, 5.0)
    owner = np.full((packed.size, packed.size), -1)
    spots = packed.uv.astype(np.float64) * packed.size
    assert spots.min() > 0.0 and spots.max() < packed.size
    for number, triangle in enumerate(spots):
        inside = covered(triangle, packed.size)
        assert inside.sum() >= 3 and (owner[inside] == -1).all()
        owner[inside] = number
    # what one shows, its neighbours in the picture hardly change
    shade = rng.random(len(spots))
    picture = np.full((packed.size, packed.size, 4), -1.0, dtype=np.float32)
    picture[owner >= 0] = shade[owner[owner >= 0], None]
    picture = room("addon.baking.levels").spread(picture, owner >= 0)[..., 0]
    weights = rng.dirichlet((1.0, 1.0, 1.0), size=(len(spots), 40))
    at = np.matmul(weights, spots)
    seen = interpolated(picture, at)
    wrong = np.abs(seen - shade[:, None])
    assert wrong.mean() < 0.01 and wrong[weights.min(axis=2) > 0.25].max() < 0.02
    # as many texels as were asked for, along every side
    lengths = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)
    texels = np.linalg.norm(np.roll(spots, -1, axis=1) - spots, axis=2)
    legs = np.sort(lengths, axis=1)[:, :2].max(axis=1)
    assert (np.sort(texels, axis=1)[:, :2].max(axis=1) >= 0.99 * 5.0 * legs).all()


def test_pictures_of_objects_lie_beside_one_another(room):
    arranged = room("addon.baking.texels.atlas").arranged
    sizes = np.array([4, 64, 16, 16, 64, 4, 128, 32])
    at, side = arranged(sizes)
    taken = np.zeros((side, side), dtype=int)
    for (column, row), size in zip(at, sizes):
        taken[row:row + size, column:column + size] += 1
    assert taken.max() == 1 and taken.sum() == (sizes ** 2).sum()


def test_images_of_the_mirror_s_own_are_the_user_s(blank):
    """Also where nothing but the material of the light still shows them."""
    wall = scene_of(blank, "", "Fresnel")
    own = bpy.data.images.new("Scratches", 4, 4)
    tree = wall.material_slots[0].material.node_tree
    tree.nodes.new("ShaderNodeTexImage").image = own
    parts.generate()
    light(1)
    bpy.data.materials.remove(wall.material_slots[0].material)
    bpy.ops.reflection_mesh.clear()
    assert "Scratches" in bpy.data.images and "Reflection Light" not in bpy.data.images


def test_linked_objects_are_baked_under_their_names(blank, tmp_path):
    scene_of(blank, "Random")
    bpy.data.libraries.write(str(tmp_path / "library.blend"), {bpy.data.objects["Box"]})
    bpy.data.objects.remove(bpy.data.objects["Box"])
    with bpy.data.libraries.load(str(tmp_path / "library.blend"), link=True) as (_, wanted):
        wanted.objects = ["Box"]
    box = wanted.objects[0]
    blank.scene.collection.objects.link(box)
    blank.view_layer.update()
    parts.select(box, bpy.data.objects["Floor"], bpy.data.objects["Mirror"])
    result = parts.generate()
    light(1)
    assert result.reflection_mesh.light_map is not None and not box.hide_render and box.name == "Box"
