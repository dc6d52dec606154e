"""How a result is handed over in a window, and what it weighs: collection, selection, size, attributes."""
from __future__ import annotations

import os
from types import SimpleNamespace

import bpy
import parts
import pytest


@pytest.fixture
def scene(blank):
    cube = parts.add("cube", "Box", size=1.0, location=(0.0, -1.5, 1.0))
    cube.data.materials.append(parts.material("Plain", "DIFFUSE"))
    cube.data.uv_layers.new(name="Second")
    mirror = parts.add_wall_mirror()
    mirror.data.materials.append(parts.material("Chrome", "PRINCIPLED"))
    parts.select(cube, mirror)
    return mirror, cube


def pressed(**options) -> bpy.types.Object:
    """With what a button asks for; in the background none is pressed."""
    options = {"collect": True, "select_alone": True, **options}
    assert bpy.ops.reflection_mesh.generate("EXEC_DEFAULT", True, **options) == {"FINISHED"}
    return bpy.context.view_layer.objects.active


def test_a_button_asks_for_what_was_not_given(room):
    operator = room("addon.operators.generate").REFLECTION_MESH_OT_generate
    options = set(operator.on_if_pressed)
    assert options == {"collect", "select_alone", "preview", "protect"}

    class Button(room("addon.operators.pressed").ProtectsResults, room("addon.faults").SteppedOperator):
        on_if_pressed = operator.on_if_pressed

        def execute(self, context):
            return {"FINISHED"}
    for given in (set(), {"collect"}, options):
        button = Button()
        button.properties = SimpleNamespace(is_property_set=given.__contains__)
        vars(button).update(dict.fromkeys(options, False))
        assert button.invoke(bpy.context, None) == {"FINISHED"}
        assert {name for name in options if not getattr(button, name)} == given


def selected() -> list:
    return [obj.name for obj in bpy.context.selected_objects]


def test_pressed_it_selects_the_result_alone_in_a_collection(scene):
    mirror, cube = scene
    bpy.ops.ed.undo_push(message="Scene")
    before = parts.state()
    result = pressed()
    assert selected() == ["Mirror Reflection"]
    assert [collection.name for collection in result.users_collection] == ["Reflections"]
    after = parts.state()
    bpy.ops.ed.undo()
    assert parts.state() == before
    bpy.ops.ed.redo()
    assert parts.state() == after
    # the natural second click
    result = pressed()
    assert result.name == "Mirror Reflection" and [item.name for item in bpy.data.collections] == ["Reflections"]
    assert bpy.ops.reflection_mesh.clear() == {"FINISHED"}
    assert not bpy.data.collections and bpy.context.scene.reflection_mesh.collection is None


def test_scripts_get_what_they_ask_for(scene):
    mirror, cube = scene
    result = parts.generate()
    assert selected() == ["Box", "Mirror", "Mirror Reflection"] and not bpy.data.collections
    bpy.ops.reflection_mesh.clear()
    parts.select(cube, mirror)
    result = parts.generate(collect=True, select_alone=True)
    assert selected() == ["Mirror Reflection"] and result.users_collection[0].name == "Reflections"
    # remembered from one time to the next they would be no defaults
    bpy.ops.reflection_mesh.clear()
    parts.select(cube, mirror)
    assert pressed(collect=False, select_alone=False).users_collection[0] == bpy.context.scene.collection
    assert len(selected()) == 3


def test_what_the_user_made_of_the_collection_stays(scene):
    mirror, cube = scene
    own = bpy.data.collections.new("Reflections")
    bpy.context.scene.collection.children.link(own)
    assert pressed().users_collection[0] == own
    bpy.ops.reflection_mesh.clear()
    assert list(bpy.data.collections) == [own]
    # hidden, it would hide the result
    own.hide_render = True
    parts.select(cube, mirror)
    assert pressed().users_collection[0] == bpy.context.scene.collection
    bpy.ops.reflection_mesh.clear()
    bpy.data.collections.remove(own)
    parts.select(cube, mirror)
    pressed()
    made = bpy.context.scene.reflection_mesh.collection
    made.objects.link(cube)
    bpy.ops.reflection_mesh.clear()
    assert list(bpy.data.collections) == [made] and list(made.objects) == [cube]


def test_no_collection_is_made_for_nothing(scene):
    """Where the result is there already, or stays with a mirror that is held out."""
    mirror, cube = scene
    result = parts.generate()
    assert pressed() == result and not bpy.data.collections
    bpy.ops.reflection_mesh.clear()
    held = bpy.data.collections.new("Held")
    bpy.context.scene.collection.children.link(held)
    bpy.context.scene.collection.objects.unlink(mirror)
    held.objects.link(mirror)
    bpy.context.view_layer.layer_collection.children["Held"].holdout = True
    parts.select(cube, mirror)
    assert pressed().users_collection[0] == held and list(bpy.data.collections) == [held]


@pytest.mark.parametrize("held_out", [False, True])
def test_the_result_of_a_mirror_that_is_a_hole_is_one(scene, held_out):
    """By its own switch, not its collection's: the result would lie over the hole."""
    mirror, _ = scene
    mirror.is_holdout = held_out
    assert parts.generate().is_holdout == held_out


def test_what_fails_leaves_no_collection(scene, room, monkeypatch):
    def failing(*_):
        raise OSError("no room")
    monkeypatch.setattr(room("addon.writing.result_collection"), "rendered_collections", failing)
    parts.refusal(collect=True)


def bytes_by_hand(mesh) -> int:
    width = {"FLOAT_VECTOR": 12, "FLOAT2": 8, "FLOAT": 4, "INT": 4, "BOOLEAN": 1, "INT32_2D": 8}
    return sum(width[entry.data_type] * len(entry.data) for entry in mesh.attributes)


@pytest.mark.parametrize(("size", "told"), [(0, "0 bytes"), (999, "999 bytes"), (1000, "1.0 KB"), (25_400, "25 KB"),
                                            (9_940_000, "9.9 MB"), (12_000_000, "12 MB"), (3_210_000_000, "3.2 GB"),
                                            (4 * 10 ** 12, "4000 GB")])
def test_sizes_are_read_easily(room, size, told):
    assert room("addon.writing.arrays.result_size").size_text(size) == told


def test_the_report_tells_the_size_that_the_file_grows_by(scene, room, tmp_path):
    mirror, cube = scene
    path = str(tmp_path / "file.blend")

    def saved() -> int:
        bpy.ops.wm.save_as_mainfile(filepath=path, compress=False, copy=True)
        return os.path.getsize(path)
    bare = saved()
    module = room("addon.operators.generate")
    outcome = room("addon.faults").finished(module.generation(
        bpy.context, room("addon.reading").choose(bpy.context), room("core").Settings(tolerance=0.01)))
    mesh = outcome.results[0][0].data
    size = room("addon.writing").mesh_bytes(mesh)
    assert size == pytest.approx(bytes_by_hand(mesh), rel=0.1)
    assert saved() - bare == pytest.approx(size, rel=0.25, abs=20_000)
    assert room("addon.writing").size_text(size) in outcome.summary(1.0)


METHODS_OWN = {"reflected_position", "mirror_position", "path_length", "image_parity", "source_object", "source_face",
               "bounces", "mirror_face"}


@pytest.mark.parametrize("method", ["GENERAL", "POINTS"])
def test_only_what_is_seen(scene, method):
    mirror, cube = scene
    tree = cube.data.materials[0].node_tree
    picture = tree.nodes.new("ShaderNodeTexImage")
    result = parts.generate(method=method)
    whole = {entry.name: [round(value, 6) for value in parts.attribute(result, entry.name).ravel().tolist()]
             for entry in result.data.attributes if entry.data_type in {"FLOAT_VECTOR", "FLOAT2", "FLOAT"}}
    names = set(result.data.attributes.keys())
    unseen = METHODS_OWN & names | {"Second"}
    parts.generate(method=method, attributes="SHOWN")
    assert names - set(result.data.attributes.keys()) == unseen >= {"mirror_position", "source_face"}
    for name in whole.keys() - unseen:
        assert [round(value, 6) for value in parts.attribute(result, name).ravel().tolist()] == whole[name]
    # the file's setting is that of every way in
    assert "path_length" in parts.generate(method=method).data.attributes
    bpy.context.scene.reflection_mesh.attributes = "SHOWN"
    parts.generate(method=method)
    assert "path_length" not in result.data.attributes
    # what a material reads by name is seen, and a picture without coordinates lies by the active map
    node = tree.nodes.new("ShaderNodeAttribute")
    node.attribute_name = "path_length"
    tree.nodes.new("ShaderNodeUVMap").uv_map = "Second"
    parts.generate(method=method)
    assert unseen & set(result.data.attributes.keys()) == {"path_length", "Second"}
    tree.nodes.remove(picture)
    tree.nodes.remove(next(node for node in tree.nodes if node.type == "UVMAP"))
    parts.generate(method=method)
    assert not {"UVMap", "Second"} & set(result.data.attributes.keys())
    parts.generate(method=method, attributes="ALL")
    assert set(result.data.attributes.keys()) == names


def test_normals_are_seen_where_lamps_shine(scene):
    mirror, cube = scene
    result = parts.generate(attributes="SHOWN")
    shaded = "custom_normal" in result.data.attributes
    bpy.context.scene.reflection_mesh.attributes = "SHOWN"
    cube.data.materials[0] = glowing = parts.material("Glowing")
    parts.generate()
    assert "custom_normal" not in result.data.attributes and shaded == (bpy.app.version >= (4, 5, 0))
    glowing.node_tree.nodes.new("ShaderNodeLayerWeight")
    parts.generate()
    assert ("custom_normal" in result.data.attributes) == shaded


def test_light_is_for_the_camera_that_looks(scene):
    first = bpy.context.scene.camera
    result = parts.generate()
    bpy.ops.object.camera_add(location=(2.0, -6.0, 1.0), rotation=(1.45, 0.0, 0.3))
    bpy.context.scene.camera = bpy.context.object
    assert parts.refusal(bpy.ops.reflection_mesh.light, samples=1).startswith(
        f"'{result.name}' is for the camera '{first.name}'")


def test_light_lies_where_the_mirror_is_although_the_result_was_moved(scene):
    bpy.context.scene.render.resolution_percentage = 25
    result = parts.generate()
    bpy.ops.reflection_mesh.light(samples=1)
    spots = [tuple(spot.vector) for spot in result.data.uv_layers["Reflection Light"].uv]
    result.location.z += 5.0
    bpy.context.view_layer.update()
    parts.select(result)
    bpy.ops.reflection_mesh.light(samples=1)
    moved = [tuple(spot.vector) for spot in result.data.uv_layers["Reflection Light"].uv]
    assert len(spots) == len(moved)
    assert max(abs(a - b) for one, other in zip(spots, moved) for a, b in zip(one, other)) < 1e-4


@pytest.mark.parametrize("fails", [False, True])
def test_no_engine_is_kept_for_a_scene_that_goes(scene, room, monkeypatch, fails):
    """Be it by the user's own setting, or by one that an error in between two renders has left."""
    copies, kept = room("addon.rendering.scene_copies"), []

    def remove(copy: bpy.types.Scene) -> None:
        kept.append(copy.render.use_persistent_data)
        bpy.data.scenes.remove(copy)
    monkeypatch.setattr(copies, "bpy", SimpleNamespace(
        data=SimpleNamespace(scenes=SimpleNamespace(remove=remove))))
    bpy.context.scene.render.use_persistent_data = True
    try:
        with copies.copied_scene(bpy.context, "Copy") as (copy, _):
            assert not copy.render.use_persistent_data
            copy.render.use_persistent_data = True
            if fails:
                raise KeyboardInterrupt
    except KeyboardInterrupt:
        assert fails
    assert kept == [False] and bpy.context.scene.render.use_persistent_data
