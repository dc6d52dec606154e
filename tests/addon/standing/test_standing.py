"""What is kept from one generation to the next is never stale, and what stands still is not read again."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from changed_scene import (
    CHANGES,
    handlers_lost,
    in_edit_mode,
    made,
    mirror_bent,
    obj,
    other_scale,
    smooth,
    turned,
    uv_moved,
    vertices_written,
)


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
    for each in (ball, cube, cone, monkey):
        each.reflection_mesh.role = "MIRROR" if each == ball else "DIFFUSE"
    bpy.context.view_layer.update()
    return blank.scene


@pytest.fixture
def read(room, monkeypatch):
    """Names of the objects whose meshes were read, and the trees that were built."""
    module, core = room("addon.reading.meshes.read_meshes"), room("core")
    seen, plain, build = [], module._read, core.SceneTree.build.__func__
    monkeypatch.setattr(module, "_read", lambda *given: seen.append(given[0].name) or plain(*given))
    monkeypatch.setattr(core.SceneTree, "build", classmethod(lambda *given: seen.append("tree") or build(*given)))
    room("addon.standing.told")._tell(None)
    return seen


def is_right(room) -> dict:
    """Generate with what is kept, and again with nothing kept: both must be the same."""
    found = made()
    room("addon.standing.told")._tell(None)
    assert found == made()
    return found


@pytest.mark.thorough
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


@pytest.mark.thorough
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
