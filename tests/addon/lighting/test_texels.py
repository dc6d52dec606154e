"""Texels: drawn, they show the picture that they are made of, and what lies beside it is taken out."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from lamp_scenes import picture, psnr, scene_of


def test_texels_show_the_picture_that_they_are_made_of(room):
    """In closed form: a pixel is the integral of linearly interpolated texels times Cycles' filter."""
    texels, finished = room("addon.lighting.picture.texels"), room("addon.faults").finished
    rng = np.random.default_rng(1)
    for kind, width in (("BLACKMAN_HARRIS", 1.5), ("BOX", 1.0), ("GAUSSIAN", 1.5)):
        kernel = texels.pixel_kernel(kind, width)
        assert abs(kernel.sum() - 1.0) < 1e-12 and np.allclose(kernel, kernel[::-1])
        smooth = 0.3 + 0.2 * rng.random((20, 30, 3))
        shown = _shown(smooth, kernel)
        found = finished(texels.texels_of(shown.astype(np.float32), np.ones((20, 30), np.float32), kernel))
        assert np.abs(found - smooth)[6:-6, 6:-6].max() < 0.02


def test_only_what_lies_beside_is_taken_out_where_a_picture_ends(room):
    """A result that ends at its mirror's outline with one side, and within it with the other, before nothing: of the
    outline's pixels nothing has to be taken away but the mirror's light."""
    texels, finished = room("addon.lighting.picture.texels"), room("addon.faults").finished
    opacity = np.clip(np.arange(20.0) - 4.5, 0.0, 1.0)[None].repeat(12, 0)
    coverage = opacity * np.clip(12.4 - np.arange(20.0), 0.0, 1.0)
    own, beside = np.array((0.8, 0.5, 0.1)), np.array((0.1, 0.4, 0.9))
    light = coverage[..., None] * own + (opacity - coverage)[..., None] * beside
    found = finished(texels.texels_of(*(values.astype(np.float32) for values in (light, coverage)),
                                      texels.pixel_kernel("BOX", 1.0), opacity=opacity.astype(np.float32)))
    assert np.abs(found[:, 4:14] - own).max() < 0.02


@pytest.mark.thorough
def test_a_result_that_ends_within_its_mirror_is_sharp_there(blank, room):
    """The mirror shows the world beside it, and the camera sees both in one pixel."""
    scene_of(blank)
    card = parts.add("plane", "Card", size=1.5, location=(0.3, -1.5, 1.0), rotation=(-np.pi / 2, 0.0, 0.4))
    card.data.materials.append(parts.material("Card"))
    card.visible_camera = False
    for name in ("Box", "Floor"):
        bpy.data.objects.remove(bpy.data.objects[name])
    parts.select(card, bpy.data.objects["Mirror"])
    reference = picture(room)
    parts.generate()
    assert bpy.ops.reflection_mesh.light(kind="PICTURE", every=True) == {"FINISHED"}
    assert psnr(picture(room), reference) > 60.0  # measured: 66.0 dB


def test_what_lies_beside_is_taken_out_of_pixels_covered_in_part(room):
    texels, finished = room("addon.lighting.picture.texels"), room("addon.faults").finished
    coverage = np.clip(np.arange(20.0) - 9.7, 0.0, 1.0)[None].repeat(12, 0)
    own, beside = np.array((0.8, 0.5, 0.1)), np.array((0.1, 0.4, 0.9))
    light = coverage[..., None] * own + (1.0 - coverage[..., None]) * beside
    found = finished(texels.texels_of(light.astype(np.float32), coverage.astype(np.float32),
                                      texels.pixel_kernel("BOX", 1.0)))
    assert np.abs(found[:, 8:] - own).max() < 0.02 and (found[:, :5] == 0.0).all()


def test_what_covers_no_pixel_well_shows_what_pixels_have_of_it_together(room):
    """Two wires of a fifth of a pixel, before nothing, which another thing is much nearer to one of."""
    texels, finished = room("addon.lighting.picture.texels"), room("addon.faults").finished
    coverage = np.zeros((24, 30))
    coverage[:, 4], coverage[:, 5], coverage[:, 14], coverage[:, 20:] = 0.12, 0.08, 0.2, 1.0
    own = np.zeros((24, 30, 3))
    own[:, :8], own[:, 8:17], own[:, 17:] = (0.8, 0.1, 0.1), (9.0, 3.0, 0.0), (0.1, 0.1, 0.9)
    beside = np.array((0.5, 0.4, 0.3))
    light = coverage[..., None] * own + (1.0 - coverage[..., None]) * beside
    found = finished(texels.texels_of(light.astype(np.float32), coverage.astype(np.float32),
                                      texels.pixel_kernel("BOX", 1.0)))
    assert np.abs(found[:, 4:6] - own[:, 4:6]).max() < 0.05 and np.abs(found[:, 14] - own[:, 14]).max() < 0.3


def test_beside_a_lamp_a_result_ends_as_it_is_within(room):
    """What is taken out of a pixel that holds both is a hundred times brighter: a hundredth more is all that there is,
    and a hundredth less is a spark."""
    texels, finished = room("addon.lighting.picture.texels"), room("addon.faults").finished
    coverage = np.clip(np.arange(20.0) - 9.7, 0.0, 1.0)[None].repeat(12, 0)
    own, lamp = np.array((0.6, 0.5, 0.3)), np.array((80.0, 60.0, 40.0))
    light = coverage[..., None] * own + (1.0 - coverage[..., None]) * lamp
    for wrong in (0.01, -0.01):
        told = np.where((coverage > 0.0) & (coverage < 1.0), coverage + wrong, coverage)
        found = finished(texels.texels_of(light.astype(np.float32), told.astype(np.float32),
                                          texels.pixel_kernel("BOX", 1.0)))
        assert np.abs(found[:, 9:] - own).max() < 0.05


def test_a_gap_before_a_lamp_is_no_part_of_the_lamp(room):
    """Thinner than a pixel: in what lies beside it is the lamp alone that is seen whole."""
    texels, finished = room("addon.lighting.picture.texels"), room("addon.faults").finished
    coverage = np.clip(np.arange(20.0) - 9.7, 0.0, 1.0)[None].repeat(12, 0)
    own, gap, lamp = np.array((0.6, 0.5, 0.3)), np.array((0.1, 0.1, 0.1)), np.array((80.0, 60.0, 40.0))
    light = coverage[..., None] * own + (1.0 - coverage[..., None]) * gap
    light[:, :10] = lamp
    found = finished(texels.texels_of(light.astype(np.float32), coverage.astype(np.float32),
                                      texels.pixel_kernel("BOX", 1.0)))
    assert np.abs(found[:, 9:] - own).max() < 0.1


def test_a_gap_between_results_shows_nothing_of_what_lies_farther_away(room):
    """Two pieces of a result with a dark gap between them, thinner than a pixel; what is bright lies behind the second,
    and every pixel up to there holds a little that is no result."""
    texels, finished = room("addon.lighting.picture.texels"), room("addon.faults").finished
    coverage = np.ones((12, 20))
    coverage[:, 9], coverage[:, 10:14], coverage[:, 14:] = 0.6, 0.98, 0.0
    own, beside = np.array((0.8, 0.5, 0.1)), np.array((0.1, 0.4, 0.9))
    light = coverage[..., None] * own
    light[:, 14:] = beside
    found = finished(texels.texels_of(light.astype(np.float32), coverage.astype(np.float32),
                                      texels.pixel_kernel("BOX", 1.0)))
    assert np.abs(found[:, :11] - own).max() < 0.02


def test_what_is_overexposed_in_one_colour_is_as_bright_as_it_is_where_a_result_ends(room):
    """Where a pixel holds a part of it, half of twice white is white: white itself would be half as bright."""
    texels, finished = room("addon.lighting.picture.texels"), room("addon.faults").finished
    coverage = np.clip(np.arange(20.0) - 9.7, 0.0, 1.0)[None].repeat(12, 0)
    own, beside = np.array((2.0, 0.4, 0.3)), np.array((0.1, 0.4, 0.9))
    light = coverage[..., None] * own + (1.0 - coverage[..., None]) * beside
    found = finished(texels.texels_of(light.astype(np.float32), coverage.astype(np.float32),
                                      texels.pixel_kernel("BOX", 1.0), white=1.0))
    assert np.abs(found[:, 9:] - own).max() < 0.05


@pytest.mark.parametrize("faces", ["ALL", "MATTE"])
def test_a_lamp_thinner_than_a_pixel_beside_a_result_is_no_part_of_it(room, faces):
    """Of a lamp a thousand times white, an eighth of a pixel beside where the result ends, so much is spilt into pixels
    that this covers whole that they are white; farther within, one that stands before it is as bright as it is."""
    texels, finished = room("addon.lighting.picture.texels"), room("addon.faults").finished
    fine, (height, width) = 8, (24, 32)
    across = np.arange(fine * width)
    covered = np.broadcast_to(across >= 76, (fine * height, fine * width)).astype(float)
    shown = np.where(covered > 0.0, 0.1, 0.15)
    # a spark of two pixels' height beside the result, and one of two by two pixels before it
    shown[64:80, 74:76], shown[64:80, 192:208] = 1000.0, 50.0
    light, coverage = (_in_pixels(picture, fine) for picture in (shown, covered))
    found = finished(texels.texels_of(light.astype(np.float32)[..., None].repeat(3, axis=2),
                                      coverage.astype(np.float32), texels.pixel_kernel("BLACKMAN_HARRIS", 1.5),
                                      white=1.0, faces=faces))
    assert light[9, 10] > 1.0 and coverage[9, 10] > 0.99
    assert np.abs(found[:, 10:20] - 0.1).max() < 0.05 and found[9, 24:26].min() > 5.0


def test_a_bright_strip_along_a_frame_is_no_lamp_beside_it(room):
    """Overexposed and three pixels wide, of which the middle one alone is covered whole and, by its noise, a little
    less bright than those beside; its end is dark, and so is what the bare mirror shows."""
    texels, finished = room("addon.lighting.picture.texels"), room("addon.faults").finished
    coverage, opacity, own = np.zeros((16, 20)), np.ones((16, 20)), np.full((16, 20), 1.5)
    coverage[:, 5], coverage[:, 6], coverage[:, 7] = 0.9, 1.0, 0.8
    opacity[:, :6] = coverage[:, :6]
    own[:4], own[4:, 6] = 0.03, 1.25
    light = (own * coverage + 0.05 * (opacity - coverage))[..., None].repeat(3, axis=2)
    found = finished(texels.texels_of(light.astype(np.float32), coverage.astype(np.float32),
                                      texels.pixel_kernel("BOX", 1.0), white=1.0, opacity=opacity.astype(np.float32)))
    # what is to be white may be whiter
    assert found[6:, 5:8].min() > 0.9 and found[:2, 5:8].max() < 0.1


def test_a_bright_rim_of_what_a_result_shows_is_no_lamp_beside_it(room):
    """As light from behind makes it: a quarter of a pixel wide and eight times white, in pixels that are covered in
    part, and dark on both sides. Over the bare mirror the texels show the picture again, as nearly as one a pixel
    can."""
    texels, finished = room("addon.lighting.picture.texels"), room("addon.faults").finished
    fine, (height, width) = 8, (16, 32)
    across = np.broadcast_to(np.arange(fine * width), (fine * height, fine * width))
    covered, bare = (across >= 76).astype(float), 0.15
    shown = np.where(across < 76, bare, np.where(across < 78, 8.0, 0.1))
    light, coverage = (_in_pixels(picture, fine) for picture in (shown, covered))
    found = finished(texels.texels_of(light.astype(np.float32)[..., None].repeat(3, axis=2),
                                      coverage.astype(np.float32), texels.pixel_kernel("BLACKMAN_HARRIS", 1.5),
                                      white=1.0))
    between = np.interp((across[0] + 0.5) / fine, np.arange(width) + 0.5, found[8, :, 0])
    again = _in_pixels(covered * between + (1.0 - covered) * bare, fine)
    off = np.minimum(again, 1.0) - np.minimum(light, 1.0)
    assert light[8, 9] > 1.0 and np.abs(off[8, 6:26]).max() < 0.35


def _in_pixels(picture: np.ndarray, fine: int) -> np.ndarray:
    """A picture of so many places a pixel through Cycles' filter of 1.5 pixels, in closed form."""
    at = (np.arange(3 * fine) + 0.5) / (3 * fine)
    turn = 2.0 * np.pi * at
    weight = 0.35875 - 0.48829 * np.cos(turn) + 0.14128 * np.cos(2.0 * turn) - 0.01168 * np.cos(3.0 * turn)
    for axis in (0, 1):
        around = np.pad(picture, [(fine, fine) if axis == side else (0, 0) for side in (0, 1)], mode="edge")
        windows = np.lib.stride_tricks.sliding_window_view(around, 3 * fine, axis=axis)
        picture = (windows[::fine] if axis == 0 else windows[:, ::fine]) @ (weight / weight.sum())
    return picture


def test_beside_small_lamps_it_is_nearly_as_dark_as_it_is(room):
    """Lamps of two to four texels in the dark, whose picture is known in closed form, up to white."""
    texels, finished = room("addon.lighting.picture.texels"), room("addon.faults").finished
    kernel, dark = texels.pixel_kernel("BLACKMAN_HARRIS", 1.5), 0.05
    true = np.full((40, 40, 3), dark)
    true[8:10, 8:10], true[8:11, 25:28], true[25:27, 7:10], true[25:29, 25:29] = 9.0, 30.0, 3.0, 100.0
    picture = _shown(true, kernel)
    found = finished(texels.texels_of(picture.astype(np.float32), np.ones((40, 40), np.float32), kernel, white=1.0))
    shown = _shown(found.astype(np.float64), kernel)
    off = (np.minimum(shown, 1.0) - np.minimum(picture, 1.0))[4:-4, 4:-4]
    assert np.sqrt((off**2).mean()) < 0.02


def _shown(texels: np.ndarray, kernel: np.ndarray) -> np.ndarray:
    """What texels show, in closed form: interpolated linearly, through the filter."""
    for axis in (0, 1):
        texels = sum(weight * np.roll(texels, step - len(kernel) // 2, axis) for step, weight in enumerate(kernel))
    return texels
