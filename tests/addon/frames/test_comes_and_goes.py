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


@pytest.mark.parametrize("switches", [("hide_render",), ("hide_render", "hide_viewport")], ids="+".join)
@pytest.mark.parametrize("begun", [1, 2])
def test_frames_show_what_is_there_at_each(blank, tmp_path, switches, begun):
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
            setattr(guest, switch, hidden)
            guest.keyframe_insert(switch, frame=frame)
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
