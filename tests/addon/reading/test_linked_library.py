"""Objects linked from another file take part, as sources and as mirrors, and are not changed."""
from types import SimpleNamespace

import bpy
import numpy as np
import parts
import pytest


@pytest.fixture
def library(blank, tmp_path):
    """A file with a wall mirror and a triangle, and a fresh file into which both are linked."""
    parts.add_wall_mirror()
    parts.add_triangle("Leaf", [(-0.5, -1.0, 0.6), (0.7, -1.5, 0.8), (0.1, -0.5, 1.7)])
    path = str(tmp_path / "library.blend")
    bpy.data.libraries.write(path, {bpy.data.objects["Mirror"], bpy.data.objects["Leaf"]})
    for name in ("Mirror", "Leaf"):
        bpy.data.objects.remove(bpy.data.objects[name])
    with bpy.data.libraries.load(path, link=True) as (_, wanted):
        wanted.objects = ["Mirror", "Leaf"]
    for obj in wanted.objects:
        bpy.context.scene.collection.objects.link(obj)
    bpy.context.view_layer.update()
    return wanted.objects


def test_linked_mirror_and_source(library):
    mirror, leaf = library
    assert mirror.library and leaf.library
    parts.select(leaf, mirror)
    result = parts.generate()
    assert result.library is None and result.reflection_mesh.mirror == mirror
    assert result.reflection_mesh.sources[0].object == leaf
    assert np.allclose(parts.attribute(result, "reflected_position")[:, 2].max(), 1.7, atol=1e-6)


def test_virtual_leaves_a_linked_mirror_alone(library, room):
    mirror, leaf = library
    parts.select(leaf, mirror)
    parts.generate(placement="VIRTUAL")
    assert mirror.visible_camera
    nothing = room("addon.writing").InTheWay("", 0.0, False)
    told, = room("addon.operators.shortcomings").window_shortcomings(
            room("addon.reading").Assembly.of(mirror), nothing)
    assert "linked and cannot be hidden" in told


def test_linked_collection_instance(blank, tmp_path):
    """An instance of a linked collection as the source; the mirror lies in a collection of this file."""
    kit = bpy.data.collections.new("Kit")
    leaf = parts.add_triangle("Leaf", [(-0.5, -1.0, 0.6), (0.7, -1.5, 0.8), (0.1, -0.5, 1.7)])
    kit.objects.link(leaf)
    path = str(tmp_path / "kit.blend")
    bpy.data.libraries.write(path, {kit})
    bpy.data.objects.remove(leaf)
    bpy.data.collections.remove(kit)
    with bpy.data.libraries.load(path, link=True) as (_, wanted):
        wanted.collections = ["Kit"]
    empty = bpy.data.objects.new("Instance", None)
    empty.instance_type, empty.instance_collection = "COLLECTION", wanted.collections[0]
    empty.location.x = 0.25
    bpy.context.scene.collection.objects.link(empty)
    mirror = parts.add_wall_mirror()
    bpy.context.view_layer.update()
    parts.select(empty, mirror)
    result = parts.generate()
    reflected = parts.attribute(result, "reflected_position")
    assert np.isclose(reflected[:, 0].max(), 0.95, atol=1e-6) and np.isclose(reflected[:, 0].min(), -0.25, atol=1e-6)


@pytest.mark.parametrize("ways", [{}, {"collect": True, "select_alone": True, "preview": True}])
def test_an_asset_that_was_made_an_override(blank, tmp_path, ways):
    """Its collection takes no result, and one that is called as those of results are does not either."""
    box = parts.add("cube", "Box", size=0.8, location=(0.0, -2.5, 1.0))
    mirror, path = parts.add_wall_mirror(), str(tmp_path / "asset.blend")
    mirror.data.materials.append(parts.material("Chrome", "GLOSSY"))
    asset = bpy.data.collections.new("Reflections")
    asset.objects.link(mirror)
    bpy.data.libraries.write(path, {asset})
    bpy.data.objects.remove(mirror)
    bpy.data.collections.remove(asset)
    with bpy.data.libraries.load(path, link=True) as (_, wanted):
        wanted.collections = ["Reflections"]
    wanted.collections[0].override_hierarchy_create(blank.scene, blank.view_layer)
    mirror = next(obj for obj in blank.scene.objects if obj.name == "Mirror")
    assert mirror.override_library and mirror.users_collection[0].override_library
    parts.select(box, mirror)
    result = parts.generate(**ways)
    assert result.users_collection == (blank.scene.collection,) and result.reflection_mesh.mirror == mirror
    parts.select(mirror)
    assert parts.generate() == result


@pytest.fixture
def linked_result(blank, tmp_path):
    """A function that links a file with a generated reflection into a fresh scene, as "OBJECT", "INSTANCE" or
    "SCENE"."""
    parts.add_triangle("Leaf", [(-0.5, -1.0, 0.6), (0.7, -1.5, 0.8), (0.1, -0.5, 1.7)])
    parts.select(bpy.data.objects["Leaf"], parts.add_wall_mirror())
    parts.generate(collect=True)
    path, camera = str(tmp_path / "shot.blend"), bpy.context.scene.camera.name
    bpy.ops.wm.save_as_mainfile(filepath=path, copy=True)

    def link(way: str) -> None:
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        with bpy.data.libraries.load(path, link=True) as (there, wanted):
            if way == "SCENE":
                wanted.scenes = there.scenes
            wanted.objects, wanted.collections = [camera], ["Reflections"]
        scene = bpy.context.scene
        scene.collection.objects.link(wanted.objects[0])
        scene.camera = wanted.objects[0]
        if way == "OBJECT":
            scene.collection.children.link(wanted.collections[0])
        elif way == "INSTANCE":
            empty = bpy.data.objects.new("Instance", None)
            empty.instance_type, empty.instance_collection = "COLLECTION", wanted.collections[0]
            scene.collection.objects.link(empty)
        else:
            bpy.context.window.scene = wanted.scenes[0]
        bpy.context.view_layer.update()
    return link


@pytest.mark.parametrize("way", ["OBJECT", "INSTANCE"])
def test_a_linked_reflection_is_lit_where_it_lives(linked_result, room, monkeypatch, way):
    """The grey button says so, and so does a run in crowds, which the button does not look through."""
    linked_result(way)
    light, clear, polls = bpy.ops.reflection_mesh.light, bpy.ops.reflection_mesh.clear, room("addon.operators.polls")
    assert not light.poll()
    assert parts.refusal(light).startswith("The reflections are linked from another file: light them in that file")
    with pytest.raises(room("core").ReflectionError, match="linked from another file: light"):
        list(room("addon.operators.light").lighting(bpy.context, []))
    monkeypatch.setattr(polls, "bpy", SimpleNamespace(app=SimpleNamespace(background=False)))
    assert not clear.poll()
    assert parts.refusal(clear).startswith("The reflections are linked from another file: clear them in that file")


def test_the_panel_says_that_a_reflection_is_linked(linked_result, room):
    linked_result("OBJECT")
    result = next(obj for obj in bpy.context.scene.objects if obj.reflection_mesh.role == "REFLECTION")
    bpy.context.scene.render.resolution_x = 7   # which else asks for another result
    told = room("addon.interface.prompts").prompt(bpy.context, result).text
    assert told == "This result is linked from another file. Update and light it there."


def test_a_second_reflection_over_a_linked_one_is_told_of(linked_result, room):
    linked_result("OBJECT")
    result = next(obj for obj in bpy.context.scene.objects if obj.reflection_mesh.role == "REFLECTION")
    mirror, lacks = result.reflection_mesh.mirror, room("addon.operators.shortcomings").render_shortcomings
    assert lacks(bpy.context, [mirror], []) == [f"'{mirror.name}' has a linked reflection too: hide one of the two."]
    result.hide_set(True)
    assert lacks(bpy.context, [mirror], []) == []


def test_a_linked_scene_cannot_be_changed(linked_result):
    linked_result("SCENE")
    assert bpy.context.scene.library
    for operator in (bpy.ops.reflection_mesh.generate, bpy.ops.reflection_mesh.light, bpy.ops.reflection_mesh.clear):
        assert not operator.poll()
        assert parts.refusal(operator).startswith("The scene is linked from another file")
