"""Live, told of changes by real handlers and driven by a clock of the tests'."""
from __future__ import annotations

from types import SimpleNamespace

import bpy
import numpy as np
import parts
import pytest
from bpy.app.handlers import persistent

TICK = 0.02
PAUSE = 1.0  # seconds of the tests' clock in which Live comes to rest


class Clock:
    """Steps of the updater as the timer asks for them; `done` tells what each did."""

    def __init__(self, updater) -> None:
        self.updater, self.now, self.done = updater, 100.0, []

    def run(self, seconds: float = TICK) -> list[str]:
        done = []
        bpy.context.view_layer.update()
        for _ in range(max(1, round(seconds / TICK))):
            done.append(self.updater.step(bpy.context, self.now))
            self.now += TICK
        # what was written tells the handlers too
        bpy.context.view_layer.update()
        self.done += done
        return [what for what in done if what]

    def rest(self) -> list[str]:
        """Until nothing is left to do."""
        done = self.run(PAUSE)
        for _ in range(200):
            if self.updater.at_rest:
                break
            done += self.run(PAUSE)
        assert self.updater.at_rest
        assert self.run(PAUSE) == []
        return done


@pytest.fixture
def scene(blank):
    """A ball before the camera, a leaf beside it; by their roles they take part; a small result in the file."""
    ball = parts.add("uv_sphere", "Ball", segments=16, ring_count=8, location=(0.0, 0.0, 1.0))
    ball.data.shade_smooth()
    leaf = add_leaf()
    ball.reflection_mesh.role, leaf.reflection_mesh.role = "MIRROR", "DIFFUSE"
    result = parts.generate()
    parts.select()
    return SimpleNamespace(ball=ball, leaf=leaf, result=result, camera=blank.scene.camera)


@pytest.fixture
def clock(scene, room):
    """Live switched on, at rest; the timer does not run without a window."""
    switch = room("addon.live.switch")
    bpy.context.window_manager.reflection_mesh_live.on = True
    clock = Clock(switch.updater)
    clock.rest()
    yield clock
    switch.stop()


def add_leaf() -> bpy.types.Object:
    return parts.add_triangle("Leaf", [(1.5, -2.0, 0.2), (2.5, -2.0, 0.4), (1.8, -2.5, 1.9)])


def shape(obj: bpy.types.Object) -> tuple:
    """Everything of a result that is seen."""
    return (parts.attribute(obj, "position").tobytes(), parts.corners(obj).tobytes(),
            parts.attribute(obj, "reflected_position").tobytes(), tuple(obj.location))


def generated(*objects: bpy.types.Object) -> tuple:
    """What Generate makes of the scene as it is."""
    parts.select(*objects)
    found = shape(parts.generate())
    parts.select()
    return found


def moved(obj: bpy.types.Object, by=(0.3, 0.0, 0.1)) -> None:
    obj.location = np.array(obj.location) + by


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
    clock.updater._tracks = []
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


def test_renaming_is_harmless(scene, clock):
    for obj, name in ((scene.result, "R"), (scene.ball, "B"), (scene.leaf, "L"), (scene.camera, "C")):
        obj.name = name
    scene.camera.location.x += 0.1
    assert clock.run() == ["followed"]
    assert clock.rest()[-1] == "exact"


@pytest.mark.parametrize("name", ["leaf", "ball", "result"])
@pytest.mark.parametrize("working", [False, True])
def test_removing_is_harmless(scene, clock, name, working, room, monkeypatch):
    if working:
        # new results are under way, and hold what goes
        monkeypatch.setattr(room("addon.live.work"), "BUDGET", 0.0)
        clock.updater._tracks = []
        scene.camera.location.x += 0.2
        assert clock.run(2 * TICK) and clock.updater._work is not None
    bpy.data.objects.remove(getattr(scene, name))
    clock.rest()
    assert clock.updater.told
    assert ("Ball Reflection" in bpy.data.objects) == (name != "result")


def test_a_camera_that_is_removed_is_told(scene, clock):
    bpy.data.objects.remove(scene.camera)
    clock.rest()
    assert "camera" in clock.updater.told


def coarse_work_begun(scene, clock, room, monkeypatch) -> None:
    """The camera has moved, nothing can follow, and a look at a time is taken at new results."""
    monkeypatch.setattr(room("addon.live.work"), "BUDGET", 0.0)
    clock.updater._tracks = []
    scene.camera.location.x += 0.2
    assert clock.run(2 * TICK) and not clock.updater._work.exact


@pytest.mark.parametrize("working", [False, True])
def test_results_of_another_camera_stay_what_they_are(scene, clock, room, monkeypatch, working):
    """Each camera's results show its own view and its own objects, also where it becomes the scene's on the way."""
    first = bpy.context.scene.camera
    cube = parts.add("cube", "Box", size=0.5, location=(-1.5, -2.0, 1.0))
    bpy.ops.object.camera_add(location=(0.4, -6.0, 1.0), rotation=(1.45, 0.0, 0.0))
    bpy.context.scene.camera = second = bpy.context.object
    # on the way what has other triangles could not follow anyway
    parts.select(cube if working else scene.leaf, scene.ball)
    other = parts.generate()
    bpy.context.scene.camera = first
    parts.select()
    clock.rest()
    before = shape(scene.result), scene.result.reflection_mesh.made_from
    if working:
        coarse_work_begun(scene, clock, room, monkeypatch)
    bpy.context.scene.camera = second
    clock.rest()
    assert [source.object for source in other.reflection_mesh.sources] == [cube if working else scene.leaf]
    assert (shape(scene.result), scene.result.reflection_mesh.made_from) == before


def test_what_cannot_follow_is_made_anew_on_the_way_by_a_coarse_files_settings_too(scene, clock, room, monkeypatch):
    monkeypatch.setattr(room("addon.live.track").Track, "of", classmethod(lambda cls, *arguments: None))
    bpy.context.scene.reflection_mesh.tolerance = 4.0
    scene.camera.location.x += 0.1
    clock.rest()
    assert not clock.updater._tracks
    monkeypatch.setattr(room("addon.live.work"), "BUDGET", 0.0)
    before = sum(clock.updater.updates.values())
    for _ in range(60):
        scene.camera.location.x += 0.002
        clock.run()
    assert sum(clock.updater.updates.values()) > before


def test_what_is_hidden_for_a_while_comes_back(scene, clock, room):
    """In Live and with the button that mends what is stale."""
    box = parts.add("cube", "Box", size=0.5, location=(-1.5, -2.0, 1.0))
    parts.select(box, scene.leaf, scene.ball)
    parts.generate()
    parts.select()
    clock.rest()
    whole = shape(scene.result)
    for switch in ("hide_viewport", "hide_render"):
        setattr(box, switch, True)
        clock.rest()
        assert shape(scene.result) != whole
        setattr(box, switch, False)
        clock.rest()
        assert shape(scene.result) == whole
    bpy.context.window_manager.reflection_mesh_live.on = False
    why = room("addon.freshness").why_stale
    for hidden in (True, False):
        box.hide_viewport = hidden
        bpy.context.view_layer.update()
        assert "object" in why(bpy.context, scene.result)
        assert bpy.ops.reflection_mesh.update() == {"FINISHED"}
        assert (shape(scene.result) == whole) != hidden and not why(bpy.context, scene.result)
    # what is deleted is not waited for
    bpy.data.objects.remove(box)
    bpy.ops.reflection_mesh.update()
    assert [source.object for source in scene.result.reflection_mesh.sources] == [scene.leaf]


@pytest.mark.parametrize("way", ["Live", "button", "script"])
def test_what_loses_its_light_shows_a_preview_where_somebody_looks(scene, clock, way, room, monkeypatch):
    if way != "Live":
        bpy.context.window_manager.reflection_mesh_live.on = False
    scene.leaf.data.materials.append(parts.material("Green", "DIFFUSE"))
    parts.select(scene.leaf, scene.ball)
    parts.generate()
    bpy.ops.reflection_mesh.light(samples=1, kind="PICTURE")
    bpy.context.view_layer.update()
    scene.camera.location.x += 0.3
    if way == "Live":
        clock.rest()
    else:
        # in the background none is pressed
        operator = room("addon.live.update").REFLECTION_MESH_OT_update
        pressed = SimpleNamespace(execute=lambda context: {"FINISHED"})
        operator.invoke(pressed, bpy.context, None)
        monkeypatch.setattr(operator, "_pressed", pressed._pressed if way == "button" else operator._pressed)
        bpy.ops.reflection_mesh.update()
    shown, = [slot.material.name for slot in scene.result.material_slots]
    assert shown == ("Green" if way == "script" else "Green Preview")


def test_undo_and_redo_bring_the_right_results(scene, clock):
    bpy.context.preferences.edit.use_global_undo = True
    bpy.ops.ed.undo_push(message="before")
    clock.rest()
    scene.camera.location.x += 0.5
    bpy.ops.ed.undo_push(message="moved")
    assert clock.run() == ["followed"]
    for back in (bpy.ops.ed.undo, bpy.ops.ed.redo):
        back()
        clock.rest()
        objects = bpy.context.scene.objects
        parts.select()
        assert shape(objects["Ball Reflection"]) == generated(objects["Leaf"], objects["Ball"])


def test_removing_the_extension_in_the_middle_ends_it(scene, room, clock):
    scene.camera.location.x += 0.1
    clock.updater._tracks = []
    clock.run()
    live = room("addon.live")
    live.unregister()
    try:
        assert not hasattr(bpy.context.window_manager, "reflection_mesh_live")
        scene.camera.location.x += 0.1
        bpy.context.view_layer.update()
        assert room("addon.live.switch")._tick() is None
    finally:
        live.register()
    assert not bpy.context.window_manager.reflection_mesh_live.on


def test_a_stale_result_says_so(scene, room):
    why = room("addon.freshness").why_stale
    told = lambda: (bpy.context.view_layer.update(), why(bpy.context, scene.result))[1]  # noqa: E731
    assert told() == ""
    for obj, word in ((scene.camera, "camera"), (scene.ball, "mirror"), (scene.leaf, "object")):
        obj.location.y += 1.5
        assert word in told()
        obj.location.y -= 1.5
        assert told() == ""
    for mend in (parts.generate, bpy.ops.reflection_mesh.update):
        scene.camera.location.y -= 0.5
        assert told()
        parts.select(scene.leaf, scene.ball)
        mend()
        assert told() == ""
    # whatever is selected, and nothing that is right as it is
    parts.select(scene.camera)
    before = shape(scene.result)
    assert bpy.ops.reflection_mesh.update() == {"FINISHED"} and shape(scene.result) == before
    scene.camera.location.y += 0.5
    assert told() and bpy.ops.reflection_mesh.update() == {"FINISHED"} and told() == ""
    assert shape(scene.result) == generated(scene.leaf, scene.ball)
    scene.leaf.data.vertices[0].co.z += 0.1
    scene.leaf.data.update()
    assert "object" in told()
    scene.camera.data.lens = 35.0
    assert "camera" in told()
    scene.result.reflection_mesh.made_from = "{}"
    assert told() == ""


def test_what_live_leaves_coarse_is_stale(scene, clock, room):
    scene.camera.location.x += 0.1
    assert clock.run() == ["followed"]
    bpy.context.window_manager.reflection_mesh_live.on = False
    bpy.context.view_layer.update()
    assert room("addon.freshness").why_stale(bpy.context, scene.result)


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


def test_the_panel_draws_both_states(scene, clock, room):
    draw, labels, buttons = room("addon.interface.draw_live").draw_live, [], []
    layout = SimpleNamespace(label=lambda text, **_: labels.append(text), prop=lambda *_, **__: None,
                             operator=lambda name, **_: buttons.append(name))
    layout.column = lambda **_: layout
    draw(layout, bpy.context)
    assert labels[0].startswith("Exact") and labels[0].endswith(" ms") and len(labels) == 1
    bpy.ops.reflection_mesh.live()
    scene.camera.location.y -= 1.5
    bpy.context.view_layer.update()
    labels.clear()
    draw(layout, bpy.context)
    assert len(labels) == 1 and "'Ball Reflection'" in labels[0] and "camera" in labels[0]
    assert buttons[-1] == "reflection_mesh.update"
