"""Whether renders may go on beside: between the events of a window alone, never while somebody waits for the end."""
from __future__ import annotations

import bpy
import parts
import pytest


@pytest.fixture
def pretended(room, monkeypatch) -> list:
    """A Blender that starts renders as jobs, which end when they have been asked for three times; the calls."""
    place, calls = room("addon.rendering.cycles_pictures"), []

    class Ops:
        class render:
            @staticmethod
            def render(*how, scene, write_still):
                calls.append((how, bpy.context.preferences.view.render_display_type))
                bpy.ops.render.render(write_still=write_still, scene=scene)

    class App:
        background = True

        @staticmethod
        def is_job_running(kind: str) -> bool:
            calls.append(kind)
            return calls.count(kind) % 3 != 0

    class Pretended:
        ops, app, context, data, types = Ops, App, bpy.context, bpy.data, bpy.types
    monkeypatch.setattr(place, "bpy", Pretended)
    return calls


@pytest.fixture
def scene(blank) -> bpy.types.Scene:
    parts.add("cube", "Box")
    copy = blank.scene.copy()
    copy.render.resolution_x, copy.render.resolution_y, copy.render.resolution_percentage = 16, 12, 100
    yield copy
    bpy.data.scenes.remove(copy)


def test_a_render_goes_on_beside_and_is_waited_for(room, scene, pretended):
    rendering, faults = room("addon.rendering"), room("addon.faults.between_events")
    rendering.with_cycles(scene)
    scene.cycles.samples, before = 1, own_to_the_user()
    told, steps = [], rendering.shown_while(rendering.rendering(scene), 0.5, "Cycles renders")
    with pytest.raises(StopIteration) as end:
        while True:
            with faults.steps_taken(apart=True):
                told.append(next(steps))
            assert not faults.between_events()
    assert end.value.value.shape == (12, 16, 4)
    assert told == 3 * [(0.5, "Cycles renders")]
    assert all(type(stage) is room("addon.faults").Beside for _, stage in told)
    # no window opens, and what the user has chosen of that stays
    assert pretended[0] == (("INVOKE_DEFAULT",), "NONE") and own_to_the_user() == before


def test_who_waits_for_the_end_renders_in_one_call(room, scene, pretended):
    """Else it would wait for ever: a job ends between events."""
    rendering, faults = room("addon.rendering"), room("addon.faults.between_events")
    rendering.with_cycles(scene)
    scene.cycles.samples = 1
    with faults.steps_taken(apart=True):
        assert rendering.rendered(scene).shape == (12, 16, 4)
        assert faults.between_events()
    assert [how for how, _ in pretended] == [()]
    told = list(rendering.shown_while(rendering.rendering(scene), 0.0, "Cycles renders"))
    assert [type(stage) for _, stage in told] == [room("addon.faults").Undivided]


def own_to_the_user() -> tuple:
    preferences = bpy.context.preferences
    return preferences.is_dirty, preferences.view.render_display_type
