"""Mirror materials: node groups, texture values and roughness."""
from __future__ import annotations

import os
from collections.abc import Callable

import bpy
import numpy as np
import parts
import pytest
from grouped_shaders import into_a_group, shader_of

SIZE = 64


@pytest.fixture
def reading(room, blank):
    return room("addon.reading.materials")


def image(name: str, texels: np.ndarray, colour_space: str = "Non-Color") -> bpy.types.Image:
    """An image of red, green and blue (SIZE, SIZE, 3), as they are stored."""
    made = bpy.data.images.new(name, SIZE, SIZE)
    made.colorspace_settings.name = colour_space
    made.pixels.foreach_set(np.dstack((texels, np.ones((SIZE, SIZE)))).astype(np.float32).ravel())
    return made


def grey(value) -> np.ndarray:
    return np.broadcast_to(np.asarray(value, dtype=np.float64)[..., None], (SIZE, SIZE, 3))


def textured(roughness: np.ndarray | None = None, metallic: np.ndarray | None = None,
             colour_space: str = "Non-Color") -> bpy.types.Material:
    """Chrome of which images tell the roughness or the metallic."""
    made = parts.material("Textured", "PRINCIPLED")
    for name, texels in (("Roughness", roughness), ("Metallic", metallic)):
        if texels is not None:
            texture = made.node_tree.nodes.new("ShaderNodeTexImage")
            texture.image = image(name, texels, colour_space)
            made.node_tree.links.new(texture.outputs["Color"], shader_of(made).inputs[name])
    return made


@pytest.mark.parametrize(("kind", "roughness", "expected"), [
    ("GLOSSY", None, True), ("GLOSSY", 0.05, True), ("GLOSSY", 0.4, False), ("PRINCIPLED", 0.05, True),
    ("DIFFUSE", None, False)])
def test_groups_are_entered_and_say_the_same_everywhere(reading, room, kind, roughness, expected):
    """One navigator serves all: what is a mirror reflects lamps too."""
    made = parts.material("M", kind)
    into_a_group(made, roughness)
    assert reading.is_mirror(made) is expected
    assert room("addon.illumination.mirrors").has_mirrors(made) is expected


@pytest.mark.parametrize("grouped", [False, True])
def test_rough_metal_throws_light_in_its_colour(reading, room, grouped):
    made = parts.material("Gold", "PRINCIPLED", 0.2)
    shader_of(made).inputs["Base Color"].default_value = (0.9, 0.5, 0.2, 1.0)
    if grouped:
        into_a_group(made, 0.2)
    mirrors = room("addon.illumination.mirrors")
    assert mirrors.Tint.of_material(made).colour == pytest.approx((0.9, 0.5, 0.2))
    assert not mirrors.has_mirrors(made)


def test_muted_nodes_and_links_are_passed(reading):
    made = parts.material("M", "GLOSSY")
    node = into_a_group(made, 0.4)
    value = made.node_tree.nodes.new("ShaderNodeValue")
    value.outputs[0].default_value = 0.02
    link = made.node_tree.links.new(value.outputs[0], node.inputs[0])
    assert reading.mirror_roughness(made) == pytest.approx(0.02)
    link.is_muted = True
    assert reading.mirror_roughness(made) == pytest.approx(0.4)
    node.mute = True
    assert reading.mirror_roughness(made) is None


def test_mixes_of_nothing_but_mirrors_are_mirrors(reading):
    made = parts.material("M", "GLOSSY")
    tree, output = made.node_tree, next(node for node in made.node_tree.nodes if node.type == "OUTPUT_MATERIAL")
    mix, other = tree.nodes.new("ShaderNodeMixShader"), tree.nodes.new("ShaderNodeBsdfAnisotropic")
    other.inputs["Roughness"].default_value = 0.08
    tree.links.new(shader_of(made).outputs[0], mix.inputs[1])
    tree.links.new(other.outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], output.inputs["Surface"])
    assert reading.mirror_roughness(made) == pytest.approx(0.08) and reading.is_mirror(made)
    tree.links.new(tree.nodes.new("ShaderNodeBsdfDiffuse").outputs[0], mix.inputs[2])
    assert reading.mirror_roughness(made) is None


RANDOM = np.random.default_rng(4).uniform(size=(SIZE, SIZE))


@pytest.mark.parametrize(("roughness", "metallic", "expected"), [
    (0.02 + 0.06 * RANDOM, None, 0.05), (np.where(RANDOM < 0.3, 0.8, 0.04), None, 0.04),
    (np.where(RANDOM < 0.7, 0.8, 0.04), None, 0.8), (None, np.where(RANDOM < 0.2, 0.0, 1.0), 0.0),
    (None, np.where(RANDOM < 0.7, 0.0, 1.0), None), (None, 0.3 * RANDOM, None),
    # paint that is rough over metal that is sharp
    (np.where(RANDOM < 0.4, 0.7, 0.05), np.where(RANDOM < 0.4, 0.0, 1.0), 0.05)])
def test_images_count_by_the_median_of_what_is_metal(reading, roughness, metallic, expected):
    """Check the median of a grid of texels. Images hold 8 bits, hence the tolerance."""
    made = textured(*(None if one is None else grey(one) for one in (roughness, metallic)))
    assert reading.mirror_roughness(made) == (None if expected is None else pytest.approx(expected, abs=0.005))
    assert reading.is_mirror(made) is (expected is not None and expected <= 0.1)


def test_a_colour_s_own_space_counts(reading):
    """0.3 in sRGB is 0.073 of light."""
    linear = ((0.3 + 0.055) / 1.055)**2.4
    assert reading.mirror_roughness(textured(grey(0.3), colour_space="sRGB")) == pytest.approx(linear, abs=0.004)
    assert reading.mirror_roughness(textured(grey(0.3))) == pytest.approx(0.3, abs=0.004)


def _ramp(tree, socket):
    node = tree.nodes.new("ShaderNodeValToRGB")
    for element, value in zip(node.color_ramp.elements, (0.0, 0.1)):
        element.color = (value, value, value, 1.0)
    tree.links.new(socket, node.inputs[0])
    return node.outputs[0], lambda value: 0.1 * value


def _math(tree, socket):
    node = tree.nodes.new("ShaderNodeMath")
    node.operation = "MULTIPLY"
    node.inputs[1].default_value = 0.25
    tree.links.new(socket, node.inputs[0])
    return node.outputs[0], lambda value: 0.25 * value


def _mix(tree, socket):
    node = tree.nodes.new("ShaderNodeMix")
    node.inputs[0].default_value, node.inputs[2].default_value = 0.25, 0.02
    tree.links.new(socket, node.inputs[3])
    return node.outputs[0], lambda value: 0.25 * value + 0.75 * 0.02


def _multiplied(tree, socket):
    node = tree.nodes.new("ShaderNodeMix")
    node.data_type, node.blend_type = "RGBA", "MULTIPLY"
    node.inputs[0].default_value, node.inputs[7].default_value = 1.0, (0.5, 0.5, 0.5, 1.0)
    tree.links.new(socket, node.inputs[6])
    return node.outputs[2], lambda value: 0.5 * value


def _inverted(tree, socket):
    node = tree.nodes.new("ShaderNodeInvert")
    tree.links.new(socket, node.inputs["Color"])
    return node.outputs[0], lambda value: 1.0 - value


def _range(tree, socket):
    node = tree.nodes.new("ShaderNodeMapRange")
    node.inputs["To Min"].default_value, node.inputs["To Max"].default_value = 0.04, 0.08
    tree.links.new(socket, node.inputs[0])
    return node.outputs[0], lambda value: 0.04 + 0.04 * value


def _curve(tree, socket):
    node = tree.nodes.new("ShaderNodeRGBCurve")
    node.mapping.curves[3].points[1].location = (1.0, 0.2)
    node.mapping.curves[3].points[0].handle_type = node.mapping.curves[3].points[1].handle_type = "VECTOR"
    node.mapping.update()
    tree.links.new(socket, node.inputs["Color"])
    return node.outputs[0], lambda value: 0.2 * value


def _gamma(tree, socket):
    node = tree.nodes.new("ShaderNodeGamma")
    node.inputs[1].default_value = 2.0
    tree.links.new(socket, node.inputs[0])
    return node.outputs[0], lambda value: value**2


def _contrast(tree, socket):
    node = tree.nodes.new("ShaderNodeBrightContrast")
    node.inputs[1].default_value = -0.1
    tree.links.new(socket, node.inputs[0])
    return node.outputs[0], lambda value: max(value - 0.1, 0.0)


@pytest.mark.parametrize("changed", [_ramp, _math, _mix, _multiplied, _inverted, _range, _curve, _gamma, _contrast])
def test_nodes_on_the_way_are_followed(reading, changed: Callable):
    """Check the formulas of Blender's manual, which Cycles uses too."""
    value = 0.4
    made = textured(grey(value))
    tree, socket = made.node_tree, shader_of(made).inputs["Roughness"]
    output, expected = changed(tree, socket.links[0].from_socket)
    tree.links.new(output, socket)
    assert reading.mirror_roughness(made) == pytest.approx(expected(value), abs=0.004)


def test_the_channel_that_is_plugged_in_counts(reading):
    """Check packed textures: roughness in green, metallic in blue."""
    made = textured(np.dstack((np.full((SIZE, SIZE), 0.9), 0.06 * np.ones((SIZE, SIZE)), np.ones((SIZE, SIZE)))))
    tree, shader = made.node_tree, shader_of(made)
    split = tree.nodes.new("ShaderNodeSeparateColor")
    tree.links.new(shader.inputs["Roughness"].links[0].from_socket, split.inputs[0])
    tree.links.new(split.outputs[1], shader.inputs["Roughness"])
    tree.links.new(split.outputs[2], shader.inputs["Metallic"])
    assert reading.mirror_roughness(made) == pytest.approx(0.06, abs=0.004)
    tree.links.new(split.outputs[0], shader.inputs["Roughness"])
    assert reading.mirror_roughness(made) == pytest.approx(0.9, abs=0.004)


def test_what_depends_on_the_eye_or_the_mesh_is_not_known(reading):
    """Such metal is a mirror where it is asked for alone; what may be no metal is none."""
    for kind in ("ShaderNodeLayerWeight", "ShaderNodeAttribute"):
        for name, expected in (("Roughness", float("inf")), ("Metallic", None)):
            made = parts.material("M", "PRINCIPLED")
            tree = made.node_tree
            node = tree.nodes.new(kind)
            tree.links.new(node.outputs["Facing" if kind.endswith("Weight") else "Fac"], shader_of(made).inputs[name])
            assert reading.mirror_roughness(made) == expected


def test_images_are_read_once_and_again_where_they_are_others(reading, room, monkeypatch, tmp_path):
    samples = room("addon.reading.materials.image_samples")
    made, read, work = textured(grey(0.05)), [], samples._read
    monkeypatch.setattr(samples, "_read", lambda one: read.append(one.name) or work(one))
    own = bpy.data.images["Roughness"]
    # a button that asks on every redraw reads nothing, and is not grey
    assert reading.least_roughness(made) == 0.0 and not read
    assert reading.is_mirror(made) and reading.is_mirror(made) and len(read) == 1
    assert reading.least_roughness(made) == pytest.approx(0.05, abs=0.004)
    own.pixels.foreach_set(np.dstack((grey(0.7), np.ones((SIZE, SIZE)))).astype(np.float32).ravel())
    reading.look_again()
    assert not reading.is_mirror(made) and len(read) == 2
    # and so is a file that another program writes, which is in no memory afterwards
    own.filepath_raw, own.file_format = str(tmp_path / "rough.png"), "PNG"
    own.save()
    texture = next(node for node in made.node_tree.nodes if node.type == "TEX_IMAGE")
    texture.image = bpy.data.images.load(str(tmp_path / "rough.png"))
    texture.image.colorspace_settings.name = "Non-Color"
    texture.image.buffers_free()
    assert not reading.is_mirror(made) and not texture.image.has_data
    read.clear()
    reading.look_again()
    assert not reading.is_mirror(made) and not read
    own.pixels.foreach_set(np.dstack((grey(0.05), np.ones((SIZE, SIZE)))).astype(np.float32).ravel())
    own.save()
    texture.image.reload()
    written = (tmp_path / "rough.png").stat().st_mtime
    os.utime(tmp_path / "rough.png", (written + 5.0, written + 5.0))
    reading.look_again()
    assert reading.is_mirror(made) and len(read) == 1
