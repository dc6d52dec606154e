"""Light: what Cycles is asked to render for it, and how that is denoised."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from lamp_scenes import picture, scene_of


@pytest.mark.parametrize(("name", "value"), [
    ("visible_camera", False), pytest.param("is_shadow_catcher", True, marks=pytest.mark.slow)])
def test_a_mirror_that_is_not_seen_as_it_is_lights_its_result_all_the_same(blank, room, name, value):
    """As one that is hidden by hand, so that the result alone is seen; it stays that."""
    wall = scene_of(blank, "UV", "Tint")
    reference, other = picture(room), picture(room, seed=7)
    result = parts.generate()
    setattr(wall, name, value)
    assert bpy.ops.reflection_mesh.light(samples=64) == {"FINISHED"}
    assert getattr(wall, name) == value
    # of the mirror itself nothing is seen beside the result
    inside = np.abs(_without(room, result) - picture(room)).max(axis=2) > 0.02
    inside = _inner(inside)
    assert inside.sum() > 500
    lit, noise = (np.sqrt(((shown - reference)[inside]**2).mean()) for shown in (picture(room), other))
    assert lit < max(10.0**(-38.0 / 20.0), 1.2 * noise)


def _without(room, result: bpy.types.Object) -> np.ndarray:
    result.hide_render = True
    try:
        return picture(room)
    finally:
        result.hide_render = False


def _inner(mask: np.ndarray) -> np.ndarray:
    """The pixels of a mask (height, width) all of whose neighbours are of it."""
    padded = np.pad(mask, 1)
    return np.lib.stride_tricks.sliding_window_view(padded, (3, 3)).all(axis=(2, 3))


def test_a_blender_without_the_denoiser_renders_with_noise(room):
    class Cycles:
        use_denoising = True

        def __setattr__(self, name, value):
            # as Blender says it
            if value == "OPENIMAGEDENOISE":
                raise TypeError('bpy_struct: item.attr = val: enum "OPENIMAGEDENOISE" not found in ()')
            super().__setattr__(name, value)
    cycles = Cycles()
    room("addon.rendering").denoise(cycles)
    assert cycles.use_denoising is False


def test_light_does_not_go_by_what_the_view_layer_sets_for_itself(blank, room):
    """Its own samples, denoising switched off, one material for all, and not being rendered: bit for bit the same."""
    scene_of(blank, "UV", "Rough")
    layer, chosen, found = blank.view_layer, list(blank.selected_objects), []
    for own in (False, True):
        if own:
            layer.samples, layer.use, layer.cycles.use_denoising = 1, False, False
            layer.material_override = parts.material("Clay", "DIFFUSE")
        parts.select(*chosen)
        blank.view_layer.objects.active = bpy.data.objects["Mirror"]
        result = parts.generate()
        assert bpy.ops.reflection_mesh.light(samples=4) == {"FINISHED"}
        material = result.material_slots[0].material
        image = next(node.image for node in material.node_tree.nodes if node.type == "TEX_IMAGE")
        pixels = np.empty(len(image.pixels), dtype=np.float32)
        image.pixels.foreach_get(pixels)
        found.append(pixels)
        bpy.ops.reflection_mesh.clear()
        # what the scene animates would be set again as it is rendered
        blank.scene.cycles.samples = 1
        blank.scene.cycles.keyframe_insert("samples", frame=blank.scene.frame_current)
    assert found[0].size and np.array_equal(*found)
    assert (layer.samples, layer.use, layer.cycles.use_denoising) == (1, False, False)
    assert layer.material_override.name == "Clay"
