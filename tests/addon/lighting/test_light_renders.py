"""Light: what Cycles is asked to render for it, and how that is denoised."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from lamp_scenes import SIZE, picture, psnr, scene_of, shine


@pytest.mark.parametrize("mirror", ["Tint", "Half open"])
def test_light_is_one_render_of_the_mirrors_window(blank, room, monkeypatch, mirror):
    """Cycles renders the mirror's pixels once, with the samples asked for; what results cover is asked apart, without
    light."""
    scene_of(blank, "UV", mirror)
    result = parts.generate()
    place, asked = room("addon.lighting.light_scene"), []
    work = place.rendering

    def counted(scene):
        picture = yield from work(scene)
        asked.append((picture.shape[:2], scene.cycles.samples, scene.cycles.max_bounces))
        return picture
    monkeypatch.setattr(place, "rendering", counted)
    bpy.ops.reflection_mesh.light(samples=7)
    view = room("addon.reading").read_view(blank)
    seen = view.pixels(np.array([result.reflection_mesh.mirror.matrix_world @ vertex.co
                                 for vertex in result.reflection_mesh.mirror.data.vertices]))
    width, height = np.ceil(np.clip(seen, 0, SIZE).max(axis=0)) - np.floor(np.clip(seen, 0, SIZE).min(axis=0))
    assert len(asked) == 2 and asked[0][1:] == (7, blank.scene.cycles.max_bounces)
    assert asked[0][0][0] * asked[0][0][1] <= (width + 6) * (height + 6)
    assert all(bounces == 0 for *_, bounces in asked[1:])


@pytest.mark.thorough
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


def test_light_waits_no_longer_for_the_world_than_its_light_needs(blank, room, monkeypatch):
    """Cycles maps the light of the world for each render anew."""
    scene_of(blank)
    world = shine(blank.scene)
    parts.generate()
    place, asked = room("addon.lighting.light_scene"), []
    work = place.rendering

    def counted(scene):
        asked.append(scene.world and (scene.world.cycles.sampling_method, scene.world.cycles.sample_map_resolution))
        return (yield from work(scene))
    monkeypatch.setattr(place, "rendering", counted)
    bpy.ops.reflection_mesh.light(samples=1)
    # what results cover has no sky
    assert asked == [("MANUAL", 512), None]
    assert set(bpy.data.worlds) == {world} and blank.scene.world == world


def test_what_a_result_covers_is_told_finely_where_it_ends(blank, room):
    """Against Cycles with the same samples everywhere, and sixteen times as many."""
    scene_of(blank)
    # edges in every direction, and none where the mirror ends
    bpy.data.objects["Floor"].hide_render = bpy.data.objects["Floor"].hide_viewport = True
    parts.select(bpy.data.objects["Box"], bpy.data.objects["Mirror"])
    result = parts.generate()
    place = room("addon.lighting.light_scene")
    lighting = room("addon.lighting")
    window = lighting.Window.around(room("addon.reading").read_view(blank), lighting.on_the_mirror(result))
    found = []
    for finest in (False, True):
        with lighting.light_scene(blank, [result], window) as scene, pytest.MonkeyPatch.context() as patched:
            if finest:
                patched.setattr(place, "COVERAGE_SAMPLES", 1024)
                patched.setattr(place, "INNER_SAMPLES", 1024)
            found.append(room("addon.faults").finished(scene.coverage())[0])
    few, exact = found
    ends = (exact > 0.0) & (exact < 1.0)
    assert ends.sum() > 100 and np.abs(few - exact).max() < 0.1
    # eight samples, as within, are 0.05 off
    assert np.sqrt(((few - exact)[ends]**2).mean()) < 0.015


@pytest.mark.thorough
@pytest.mark.parametrize(("mirror", "samples", "first"), [
    ("Tint", 16, True), *(pytest.param(*case, marks=pytest.mark.slow) for case in (
        ("Tint", 64, False), ("Fresnel", 64, False), ("Rough", 64, True)))])
def test_albedo_and_normals_are_denoised_first_where_that_helps(blank, room, monkeypatch, mirror, samples, first):
    """It takes twice as long as all else that the denoiser does, and what sharp mirrors show is hardly changed."""
    scene_of(blank, "UV", mirror)
    reference = picture(room)
    parts.generate()
    place, asked, quality = room("addon.lighting.light_scene"), [], []
    work = place.denoise
    for always in (False, True):
        monkeypatch.setattr(place, "denoise", lambda cycles, prefilter, always=always: (
            asked.append(prefilter), work(cycles, "ACCURATE" if always else prefilter)))
        bpy.ops.reflection_mesh.light(samples=samples, kind="PICTURE")
        quality.append(psnr(picture(room), reference))
    assert asked == ["ACCURATE" if first else "NONE"] * 2
    assert quality[0] > quality[1] - 0.2


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


@pytest.mark.thorough
@pytest.mark.parametrize("kind", ["PICTURE", "OBJECTS"])
def test_light_does_not_go_by_what_the_view_layer_sets_for_itself(blank, room, kind):
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
        assert bpy.ops.reflection_mesh.light(samples=4, kind=kind) == {"FINISHED"}
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
