"""Live: what it updates, when, and how exactly; for the camera and for the viewport."""
from __future__ import annotations

from types import SimpleNamespace

import bpy
import numpy as np
import parts
import pytest
from bpy.app.handlers import persistent
from live_scene import PAUSE, generated, moved, shape


def test_off_by_default_and_no_file_turns_it_on(blank, room, tmp_path):
    live = bpy.context.window_manager.reflection_mesh_live
    assert not live.on and room("addon.live.switch").updater is None
    assert bpy.ops.reflection_mesh.live() == {"FINISHED"} and live.on
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "live.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "live.blend"))
    assert not bpy.context.window_manager.reflection_mesh_live.on
    handlers = [entry for name in dir(bpy.app.handlers) if isinstance(getattr(bpy.app.handlers, name), list)
                for entry in getattr(bpy.app.handlers, name)]
    assert [entry.__name__ for entry in handlers if entry.__module__.endswith("live.switch")] == ["_before_opening"]


def test_other_add_ons_are_told_that_a_file_is_opened(blank):
    told = []
    after = persistent(lambda *_: told.append("pre"))
    bpy.context.window_manager.reflection_mesh_live.on = True
    bpy.app.handlers.load_pre.append(after)
    try:
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    finally:
        bpy.app.handlers.load_pre.remove(after)
    assert told == ["pre"] and not bpy.context.window_manager.reflection_mesh_live.on


@pytest.mark.feature("live")
@pytest.mark.parametrize("name", ["camera", "ball", "leaf"])
def test_follows_on_the_way_and_is_exact_at_rest(scene, clock, name):
    """What it shows at rest is what Generate makes, to the last bit."""
    before, faces = shape(scene.result), parts.corners(scene.result).tobytes()
    for _ in range(3):
        moved(getattr(scene, name), (0.02, 0.0, 0.01))
        assert clock.run() == ["followed"]
    assert shape(scene.result) != before and parts.corners(scene.result).tobytes() == faces
    assert not clock.updater.at_rest
    assert clock.rest()[-1] == "exact"
    at_rest = shape(scene.result)
    assert at_rest != before and at_rest == generated(scene.leaf, scene.ball)


def test_what_follows_lies_where_it_is_seen(scene, clock):
    """A vertex on the way is reflected as the law says: its normal halves the way from the eye to its point."""
    scene.camera.location.x += 0.1
    assert clock.run() == ["followed"]
    place, point = (parts.attribute(scene.result, name) for name in ("mirror_position", "reflected_position"))
    eye = np.array(scene.camera.matrix_world.translation)
    to_eye, to_point = (np.array(end - place) / np.linalg.norm(end - place, axis=1, keepdims=True)
                        for end in (eye, point))
    half = to_eye + to_point
    half /= np.linalg.norm(half, axis=1, keepdims=True)
    # the mirror's smooth normals are nearly those of the sphere that it stands for
    normal = place - (0.0, 0.0, 1.0)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    turned = np.degrees(np.arccos(np.clip((half * normal).sum(axis=1), -1.0, 1.0)))
    assert np.median(turned) < 1.0 and np.percentile(turned, 90) < 3.0


@pytest.mark.parametrize("linked", [False, True])
def test_copies_follow_too(scene, clock, room, linked):
    parts.select(scene.result)
    bpy.ops.object.duplicate(linked=linked)
    copy = bpy.context.object
    copy.location.x += 3.0
    parts.select()
    clock.rest()
    still = shape(copy)
    scene.camera.location.x += 0.02
    assert clock.run() == ["followed"]
    assert shape(copy) != still and shape(copy)[:3] == shape(scene.result)[:3]
    assert (copy.data == scene.result.data) == linked
    bpy.context.window_manager.reflection_mesh_live.on = False
    why = room("addon.freshness").why_stale
    assert all("Live was stopped" in why(bpy.context, obj) for obj in (copy, scene.result))


def test_a_copy_that_is_removed_on_the_way_is_harmless(scene, clock):
    parts.select(scene.result)
    bpy.ops.object.duplicate()
    copy = bpy.context.object
    parts.select()
    clock.rest()
    scene.camera.location.x += 0.02
    assert clock.run() == ["followed"]
    bpy.data.objects.remove(copy)
    scene.camera.location.x += 0.02
    clock.rest()
    assert shape(scene.result) == generated(scene.leaf, scene.ball)


def test_large_results_follow_in_turns(scene, clock, room, monkeypatch):
    """Some vertices at each look, and all of them are written at once: as they would be in one go."""
    following = clock.updater.following
    scene.camera.location.x += 0.1
    bpy.context.view_layer.update()
    view = room("addon.reading").read_view(bpy.context)
    now = [track.seen(view, *following._meshes[track.mirror]) for track in following.tracks]
    expected = (now[0].positions - following.tracks[0].origin).astype(np.float32)
    still = shape(scene.result)
    monkeypatch.setattr(room("core.support.stepping"), "INTERVAL", -1.0)
    monkeypatch.setattr(room("core.following"), "AT_ONCE", 4)
    clock.updater.note(False)
    done = []
    while "followed" not in done:
        assert shape(scene.result) == still
        done += clock.run()
    assert done.count("working") > len(expected) // 4 > 2 and done.count("followed") == 1
    np.testing.assert_array_equal(parts.attribute(scene.result, "position"), expected)
    assert "exact" in clock.rest() and not following.is_under_way and following.tracks
    assert shape(scene.result) == generated(scene.leaf, scene.ball)


def test_a_look_takes_one_step_of_new_results(scene, clock, room, monkeypatch):
    """But for the first, which reads what is reflected: two steps at once kept the window waiting for both."""
    module, taken = room("addon.live.work"), []

    def generation(*_, **__):
        for number in range(5):
            taken.append(number)
            yield 0.2 * number, "Step"
    monkeypatch.setattr(module, "generation", generation)
    monkeypatch.setattr(module, "BUDGET", 0.0)
    work = module.Work.of(bpy.context, room("addon.live.watched").watched(
        bpy.context, room("addon.reading").read_view(bpy.context)), {}, False)
    told = []
    while not work.go_on():
        told.append(len(taken))
    assert told == [2, 3, 4, 5]


def test_one_update_for_one_change_and_none_for_its_own(scene, clock):
    updates = dict(clock.updater.updates)
    scene.camera.location.x += 0.1
    assert clock.run(0.1) == ["followed"]
    assert clock.rest().count("exact") == 1
    assert clock.updater.updates == {**updates, "followed": updates["followed"] + 1, "exact": updates["exact"] + 1}
    # what nothing depends on
    parts.add("cube", "Elsewhere", location=(50.0, 0.0, 0.0))
    parts.select()
    assert clock.run(PAUSE) == [] and clock.updater.at_rest
    scene.camera.location.x += 0.1
    bpy.context.view_layer.update()
    scene.camera.location.x -= 0.1
    assert clock.run(PAUSE) == []


def test_frames_and_edited_meshes_count_as_changes(scene, clock):
    scene.leaf.keyframe_insert("location", frame=1)
    scene.leaf.location.x += 0.4
    scene.leaf.keyframe_insert("location", frame=5)
    clock.rest()
    bpy.context.scene.frame_set(3)
    assert clock.run() == ["followed"]
    clock.rest()
    assert shape(scene.result) == generated(scene.leaf, scene.ball)
    # other triangles cannot follow: the result is made anew
    scene.leaf.data.clear_geometry()
    scene.leaf.data.from_pydata([(1.5, -2.0, 0.2), (2.5, -2.0, 0.4), (1.8, -2.5, 1.9), (2.6, -2.2, 1.5)], [],
                                [(0, 1, 2), (1, 3, 2)])
    scene.leaf.data.update()
    assert "followed" not in clock.rest()
    assert shape(scene.result) == generated(scene.leaf, scene.ball)


def test_chooses_its_tolerance_by_what_updates_take(scene, clock, room):
    pace, module = room("addon.live.pace").Pace(), room("addon.live.pace")
    for _ in range(20):
        pace.took(1.0 / pace.tolerance)
    assert 0.3 * module.TARGET < 1.0 / pace.tolerance < module.TARGET * 1.01
    for _ in range(20):
        pace.took(100.0)
    assert pace.tolerance == module.COARSEST
    for _ in range(20):
        pace.took(0.001)
    assert pace.coarse(0.5) == 0.5
    # mirrors in mirrors cannot follow: they are made anew, coarser
    bpy.context.scene.reflection_mesh.tolerance, clock.updater._pace.tolerance = 0.25, 8.0
    clock.updater.following.tracks = []
    scene.camera.location.x += 0.1
    done = clock.run(0.2)
    assert "coarse" in done and "followed" not in done[:done.index("coarse")]
    assert clock.rest()[-1] == "exact"


def test_waits_outside_of_object_mode_and_while_others_work(scene, clock, room, monkeypatch):
    bpy.context.view_layer.objects.active = scene.leaf
    bpy.ops.object.mode_set(mode="EDIT")
    scene.camera.location.x += 0.1
    assert clock.run(PAUSE) == [] and clock.updater.told
    bpy.ops.object.mode_set(mode="OBJECT")
    assert "exact" in clock.rest() and not clock.updater.told
    switch, asked = room("addon.live.switch"), []
    monkeypatch.setattr(clock.updater, "step", lambda *_: asked.append(1))
    monkeypatch.setattr(switch, "is_busy", lambda: True)
    assert switch._tick() == switch.WAIT and not asked
    monkeypatch.setattr(switch, "is_busy", lambda: False)
    assert switch._tick() == switch.INTERVAL and asked
    # a render's depsgraph tells nothing
    clock.updater._noted = False
    switch._after_change(bpy.context.scene, SimpleNamespace(mode="RENDER", updates=[]))
    assert not clock.updater._noted


def test_the_viewports_view_is_read(blank, room):
    """A viewport that stands and sees as the camera does gives the camera's view."""
    eye, read_view = room("addon.live.eye"), room("addon.reading").read_view
    for kind in ("PERSP", "ORTHO"):
        blank.scene.camera.data.type = kind
        blank.view_layer.update()
        camera = read_view(blank)
        region = SimpleNamespace(view_perspective="PERSP", view_matrix=np.linalg.inv(camera.camera_to_world),
                                 window_matrix=camera.projection)
        view = eye.view_of(region, (256, 192))
        points = np.random.default_rng(1).uniform(-2.0, 2.0, (50, 3))
        assert np.allclose(view.pixels(points), camera.pixels(points), atol=1e-6)
        assert view.orthographic == camera.orthographic
    # without perspective Blender's own eye stands in the middle of the scene, and sees what lies behind it
    forward, nearer = np.eye(4), camera.projection.copy()
    forward[2, 3] = 6.0
    nearer[:, 3] -= 6.0 * nearer[:, 2]
    region.view_matrix, region.window_matrix = forward @ region.view_matrix, nearer
    view = eye.view_of(region, (256, 192))
    assert np.allclose(view.pixels(points), camera.pixels(points), atol=1e-6) and (view.depths(points) > 0.0).all()


def test_live_follows_the_viewport(scene, clock, room, monkeypatch):
    eye = room("addon.live.eye")
    camera = eye.read_view(bpy.context)
    region = SimpleNamespace(view_perspective="PERSP", view_matrix=np.linalg.inv(camera.camera_to_world),
                             window_matrix=camera.projection)
    monkeypatch.setattr(eye, "largest_viewport", lambda context: (region, (256, 192)))
    clock.updater.of_viewport = True
    clock.rest()
    still = shape(scene.result)
    placement = camera.camera_to_world.copy()
    placement[0, 3] += 0.2
    region.view_matrix = np.linalg.inv(placement)
    # no handler tells of it
    assert clock.updater.step(bpy.context, clock.now) == "followed"
    clock.rest()
    assert shape(scene.result) != still
    region.view_perspective = "CAMERA"
    clock.rest()
    assert shape(scene.result) == still == generated(scene.leaf, scene.ball)


def test_the_panel_tells_of_both_states(scene, clock, room):
    prompt = room("addon.interface.prompts").prompt
    text = prompt(bpy.context, scene.result).text
    assert text.startswith("Exact") and text.endswith(" ms")
    bpy.ops.reflection_mesh.live()
    scene.camera.location.y -= 1.5
    bpy.context.view_layer.update()
    assert prompt(bpy.context, scene.result).text == (
        "1 result is out of date: the camera has changed. Click Update Reflections.")
