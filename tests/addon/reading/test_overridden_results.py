"""A set with a mirror and its reflection, linked and made a library override: both know each other, and are updated."""
import bpy
import parts
import pytest


@pytest.fixture
def overridden(blank, tmp_path):
    """A fresh file with an override of a library's box, mirror and virtual reflection."""
    box, mirror = parts.add("cube", "Box", location=(0.0, -1.5, 1.0), size=1.0), parts.add_wall_mirror()
    parts.select(box, mirror)
    result, kit = parts.generate(placement="VIRTUAL"), bpy.data.collections.new("Kit")
    path = str(tmp_path / "kit.blend")
    for obj in (box, mirror, result):
        kit.objects.link(obj)
    bpy.data.libraries.write(path, {kit})
    for obj in (box, mirror, result):
        bpy.data.objects.remove(obj)
    bpy.data.collections.remove(kit)
    with bpy.data.libraries.load(path, link=True) as (_, wanted):
        wanted.collections = ["Kit"]
    linked, = wanted.collections
    bpy.context.scene.collection.children.link(linked)
    linked.override_hierarchy_create(bpy.context.scene, bpy.context.view_layer, do_fully_editable=True)
    children = bpy.context.scene.collection.children
    if linked in children.values():
        children.unlink(linked)
    bpy.context.view_layer.update()
    return tmp_path / "scene.blend"


def reopened(path) -> tuple:
    """The box, the mirror and the reflections of the scene, saved and opened again."""
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    bpy.ops.wm.open_mainfile(filepath=str(path))
    objects = bpy.context.scene.objects
    return objects["Box"], objects["Mirror"], [obj for obj in objects if obj.reflection_mesh.role == "REFLECTION"]


def test_an_overridden_reflection_still_has_its_mirror_after_saving(overridden):
    """It had the library's, so that its own was no window any more, and hid the virtual image."""
    box, mirror, (result,) = reopened(overridden)
    assert box.override_library and mirror.override_library and result.override_library
    assert result.reflection_mesh.mirror == mirror and not mirror.visible_camera
    assert [source.object for source in result.reflection_mesh.sources] == [box]


def test_an_overridden_reflection_is_updated_in_place(overridden):
    """That failed for a reason that was not foreseen."""
    _, mirror, (result,) = reopened(overridden)
    leaf = parts.add_triangle("Leaf", [(-0.5, -1.0, 0.6), (0.7, -1.5, 0.8), (0.1, -0.5, 1.7)])
    parts.select(leaf, mirror)
    assert parts.generate(placement="LAYERED") == result and mirror.visible_camera
    _, mirror, (result,) = reopened(overridden)
    assert [source.object.name for source in result.reflection_mesh.sources] == ["Leaf"]
    assert (parts.attribute(result, "source_object") == 0).all() and mirror.visible_camera
    assert bpy.ops.reflection_mesh.clear() == {"FINISHED"}
    assert not any(obj.reflection_mesh.role == "REFLECTION" for obj in bpy.context.scene.objects)
