"""What light that mirrors throw lacks is told of stills and frames, and no frame ends the bake of the others."""
from __future__ import annotations

import re

import bpy
import parts
import pytest
from baked_frames import bake, operate
from caustic_scene import AIM, scene_of


@pytest.fixture
def lit(blank) -> bpy.types.Object:
    floor, mirror, lamp = scene_of()
    return lamp


def warnings(capfd) -> list[str]:
    return re.findall(r"Warning: (.*)\n", capfd.readouterr().out)


def test_bounds_that_light_has_hit_are_told(lit, room):
    """With what the light is called; a mirror that shows little hits none."""
    place, reading, settings = room("addon.operators.caustics"), room("addon.reading"), room("core").Settings

    def told(**options) -> list[str]:
        asked = place.Asked(2, lambda mirror: settings(**options), True)
        steps = place.throwing(bpy.context, reading.choose(bpy.context), [lit], asked)
        thrown = room("addon.command_line.verbs").announced(steps)
        assert set(thrown.lacks) <= set(thrown.remarks)
        return thrown.lacks
    assert told() == []
    sentence, = told(maximum_faces=20)
    assert sentence.startswith("Mirror Caustics: Refinement stopped at the largest number of faces")


@pytest.mark.parametrize(("counts", "told"), [
    ([{"probes": 90, "missed": 4}, {"probes": 10, "missed": 3}],
     ["Lake Caustics: About 7 % of the light that the mirror throws is missing"]),
    ([{"probes": 90, "missed": 2}], []), ([{"probes": 290, "missed": 5}], []),
    ([{"crowded": 2, "filled_pixels": 30, "mirror_pixels": 900},
      {"crowded": 3, "filled_pixels": 90, "mirror_pixels": 900, "pierced": 1}],
     ["Lake Caustics: Dense areas were sampled at one ray per pixel (10.0 %", "Lake Caustics: Too many faces pass"])])
def test_what_places_on_a_lamp_lack_is_told_once(room, counts, told):
    """Each sees about the same parts of the mirror; probes are told apart by all of them."""
    core = room("core")
    meshes = [core.CausticMesh(**{name: None for name in core.CausticMesh.__dataclass_fields__ if name != "counts"},
                               counts=count) for count in counts]
    found = room("addon.operators.caustics.remarks").shortcomings_of_light("Lake Caustics", meshes)
    assert [sentence[:len(start)] for sentence, start in zip(found, told, strict=True)] == told


def test_what_light_lacks_is_said_with_its_frames(lit, room, tmp_path, capfd):
    """By operator and verb; a lamp that passes through the mirror leaves one frame empty, and the others are baked."""
    for frame, place in ((1, lit.location.copy()), (2, AIM), (3, lit.location.copy())):
        lit.location = place
        lit.keyframe_insert("location", frame=frame)
    for curve in room("addon.compat").curves_of(lit):
        for key in curve.keyframe_points:
            key.interpolation = "CONSTANT"
    bpy.context.scene.frame_set(2)
    refused = parts.refusal(bpy.ops.reflection_mesh.caustics)
    assert "lies on the mirror" in refused
    capfd.readouterr()
    operate(tmp_path / "out", frames="1-3", what="CAUSTICS")
    assert warnings(capfd) == [f"In frame 2: {refused}"]
    assert [len(shown(frame).polygons) > 0 for frame in (1, 2, 3)] == [True, False, True]
    tree = room("addon.compat").use_nodes(lit.data)
    tree.links.new(tree.nodes.new("ShaderNodeTexNoise").outputs["Color"], tree.nodes["Emission"].inputs["Color"])
    bpy.ops.reflection_mesh.clear()
    assert bake(room, "--what", "CAUSTICS", "--frames-only", "--output", tmp_path / "other", "--frames", "1-3") == 0
    told = capfd.readouterr().out.splitlines()
    assert f"In frame 2: {refused}" in told
    assert any(line.startswith("In frames 1, 3: The nodes of 'Lamp' tell more than one colour") for line in told)


def shown(frame: int) -> bpy.types.Mesh:
    bpy.context.scene.frame_set(frame)
    return bpy.data.objects["Mirror Caustics"].evaluated_get(bpy.context.evaluated_depsgraph_get()).data
