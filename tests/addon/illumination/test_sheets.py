"""Light through what is open in part: each sheet takes its share, and what is behind it gets the rest, as in Cycles."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from caustic_scene import light_and_lamp_behind, paint, scene_of

TOLD = "Light ends at"


def sheet(name: str, opaque: float, mixed: bool = False, thick: float = 0.0, **place) -> bpy.types.Object:
    """A plane, or a slab, that lets a part of light through, by its Alpha or by a Mix Shader, without any gloss."""
    made = parts.add("cube" if thick else "plane", name, **{"size": 1.0, **place})
    made.scale.z = thick or 1.0
    colour = (0.3, 0.6, 0.9)
    if mixed:
        material = paint(name, "DIFFUSE", colour)
        tree = material.node_tree
        mix = tree.nodes.new("ShaderNodeMixShader")
        mix.inputs[0].default_value = opaque
        tree.links.new(tree.nodes.new("ShaderNodeBsdfTransparent").outputs[0], mix.inputs[1])
        tree.links.new(tree.nodes[0].outputs[0], mix.inputs[2])
        tree.links.new(mix.outputs[0], tree.get_output_node("ALL").inputs["Surface"])
    else:
        material = paint(name, "PRINCIPLED", colour, "Base Color")
        for socket, value in {"Metallic": 0.0, "Roughness": 1.0, "Specular IOR Level": 0.0, "Alpha": opaque}.items():
            material.node_tree.nodes[0].inputs[socket].default_value = value
    made.data.materials.append(material)
    return made


def scene_with(*sheets: dict) -> tuple:
    floor, mirror, lamp = scene_of("SPOT", spot_size=0.4)  # all of its light meets the mirror
    bpy.context.scene.cycles.max_bounces = 0
    made = [sheet(f"Sheet{number}", **values) for number, values in enumerate(sheets)]
    parts.select(floor, *made, lamp, mirror)
    return mirror, lamp, made


def differ(light: np.ndarray, expected: np.ndarray) -> tuple[float, float]:
    """Of the light that is expected: how much more there is, and the mean difference over what is not an outline."""
    apart = np.abs(light - expected)
    for axis, step in ((0, 1), (0, -1), (1, 1), (1, -1)):
        apart = np.minimum(apart, np.abs(light - np.roll(expected, step, axis)))
    return light.sum() / expected.sum() - 1.0, apart.sum() / expected.sum()


# where no light meets them on its way to the mirror, too
ONE = {"opaque": 0.4, "location": (0.3, -0.2, 0.25)}
OTHER = {"opaque": 0.7, "mixed": True, "location": (0.1, 0.3, 0.5)}
THICK = {"opaque": 0.5, "thick": 0.1, "location": (0.1, 0.1, 0.3)}
UPRIGHT = {"opaque": 0.3, "location": (0.2, 0.0, 0.5), "rotation": (0.0, 1.4, 0.0), "size": 0.5}


@pytest.mark.thorough
@pytest.mark.parametrize("sheets", [(ONE,), (OTHER,), (ONE, OTHER), (THICK,), (UPRIGHT,)],
                         ids=["alpha", "mix", "two", "thick", "upright"])
def test_what_is_behind_gets_what_goes_through(blank, tmp_path, capfd, sheets):
    mirror, lamp, made = scene_with(*sheets)
    light, expected = light_and_lamp_behind(mirror, lamp, tmp_path)
    more, apart = differ(light, expected)
    assert TOLD not in capfd.readouterr().out
    assert abs(more) < 3e-3 and apart < 0.03


def on_floor(result: bpy.types.Object) -> float:
    """The light on the first of what is lit, in watts."""
    irradiance = parts.attribute(result, "irradiance").reshape(-1, 3).mean(axis=1)
    area = np.array([face.area for face in result.data.polygons])
    return float((irradiance * area)[parts.attribute(result, "source_object") == 0].sum())


def test_a_sheet_before_the_mirror_takes_its_share(blank):
    mirror, lamp, (made,) = scene_with({"opaque": 0.3, "location": (-0.5, 0.1, 1.6), "rotation": (0.0, 1.57, 0.0),
                                        "size": 0.5})
    found = []
    for opaque in (0.3, 0.0):
        made.active_material.node_tree.nodes[0].inputs["Alpha"].default_value = opaque
        assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
        found.append(on_floor(bpy.data.objects["Mirror Caustics"]))
    assert abs(found[0] / found[1] - 0.7) < 1e-3


def test_rays_go_through_as_well(blank, room):
    """Those by which Compare judges."""
    mirror, lamp, made = scene_with(ONE)
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    judge, result = room("addon.comparison.light_of_results"), bpy.data.objects["Mirror Caustics"]
    depsgraph = blank.evaluated_depsgraph_get()
    around = judge.Surroundings.of(depsgraph, [mirror], [bpy.data.objects["Floor"], *made], None)
    steps = judge.against_rays(depsgraph, result, judge.Lit.of(result), around, 100_000)
    with pytest.raises(StopIteration) as found:
        while True:
            next(steps)
    assert abs(found.value.value["flux_percent"]) < 0.5


def test_a_number_that_changes_makes_light_stale(blank, room):
    mirror, lamp, (made,) = scene_with(ONE)
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    stale = room("addon.freshness").why_light_is_stale
    result = bpy.data.objects["Mirror Caustics"]
    assert stale(bpy.context, result) == ""
    made.active_material.node_tree.nodes[0].inputs["Alpha"].default_value = 0.9
    blank.view_layer.update()
    assert stale(bpy.context, result) == "what is lit has changed"


@pytest.mark.thorough
def test_where_light_ends_is_told(blank, capfd):
    """At a texture that tells how much goes through, and at a third sheet."""
    mirror, lamp, made = scene_with(ONE, OTHER, UPRIGHT)
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    assert capfd.readouterr().out.count(TOLD) == 1
    parts.select(bpy.data.objects["Floor"], made[0], lamp, mirror)
    tree = made[0].active_material.node_tree
    tree.links.new(tree.nodes.new("ShaderNodeTexNoise").outputs[0], tree.nodes[0].inputs["Alpha"])
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    assert f"{TOLD} '{made[0].active_material.name}'" in capfd.readouterr().out


def test_what_nodes_tell_of_what_goes_through(blank, room):
    transparency = room("addon.reading.materials").transparency
    first, second = sheet("First", 0.4), sheet("Second", 0.7, True)
    assert transparency(None) == 0.0
    assert np.allclose([transparency(one.active_material) for one in (first, second)], (0.6, 0.3))
    tree, other = second.active_material.node_tree, first.active_material.node_tree
    clear = next(node for node in tree.nodes if node.type == "BSDF_TRANSPARENT")
    clear.inputs[0].default_value = (0.5, 0.5, 0.5, 1.0)
    assert np.isclose(transparency(second.active_material), 0.15)
    clear.inputs[0].default_value = (0.9, 0.5, 0.5, 1.0)
    assert transparency(second.active_material) is None
    number = other.nodes.new("ShaderNodeValue")
    number.outputs[0].default_value = 0.25
    other.links.new(number.outputs[0], other.nodes[0].inputs["Alpha"])
    assert transparency(first.active_material) == 0.75
