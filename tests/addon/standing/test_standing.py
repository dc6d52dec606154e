"""What is kept from one generation to the next is never stale, and what stands still is not read again."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest

VALUES = {"FLOAT_VECTOR": ("vector", 3, np.float32), "FLOAT2": ("vector", 2, np.float32),
          "FLOAT_COLOR": ("color", 4, np.float32), "BYTE_COLOR": ("color", 4, np.float32),
          "FLOAT": ("value", 1, np.float32), "INT": ("value", 1, np.int32), "BOOLEAN": ("value", 1, bool),
          "INT32_2D": ("value", 2, np.int32), "INT16_2D": ("value", 2, np.int16)}


def whole(obj: bpy.types.Object) -> dict:
    """All attributes of a result, bit for bit, its materials, and where it is."""
    found: dict = {"place": tuple(obj.location), "materials": [getattr(one, "name", "") for one in obj.data.materials]}
    for attribute in obj.data.attributes:
        field, width, kind = VALUES[attribute.data_type]
        values = np.empty(width * len(attribute.data), dtype=kind)
        attribute.data.foreach_get(field, values)
        found[attribute.name] = values.tobytes()
    return found


@pytest.fixture
def scene(blank):
    """A ball that mirrors a cube with a UV map and colours, a cone, and a monkey whose modifier follows the cone."""
    ball = parts.add("uv_sphere", "Ball", segments=16, ring_count=8, location=(0.0, 0.0, 1.0))
    ball.data.shade_smooth()
    cube = parts.add("cube", "Box", size=0.6, location=(1.3, -1.9, 1.2))
    cube.data.materials.append(parts.material("Plain"))
    cube.data.color_attributes.new("Tone", "FLOAT_COLOR", "CORNER")
    cone = parts.add("cone", "Cone", vertices=5, radius1=0.4, location=(-1.2, -2.0, 0.6))
    monkey = parts.add("torus", "Ring", major_segments=8, minor_segments=5, major_radius=0.4, minor_radius=0.1,
                       location=(0.2, -2.2, 1.9))
    bend = monkey.modifiers.new("Bend", "SIMPLE_DEFORM")
    bend.deform_method, bend.angle, bend.origin = "TWIST", 1.5, cone
    for obj in (ball, cube, cone, monkey):
        obj.reflection_mesh.role = "MIRROR" if obj == ball else "DIFFUSE"
    bpy.context.view_layer.update()
    return blank.scene


@pytest.fixture
def read(room, monkeypatch):
    """Names of the objects whose meshes were read, and the trees that were built."""
    module, core = room("addon.reading.read_meshes"), room("core")
    seen, plain, build = [], module._read, core.SceneTree.build.__func__
    monkeypatch.setattr(module, "_read", lambda *given: seen.append(given[0].name) or plain(*given))
    monkeypatch.setattr(core.SceneTree, "build", classmethod(lambda *given: seen.append("tree") or build(*given)))
    room("addon.standing.told")._tell(None)
    return seen


def made() -> dict:
    """What Generate makes of the scene by its roles."""
    parts.select()
    return whole(parts.generate())


def is_right(room) -> dict:
    """Generate with what is kept, and again with nothing kept: both must be the same."""
    found = made()
    room("addon.standing.told")._tell(None)
    assert found == made()
    return found


def obj(name: str) -> bpy.types.Object:
    return bpy.data.objects[name]


def in_edit_mode() -> None:
    parts.select(obj("Cone"))
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.transform.resize(value=(1.4, 1.4, 0.8))
    bpy.ops.object.mode_set(mode="OBJECT")


def vertices_written() -> None:
    mesh = obj("Cone").data
    places = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.vertices.foreach_get("co", places)
    mesh.vertices.foreach_set("co", places * 1.2)
    mesh.update()


def colours_written() -> None:
    data = obj("Box").data.color_attributes["Tone"].data
    data.foreach_set("color", np.linspace(0.0, 1.0, 4 * len(data)).astype(np.float32))
    obj("Box").data.update()


def uv_moved() -> None:
    layer = obj("Box").data.uv_layers[0]
    for loop in layer.data:
        loop.uv = loop.uv + type(loop.uv)((0.25, 0.5))


def replaced() -> None:
    bpy.data.objects.remove(obj("Cone"))
    parts.add("cone", "Cone", vertices=9, radius1=0.5, location=(-1.2, -2.0, 0.6)).reflection_mesh.role = "DIFFUSE"


def renamed() -> None:
    one, other = obj("Box"), obj("Cone")
    one.name, other.name = "Old", "Box"
    one.name = "Cone"
    one.data.name, other.data.name = other.data.name, one.data.name
    one.data, other.data = other.data, one.data


def hidden_meanwhile() -> None:
    cone = obj("Cone")
    cone.hide_viewport = True
    made()
    cone.data.vertices[0].co.x += 0.3
    bpy.context.view_layer.update()
    cone.hide_viewport = False


def away_meanwhile() -> None:
    cone, collection = obj("Cone"), bpy.context.scene.collection
    homes = list(cone.users_collection)
    for home in homes:
        home.objects.unlink(cone)
    made()
    cone.data.vertices[0].co.x += 0.3
    bpy.context.view_layer.update()
    (homes or [collection])[0].objects.link(cone)


def away_for_a_moment() -> None:
    cone = obj("Cone")
    homes = list(cone.users_collection)
    for home in homes:
        home.objects.unlink(cone)
    bpy.context.view_layer.update()
    cone.data.vertices[0].co.x += 0.3
    homes[0].objects.link(cone)


def another_attribute() -> dict:
    wet = obj("Box").data.attributes.new("wet", "FLOAT", "POINT")
    wet.data.foreach_set("value", np.arange(len(wet.data), dtype=np.float32))
    tree = bpy.data.materials["Plain"].node_tree
    node = tree.nodes.new("ShaderNodeAttribute")
    node.attribute_name = "nothing"
    bpy.context.view_layer.update()
    before = made()
    node.attribute_name = "wet"
    return before


def other_material() -> None:
    obj("Box").material_slots[0].material = parts.material("Other")


def gone_material() -> None:
    bpy.data.materials.remove(bpy.data.materials["Plain"])


def driven() -> dict:
    driver = obj("Ring").modifiers["Bend"].driver_add("angle").driver
    driver.type = "SUM"
    variable = driver.variables.new()
    variable.type = "TRANSFORMS"
    variable.targets[0].id, variable.targets[0].transform_type = bpy.context.scene.camera, "LOC_X"
    bpy.context.view_layer.update()
    before = made()
    bpy.context.scene.camera.location.x += 0.4
    return before


def other_frame() -> dict:
    bend = obj("Ring").modifiers["Bend"]
    for frame, angle in ((1, 0.5), (10, 2.5)):
        bend.angle = angle
        bend.keyframe_insert("angle", frame=frame)
    bpy.context.scene.frame_set(1)
    before = made()
    bpy.context.scene.frame_set(7)
    return before


def shape_key() -> dict:
    cone = obj("Cone")
    cone.shape_key_add(name="Basis")
    key = cone.shape_key_add(name="Wide")
    for point in key.data:
        point.co = point.co * 1.5
    bpy.context.view_layer.update()
    before = made()
    key.value = 0.7
    return before


def mirror_bent() -> None:
    for vertex in obj("Ball").data.vertices:
        vertex.co.z *= 1.05


def mirror_with_a_plain_part() -> dict:
    ball = obj("Ball")
    for material in (parts.material("Silver", "GLOSSY"), parts.material("Paint", "GLOSSY", roughness=0.5)):
        ball.data.materials.append(material)
    for face in ball.data.polygons:
        face.material_index = face.index % 3 == 0
    bpy.context.view_layer.update()
    partly = made()
    bpy.data.materials["Paint"].node_tree.nodes[0].inputs["Roughness"].default_value = 0.0
    return partly


def other_scale() -> None:
    obj("Box").scale = (-1.0, 1.3, 0.7)


def smooth() -> None:
    obj("Cone").data.shade_smooth()


def turned() -> None:
    obj("Cone").rotation_euler.x += 0.5  # which the ring's modifier follows


def modifier_added() -> None:
    obj("Cone").modifiers.new("Finer", "SUBSURF").levels = 1


def instanced() -> dict:
    collection = bpy.data.collections.new("Group")
    leaf = parts.add("cone", "Leaf", vertices=4, radius1=0.3)
    for home in list(leaf.users_collection):
        home.objects.unlink(leaf)
    collection.objects.link(leaf)
    empty = bpy.data.objects.new("Instance", None)
    empty.instance_type, empty.instance_collection, empty.location = "COLLECTION", collection, (0.9, -2.3, 0.3)
    bpy.context.scene.collection.objects.link(empty)
    empty.reflection_mesh.role = "DIFFUSE"
    bpy.context.view_layer.update()
    before = made()
    leaf.data.vertices[0].co.z += 0.3
    return before


def object_material() -> dict:
    slot = obj("Box").material_slots[0]
    slot.link, slot.material = "OBJECT", parts.material("Own")
    bpy.context.view_layer.update()
    before = made()
    slot.material = bpy.data.materials["Plain"]
    return before


def handlers_lost() -> None:
    kept = list(bpy.app.handlers.depsgraph_update_post)
    bpy.app.handlers.depsgraph_update_post.clear()
    try:
        obj("Cone").data.vertices[0].co.x += 0.3
        bpy.context.view_layer.update()
    finally:
        bpy.app.handlers.depsgraph_update_post.extend(
            function for function in kept if "standing" not in function.__module__)


CHANGES = [in_edit_mode, vertices_written, colours_written, uv_moved, replaced, renamed, hidden_meanwhile,
           away_meanwhile, away_for_a_moment, another_attribute, other_material, gone_material, driven, other_frame,
           shape_key, mirror_bent, mirror_with_a_plain_part, other_scale, smooth, turned, modifier_added,
           instanced, object_material]


@pytest.mark.parametrize("change", CHANGES, ids=[change.__name__ for change in CHANGES])
def test_what_has_changed_is_seen(scene, room, change):
    before = made()
    before = change() or before
    assert is_right(room) != before


def test_without_its_handlers_nothing_is_kept(scene, room):
    told = room("addon.standing.told")
    before = made()
    assert told.trusted(bpy.context.evaluated_depsgraph_get())
    handlers_lost()
    try:
        assert is_right(room) != before and not told.trusted(bpy.context.evaluated_depsgraph_get())
    finally:
        bpy.app.handlers.depsgraph_update_post.append(told._after_evaluation)


def test_amid_an_evaluation_nothing_is_kept(scene, room):
    told, seen = room("addon.standing.told"), []

    def early(_scene, depsgraph):
        seen.append(told.trusted(depsgraph))
    bpy.app.handlers.frame_change_post.insert(0, early)
    bpy.app.handlers.depsgraph_update_post.insert(0, early)
    try:
        bpy.context.scene.frame_set(3)
        obj("Cone").location.x += 0.1
        bpy.context.view_layer.update()
    finally:
        bpy.app.handlers.frame_change_post.remove(early)
        bpy.app.handlers.depsgraph_update_post.remove(early)
    assert len(seen) >= 2 and not any(seen)
    assert told.trusted(bpy.context.evaluated_depsgraph_get())


def test_when_the_eye_moves_nothing_is_read_again(scene, room, read):
    made()
    assert sorted(read) == ["Ball", "Box", "Cone", "Ring", "tree"]
    read.clear()
    for _ in range(2):
        scene.camera.location.x += 0.2
        made()
    scene.frame_set(5)
    assert read == []
    assert is_right(room)["position"]
    # nor are others, where one moves or is another one
    read.clear()
    obj("Box").location.x += 0.1
    made()
    assert read == ["tree"]
    read.clear()
    obj("Box").data.vertices[0].co.x += 0.1
    made()
    assert read == ["Box", "tree"]
    read.clear()
    obj("Ball").location.z += 0.05
    made()
    assert read == []


def test_any_moves_at_random(scene, room):
    rng, names = np.random.default_rng(11), ["Ball", "Box", "Cone", "Ring", scene.camera.name]
    moves = [vertices_written, uv_moved, other_scale, turned, smooth, mirror_bent, in_edit_mode]
    for _ in range(6):
        for _ in range(rng.integers(1, 4)):
            if rng.uniform() < 0.5:
                moves[rng.integers(len(moves))]()
            else:
                mover = obj(names[rng.integers(len(names))])
                mover.location = np.array(mover.location) + rng.uniform(-0.1, 0.1, 3)
        is_right(room)


def test_undo_and_another_file_let_all_go(scene, room, tmp_path):
    kept = room("addon.standing.kept")
    bpy.ops.ed.undo_push(message="Before")
    before = made()
    obj("Cone").data.vertices[0].co.x += 0.3
    bpy.ops.ed.undo_push(message="After")
    after = is_right(room)
    assert after != before and kept.held_bytes() > 0
    bpy.ops.ed.undo()
    assert kept.held_bytes() == 0 and is_right(room) == before
    bpy.ops.ed.redo()
    assert is_right(room) == after
    path = str(tmp_path / "scene.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    obj("Cone").data.vertices[0].co.x += 0.3
    made()
    assert kept.held_bytes() > 0
    bpy.ops.wm.open_mainfile(filepath=path)
    assert kept.held_bytes() == 0 and is_right(room) == after


def test_no_more_is_kept_than_the_memory_allows(scene, room):
    kept = room("addon.standing.kept")
    made()
    assert kept.held_bytes() > 5e3
    depsgraph = bpy.context.evaluated_depsgraph_get()
    kept.Kept.of(depsgraph).within(0.1)
    assert kept.held_bytes() > 5e3
    kept.Kept.of(depsgraph).within(5e-6)
    assert kept.held_bytes() == 0
    made()
    room("addon.standing.told").unregister()
    try:
        assert kept.held_bytes() == 0
    finally:
        room("addon.standing.told").register()
