"""Mirrors that are windows: seen again however their result is deleted, and no windows where something hides what is
behind them."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from lamp_scenes import picture, psnr


@pytest.fixture
def scene(blank):
    """A cube before a wall mirror; returns (mirror, cube), both selected."""
    mirror, cube = parts.add_wall_mirror(), parts.add("cube", "Box", size=1.0, location=(0.0, -1.5, 1.0))
    cube.data.materials.append(parts.material("Plain"))
    parts.select(cube, mirror)
    return mirror, cube


def delete_by_x(result: bpy.types.Object) -> None:
    parts.select(result)
    bpy.ops.object.delete()


def delete_everywhere(result: bpy.types.Object) -> None:
    parts.select(result)
    bpy.ops.object.delete(use_global=True)


def remove(result: bpy.types.Object) -> None:
    bpy.data.objects.remove(result)


def remove_with_others(result: bpy.types.Object) -> None:
    bpy.data.batch_remove([result, result.data])


def unlink(result: bpy.types.Object) -> None:
    result.use_fake_user = True
    for collection in result.users_collection:
        collection.objects.unlink(result)


def remove_its_collection(result: bpy.types.Object) -> None:
    own = bpy.data.collections.new("Results")
    bpy.context.scene.collection.children.link(own)
    own.objects.link(result)
    bpy.context.scene.collection.objects.unlink(result)
    bpy.context.view_layer.update()
    assert not bpy.data.objects["Mirror"].visible_camera
    bpy.data.collections.remove(own)


@pytest.mark.parametrize("delete", [delete_by_x, delete_everywhere, remove, remove_with_others, unlink,
                                    remove_its_collection])
def test_a_mirror_is_seen_again_when_its_result_is_gone(scene, delete):
    mirror, _ = scene
    before = mirror.visible_camera, mirror.reflection_mesh.camera_hidden
    result = parts.generate(placement="VIRTUAL")
    bpy.context.view_layer.update()
    assert not mirror.visible_camera
    delete(result)
    bpy.context.view_layer.update()
    assert (mirror.visible_camera, mirror.reflection_mesh.camera_hidden) == before == (True, False)


@pytest.mark.thorough
def test_a_render_shows_it_though_nothing_has_asked_for_the_change_before(scene, room):
    """Between deleting by a script and rendering there may be no update."""
    rendering, here = room("addon.rendering"), bpy.context.scene
    rendering.with_cycles(here)
    here.cycles.samples, here.render.film_transparent = 1, True
    covered = rendering.rendered(here)[..., 3]
    result = parts.generate(placement="VIRTUAL")
    assert (rendering.rendered(here)[..., 3] < covered).mean() > 0.1
    bpy.data.objects.remove(result)
    assert (rendering.rendered(here)[..., 3] == covered).all()


def test_a_file_that_is_saved_right_after_holds_no_abandoned_window(scene, room, tmp_path):
    windows, path = room("addon.writing.windows"), str(tmp_path / "file.blend")
    bpy.data.objects.remove(parts.generate(placement="VIRTUAL"))
    bpy.ops.wm.save_as_mainfile(filepath=path)
    # as without the extension
    windows.unregister()
    try:
        bpy.ops.wm.open_mainfile(filepath=path)
        assert bpy.data.objects["Mirror"].visible_camera
    finally:
        windows.register()


def test_a_window_that_was_abandoned_without_the_extension_is_found_when_the_file_is_opened(scene, room, tmp_path):
    mirror, _ = scene
    windows, path = room("addon.writing.windows"), str(tmp_path / "file.blend")
    result = parts.generate(placement="VIRTUAL")
    windows.unregister()
    try:
        bpy.data.objects.remove(result)
        bpy.ops.wm.save_as_mainfile(filepath=path)
        assert not mirror.visible_camera
    finally:
        windows.register()
    bpy.ops.wm.open_mainfile(filepath=path)
    assert bpy.data.objects["Mirror"].visible_camera


def test_a_file_that_is_opened_keeps_its_windows(scene, tmp_path):
    parts.generate(placement="VIRTUAL")
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "file.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "file.blend"))
    mirror = bpy.data.objects["Mirror"]
    assert not mirror.visible_camera
    bpy.ops.reflection_mesh.clear()
    assert mirror.visible_camera


def test_undo_brings_back_the_window_with_its_result(scene):
    bpy.ops.ed.undo_push(message="Before")
    parts.generate(placement="VIRTUAL")
    bpy.ops.ed.undo_push(message="Generated")
    parts.select(bpy.data.objects["Mirror Reflection"])
    bpy.ops.object.delete()
    bpy.ops.ed.undo_push(message="Deleted")
    bpy.ops.ed.undo()
    assert "Mirror Reflection" in bpy.data.objects and not bpy.data.objects["Mirror"].visible_camera
    bpy.ops.ed.redo()
    assert "Mirror Reflection" not in bpy.data.objects and bpy.data.objects["Mirror"].visible_camera
    bpy.ops.ed.undo()
    bpy.ops.ed.undo()
    assert "Mirror Reflection" not in bpy.data.objects and bpy.data.objects["Mirror"].visible_camera


def test_what_the_user_has_hidden_stays_hidden(scene):
    mirror, _ = scene
    mirror.visible_camera = False
    delete_by_x(parts.generate(placement="VIRTUAL"))
    bpy.context.view_layer.update()
    assert not mirror.visible_camera


def test_a_window_stays_one_while_a_result_is_left(scene):
    mirror, _ = scene
    result = parts.generate(placement="VIRTUAL")
    parts.select(result)
    bpy.ops.object.duplicate()
    delete_by_x(result)
    bpy.context.view_layer.update()
    assert not mirror.visible_camera
    delete_by_x(next(obj for obj in bpy.data.objects if obj.reflection_mesh.role == "REFLECTION"))
    bpy.context.view_layer.update()
    assert mirror.visible_camera


def test_a_copy_of_a_window_is_a_mirror(scene):
    mirror, _ = scene
    parts.generate(placement="VIRTUAL")
    parts.select(mirror)
    bpy.ops.object.duplicate()
    bpy.context.view_layer.update()
    assert bpy.context.object.visible_camera and not mirror.visible_camera


def add_wall(size: float = 12.0, y: float = 1.5) -> bpy.types.Object:
    """A wall behind the mirror, whose virtual cube stands around y = 3.5."""
    return parts.add("plane", "Wall", size=size, location=(0.0, y, 1.0), rotation=(np.pi / 2, 0.0, 0.0))


@pytest.mark.parametrize("method", ["GENERAL", "POINTS"])
def test_a_window_before_a_wall_is_refused(scene, method):
    add_wall()
    parts.select(*scene[::-1])
    told = parts.refusal(placement="VIRTUAL", method=method)
    assert told == ("Mirror: 'Wall' stands before the virtual image behind this mirror and would hide it; choose the "
                    "placement Layered, or hide that object from the camera.")
    assert scene[0].visible_camera
    parts.generate(placement="LAYERED", method=method)


@pytest.mark.parametrize("change", [
    lambda wall: setattr(wall, "visible_camera", False),
    lambda wall: setattr(wall, "hide_render", True),
    lambda wall: setattr(wall, "location", (0.0, 6.0, 1.0)),    # beyond the image
    lambda wall: setattr(wall, "location", (0.0, -9.0, 1.0)),   # behind the eye
])
def test_a_wall_that_hides_nothing_is_no_hindrance(scene, room, change):
    change(add_wall())
    parts.select(*scene[::-1])
    assert remarks(room) == []


def test_what_hides_a_part_is_told_of(scene, room):
    post = add_wall(size=1.0)
    post.location.x = 0.9
    parts.select(*scene[::-1])
    told, = remarks(room)
    assert told == ("Mirror: 'Wall' hides a part of the virtual image behind this mirror; the placement Layered shows "
                    "all of it.")


def test_what_is_hidden_counts_by_its_pixels(scene):
    """Most of the faces are those of something small that nothing hides."""
    mirror, cube = scene
    dense = parts.add("uv_sphere", "Dense", segments=96, ring_count=48, radius=0.1, location=(1.3, -1.5, 1.9))
    add_wall(size=1.6)
    parts.select(dense, cube, mirror)
    assert "'Wall' stands before the virtual image" in parts.refusal(placement="VIRTUAL")


@pytest.mark.parametrize("orthographic", [False, True])
@pytest.mark.parametrize("behind", [True, False])
def test_a_floor_in_which_its_own_image_lies_does_not_fight_with_it(blank, room, behind, orthographic):
    """The image is drawn a little nearer, in the same place of the picture; with nothing in it, it is where it is."""
    mirror = parts.add_wall_mirror()
    blank.scene.camera.data.type = "ORTHO" if orthographic else "PERSP"
    floor = parts.add("plane", "Floor", size=12.0, location=(0.0, 0.0 if behind else -5.0, 0.0))
    parts.select(floor, mirror)
    assert not [told for told in remarks(room) if "virtual" in told]
    result = parts.generate(placement="VIRTUAL")
    places = np.array([result.matrix_world @ vertex.co for vertex in result.data.vertices])
    assert (places[:, 2].max() > 1e-4) == behind and np.abs(places[:, 2]).max() < 0.01
    view = room("addon.reading").read_view(bpy.context)
    true_image = parts.attribute(result, "reflected_position") * (1.0, -1.0, 1.0)
    true_image[:, 1] += 2.0 * parts.attribute(result, "mirror_position")[:, 1]
    assert np.abs(view.pixels(places) - view.pixels(true_image)).max() < 0.02


@pytest.mark.thorough
@pytest.mark.parametrize("bottom", [-0.3, 0.2])
def test_a_window_over_a_floor_that_goes_on_shows_what_the_mirror_does(blank, room, bottom):
    """Rendered by Cycles: the floor is red behind the mirror, so that what comes through the image is seen."""
    scene = blank.scene
    scene.render.resolution_x = scene.render.resolution_y = 96
    scene.cycles.samples = 16
    floor = parts.add("grid", "Floor", x_subdivisions=2, y_subdivisions=2, size=12.0, location=(0.0, 1.0, 0.0))
    for name, colour in (("Green", (0.1, 0.7, 0.1, 1.0)), ("Red", (0.9, 0.0, 0.0, 1.0))):
        floor.data.materials.append(parts.material(name))
        floor.data.materials[-1].node_tree.nodes["Emission"].inputs[0].default_value = colour
    for face in floor.data.polygons:
        face.material_index = int(face.center[1] > 0.0)
    mirror = parts.add("plane", "Mirror", size=2.0, location=(0.0, 1.0, bottom + 1.0), rotation=(np.pi / 2, 0.0, 0.0))
    mirror.data.materials.append(parts.material("Chrome", "GLOSSY"))
    mirror.data.materials[0].node_tree.nodes[0].inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    parts.select(floor, mirror)
    reference, other = picture(room), picture(room, seed=7)
    parts.generate(placement="VIRTUAL")
    assert psnr(picture(room), reference) > psnr(other, reference) - 1.0


def test_the_mirror_itself_and_other_windows_do_not_count(scene, room):
    """A thick mirror's back is hidden with its front; so is another mirror behind it."""
    mirror, cube = scene
    mirror.modifiers.new("Thick", "SOLIDIFY").thickness = -0.3
    other = add_wall(y=2.0)
    parts.select(cube, other, mirror)
    other.reflection_mesh.role = mirror.reflection_mesh.role = "MIRROR"
    assert not [told for told in remarks(room) if "virtual" in told and "Mirror:" in told]


def remarks(room) -> list[str]:
    """What a generation with windows has to say."""
    steps = room("addon.operators.generate").generation(bpy.context, room("addon.reading").choose(bpy.context),
                                              room("core").Settings(placement="VIRTUAL"))
    return room("addon.faults").finished(steps).remarks
