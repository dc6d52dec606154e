"""Results of several cameras: each camera sees its own, in renders that markers cut too."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from reflected_box import reflected_box, results, second_camera


@pytest.fixture
def scene(blank):
    return reflected_box()


def test_each_camera_has_a_result_of_its_own(scene):
    mirror, cube, result = scene
    scene_, first = bpy.context.scene, bpy.context.scene.camera
    mine = parts.attribute(result, "position").copy()
    other = second_camera()
    scene_.camera = other
    parts.select(cube, mirror)
    second = parts.generate()
    assert results() == ["Mirror Reflection", "Mirror Reflection Other"] and second.name == "Mirror Reflection Other"
    assert np.array_equal(parts.attribute(result, "position"), mine)
    assert (result.hide_render, second.hide_render) == (True, False)
    # in place, by whichever way
    for chosen in ([mirror], [second], [cube, mirror]):
        parts.select(*chosen)
        assert parts.generate() == second
    assert len(results()) == 2
    # who looks sees what is right for it
    scene_.camera = first
    bpy.context.view_layer.update()
    assert (result.hide_render, result.hide_viewport, second.hide_render) == (False, False, True)
    assert parts.attribute(result, "position").tolist() == mine.tolist()
    parts.select(mirror)
    assert parts.generate() == result


def test_what_the_user_hides_or_shows_stays_so(scene):
    mirror, cube, result = scene
    scene_, first = bpy.context.scene, bpy.context.scene.camera
    scene_.camera = other = second_camera()
    parts.select(cube, mirror)
    second = parts.generate()
    result.hide_render = False
    scene_.camera = other
    bpy.context.view_layer.update()
    assert not result.hide_render
    second.hide_render = True
    for camera in (first, other):
        scene_.camera = camera
        bpy.context.view_layer.update()
    assert second.hide_render and result.hide_render
    # a camera without results sees what was seen before
    scene_.camera = second_camera()
    bpy.context.view_layer.update()
    assert second.hide_render and result.hide_render


def test_markers_cut_to_the_result_of_their_camera(scene, tmp_path):
    """In the frames of a render too, each of which is as that camera's still."""
    mirror, cube, result = scene
    scene_, first = bpy.context.scene, bpy.context.scene.camera
    scene_.camera = other = second_camera()
    parts.select(cube, mirror)
    second = parts.generate()
    scene_.render.engine, scene_.cycles.samples, scene_.cycles.use_denoising = "CYCLES", 1, False
    scene_.render.resolution_x = scene_.render.resolution_y = 48
    scene_.render.resolution_percentage = 100
    cube.visible_glossy = False     # so that the mirror shows the box by its result alone

    def still(camera) -> np.ndarray:
        scene_.camera = camera
        bpy.context.view_layer.update()
        scene_.render.filepath = str(tmp_path / "still.png")
        bpy.ops.render.render(write_still=True)
        return pixels(tmp_path / "still.png")
    wanted = [still(other), still(first), still(other)]
    shown = result.hide_render, second.hide_render
    result.hide_render, second.hide_render = False, True
    bpy.context.view_layer.update()
    bpy.ops.render.render(write_still=True)
    assert (pixels(tmp_path / "still.png") != wanted[0]).any(), "The test cannot tell the results apart."
    result.hide_render, second.hide_render = shown
    scene_.frame_start, scene_.frame_end = 1, 3
    for frame, camera in enumerate((other, first, other), 1):
        scene_.timeline_markers.new(camera.name, frame=frame).camera = camera
    scene_.render.filepath = str(tmp_path / "cut_")
    bpy.ops.render.render(animation=True)
    for frame, picture in enumerate(wanted, 1):
        assert (pixels(tmp_path / f"cut_{frame:04}.png") == picture).all(), frame


def pixels(path) -> np.ndarray:
    image = bpy.data.images.load(str(path))
    try:
        return np.array(image.pixels)
    finally:
        bpy.data.images.remove(image)


def test_a_window_that_does_not_wait_for_renders_is_told_of_where_markers_cut(scene, room):
    mirror, cube, result = scene
    lacks, context = room("addon.operators.shortcomings").render_shortcomings, bpy.context
    first, other = context.scene.camera, second_camera()
    for frame, camera in enumerate((first, other), 1):
        context.scene.timeline_markers.new(camera.name, frame=frame).camera = camera
    assert lacks(context, [mirror], [cube]) == []
    context.scene.camera = other
    parts.select(cube, mirror)
    parts.generate()
    assert [sentence[:26] for sentence in lacks(context, [mirror], [cube])] == ["Markers change the camera:"]
    context.scene.render.use_lock_interface = True
    assert lacks(context, [mirror], [cube]) == []


def test_a_window_is_one_for_its_camera(scene):
    mirror, cube, result = scene
    scene_, first = bpy.context.scene, bpy.context.scene.camera
    cube.location.y = -2.5
    parts.select(mirror)
    parts.generate(placement="VIRTUAL")
    assert not mirror.visible_camera
    scene_.camera = other = second_camera()
    parts.select(cube, mirror)
    parts.generate()
    assert mirror.visible_camera
    scene_.camera = first
    bpy.context.view_layer.update()
    assert not mirror.visible_camera
    scene_.camera = other
    bpy.context.view_layer.update()
    assert mirror.visible_camera
    scene_.camera = first
    bpy.context.view_layer.update()
    bpy.data.objects.remove(result)
    bpy.context.view_layer.update()
    assert mirror.visible_camera


def test_a_result_of_an_earlier_version_belongs_to_the_scenes_camera(scene):
    mirror, _, result = scene
    result.reflection_mesh.camera = None
    parts.select(mirror)
    assert parts.generate() == result and result.reflection_mesh.camera == bpy.context.scene.camera


def test_a_result_of_a_deleted_camera_is_taken_over(scene):
    mirror, cube, result = scene
    scene_, first = bpy.context.scene, bpy.context.scene.camera
    scene_.camera = second_camera()
    parts.select(cube, mirror)
    second = parts.generate()
    bpy.data.objects.remove(second)
    bpy.data.objects.remove(first)
    parts.select(cube, mirror)
    assert parts.generate() == result and not result.hide_render


@pytest.mark.parametrize("made", [False, True])
def test_a_camera_that_is_deleted_is_the_scenes_no_more(scene, made):
    """With a result that knows it as without; a marker that bound it binds none. One that was in no scene stays."""
    mirror, cube, result = scene
    here, camera = bpy.context.scene, bpy.context.scene.camera
    if not made:
        bpy.data.objects.remove(result)
        here.reflection_mesh.seen_by = None
    here.timeline_markers.new("Cut", frame=5).camera = camera
    name = camera.name
    parts.select(camera)
    bpy.ops.object.delete()
    bpy.context.view_layer.update()
    assert here.camera is None and here.timeline_markers["Cut"].camera is None
    assert (name in bpy.data.objects) == made
    assert not bpy.ops.reflection_mesh.generate.poll()
    alone = bpy.data.objects.new("Alone", bpy.data.cameras.new("Alone"))
    alone.location, alone.rotation_euler = (0.0, -6.0, 1.0), (1.45, 0.0, 0.0)
    here.camera = alone
    bpy.context.view_layer.update()
    parts.select(cube, mirror)
    parts.generate()
    parts.add("cube", "Another")
    bpy.context.view_layer.update()
    assert here.camera == alone


def test_a_mirror_of_a_long_name_leaves_room_for_what_its_results_are(scene):
    """Blender cuts names at their end, in old versions after 63 bytes; letters may take two of them."""
    mirror, cube, result = scene
    for written in ("M", "Mä", "ä"):
        bpy.data.objects.remove(result)
        mirror.name = written * 300
        parts.select(cube, mirror)
        result = parts.generate()
        assert result.name.endswith(" Reflection") and result.name.startswith(mirror.name[:20])
    first, bpy.context.scene.camera = bpy.context.scene.camera, second_camera()
    parts.select(mirror)
    assert parts.generate().name.endswith(" Reflection Other") and first
