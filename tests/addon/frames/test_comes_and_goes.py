"""Objects that are shown at some frames only, by a mirror that shows all that is there."""
import bpy
import numpy as np
import parts
import pytest


def shown(result: bpy.types.Object) -> np.ndarray:
    """The places of what a result shows now, sorted."""
    evaluated = result.evaluated_get(bpy.context.evaluated_depsgraph_get())
    places = np.empty((len(evaluated.data.vertices), 3), dtype=np.float32)
    evaluated.data.attributes["position"].data.foreach_get("vector", places.reshape(-1))
    placed = places @ np.array(evaluated.matrix_world)[:3, :3].T + np.array(evaluated.matrix_world.translation)
    return placed[np.lexsort(placed.T)]


def into_a_strip(obj: bpy.types.Object, meta: bool = False) -> None:
    """Push an object's action down, as the NLA editor does, and there into a strip of strips."""
    data = obj.animation_data
    track = data.nla_tracks.new()
    strip = track.strips.new("Strip", int(data.action.frame_range[0]), data.action)
    if bpy.app.version >= (4, 4, 0):
        strip.action_slot = data.action_slot
    data.action = None
    if meta:
        strip.select = True
        area = bpy.context.window.screen.areas[0]
        area.ui_type = "NLA_EDITOR"
        parts.select(obj)
        with bpy.context.temp_override(area=area, region=area.regions[-1]):
            assert bpy.ops.nla.meta_add() == {"FINISHED"}
        assert [strip.type for strip in track.strips] == ["META"]


@pytest.mark.thorough
@pytest.mark.parametrize(("switches", "strips"), [
    (("hide_render",), ""), (("hide_render", "hide_viewport"), ""), (("visible_glossy",), ""),
    (("hide_render", "hide_viewport"), "one"), (("hide_render",), "meta")],
    ids=lambda value: "+".join(value) if isinstance(value, tuple) else value)
@pytest.mark.parametrize("begun", [1, 2])
def test_frames_show_what_is_there_at_each(blank, tmp_path, switches, strips, begun):
    """Whether it is there at the frame at which the bake begins or not; beside what is generated of all that is
    selected at each frame."""
    always, guest = (parts.add("cube", name, size=0.8, location=(side, -1.5, 1.0))
                     for name, side in (("Always", -0.8), ("Guest", 0.8)))
    mirror = parts.add_wall_mirror()
    mirror.reflection_mesh.role = "MIRROR"
    for obj in (always, guest):
        obj.data.materials.append(parts.material(obj.name))
    for switch in switches:
        for frame, hidden in ((1, True), (2, False), (3, True)):
            setattr(guest, switch, hidden != (switch == "visible_glossy"))
            guest.keyframe_insert(switch, frame=frame)
    if strips:
        into_a_strip(guest, strips == "meta")
    scene = blank.scene
    scene.frame_start, scene.frame_end = 1, 3
    scene.frame_set(begun)
    parts.select(mirror)
    assert bpy.ops.reflection_mesh.bake(filepath=str(tmp_path / "frames"), samples=0) == {"FINISHED"}
    result, found = bpy.data.objects["Mirror Reflection"], {}
    for frame in (1, 2, 3):
        scene.frame_set(frame)
        found[frame] = shown(result)
    for frame in (1, 2, 3):
        bpy.ops.reflection_mesh.clear()
        scene.frame_set(frame)
        parts.select(*[obj for obj in (always, guest) if obj.visible_get() and not obj.hide_render], mirror)
        expected = shown(parts.generate())
        assert found[frame].shape == expected.shape and np.allclose(found[frame], expected, atol=1e-6)
    assert len(found[2]) > len(found[1])


def test_a_result_knows_what_comes_later(blank, capfd):
    """What is hidden now, but not at other frames, is left out and said to be; it is there when it is shown."""
    always = parts.add("cube", "Always", size=0.8, location=(-0.8, -1.5, 1.0))
    guest, eyeless = (parts.add("cube", name, size=0.8, location=(0.8, -1.5, height))
                      for name, height in (("Guest", 1.0), ("Never", 2.0)))
    mirror = parts.add_wall_mirror()
    mirror.reflection_mesh.role = "MIRROR"
    eyeless.hide_render = True
    for frame, hidden in ((1, True), (2, False)):
        guest.hide_render = hidden
        guest.keyframe_insert("hide_render", frame=frame)
    for frame, there in ((1, {always}), (2, {always, guest})):
        blank.scene.frame_set(frame)
        parts.select(mirror)
        result = parts.generate()
        told = capfd.readouterr().out
        assert ("Left out because it is hidden: 'Guest'." in told) == (guest not in there)
        assert "'Never'" not in told
        sources = [source.object for source in result.reflection_mesh.sources]
        assert {sources[index] for index in set(parts.attribute(result, "source_object").tolist())} == there
