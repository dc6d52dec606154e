"""Light on objects in bands, between which a window goes on: as near to Cycles as in one, and stopped anywhere."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from lamp_scenes import lit_state, picture, psnr, scene_of, shader_of


def light_between_events(context: bpy.types.Context, room, samples: int) -> list[str]:
    """Light as a window makes it; returns the stages."""
    results = [obj for obj in context.scene.objects if obj.name.endswith("Reflection")]
    with room("addon.faults.between_events").steps_taken(apart=True):
        return [stage for _, stage in room("addon.operators.light").lighting(context, results, samples, "OBJECTS")]


def in_small_bands(monkeypatch, room) -> list:
    """Bands of a few rows, as of a slow scene; returns what becomes the size of each bake and whether it denoises."""
    made, bakes = [], room("addon.baking.stage.bakes")
    bake = bakes.BakeScene._bake_into

    def noted(self, image, values, objects, scene, **what):
        made.append((values.shape[:2], scene.cycles.use_denoising))
        bake(self, image, values, objects, scene, **what)
    monkeypatch.setattr(room("addon.baking.stage.bands").Bands, "rows", lambda *_: 24)
    monkeypatch.setattr(bakes.BakeScene, "_bake_into", noted)
    return made


@pytest.mark.parametrize("kind", ["UV", "shines", *(pytest.param(kind, marks=pytest.mark.slow)
                                                   for kind in ("Gloss", "Alpha"))])
def test_it_is_what_the_mirror_shows(blank, room, monkeypatch, kind):
    """Also what shines by itself, which is added to the light on it after that is denoised."""
    scene_of(blank, "" if kind == "shines" else kind).reflection_mesh.role = "MIRROR"
    if kind == "shines":
        shader_of(bpy.data.materials["Source"]).inputs["Emission Strength"].default_value = 0.5
    reference, other = picture(room), picture(room, seed=7)
    parts.generate()
    whole = in_small_bands(monkeypatch, room)
    assert bpy.ops.reflection_mesh.light(samples=32, kind="OBJECTS") == {"FINISHED"}
    in_one = psnr(picture(room), reference)
    count = len(whole)
    light_between_events(blank, room, 32)
    in_bands = psnr(picture(room), reference)
    assert len(whole) - count > 3 * count
    assert in_bands > min(38.0, psnr(other, reference) - 1.5) and in_bands > in_one - 1.5


def test_bands_are_denoised_together(blank, room, monkeypatch):
    scene_of(blank, "UV").reflection_mesh.role = "MIRROR"
    parts.generate()
    made = in_small_bands(monkeypatch, room)
    stages = light_between_events(blank, room, 8)
    sizes = [size for size, denoised in made if denoised]
    assert sizes and not set(sizes) & {size for size, denoised in made if not denoised}
    undivided = [stage for stage in stages if isinstance(stage, room("addon.faults").Undivided)]
    assert len(undivided) == len(sizes) and all(stage.startswith("Cycles bakes the light on '") for stage in undivided)


@pytest.mark.parametrize("step", [0, 1, 2, 5, 9, 13, 20, 30])
def test_stopped_between_bands_it_leaves_no_trace(blank, room, monkeypatch, step):
    scene_of(blank, "Alpha")
    result = parts.generate()
    before = lit_state()
    in_small_bands(monkeypatch, room)
    with room("addon.faults.between_events").steps_taken(apart=True):
        steps = room("addon.operators.light").lighting(blank, [result], 4, "OBJECTS")
        while step >= 0:
            step -= next(steps)[1].startswith("Cycles bakes")
        steps.close()
    assert lit_state() == before


@pytest.mark.parametrize("noise", [0.0, 0.1, 0.4])
@pytest.mark.parametrize("before", [0.05, 0.15, 1.0])
@pytest.mark.parametrize("speed", [3e4, 3e5, 3e6])
def test_bands_are_as_long_as_a_window_waits(room, before, speed, noise):
    """A band takes half a second, or what goes before its first sample twice, or a part of very long work; all together
    takes twice as long as in one, and what is learned at the beginning. It is alike where times are hardly known: ever
    smaller bands, because one was slow, would never end."""
    rng, samples, rows = np.random.default_rng(1), 1000 * 4, 4000
    whole = before + rows * samples / speed
    for _ in range(10):
        bands, row, taken = room("addon.baking.stage.bands").Bands(), 0, []
        while row < rows:
            wanted = bands.rows(samples, rows)
            some = min(wanted, rows - row)
            taken.append((before + some * samples / speed) * rng.uniform(1.0 - noise, 1.0 + noise))
            if some == wanted:
                bands.took(taken[-1], some * samples)
            row += some
        assert np.sum(taken) < (2.2 if noise == 0.0 else 4.0) * whole + 12.0 * before
        if noise == 0.0:
            assert max(taken) < max(0.5, 2.1 * before, whole / 100)


def test_bands_are_no_shorter_than_what_a_window_takes_to_draw(room):
    """Else all together would take far longer, and the window would not be the quicker for it."""
    bands, before, between, speed = room("addon.baking.stage.bands").Bands(), 0.1, 2.0, 3e5
    for _ in range(12):
        samples = 2000 * bands.rows(2000, 4000)
        taken = before + samples / speed
        bands.took(taken, samples, between)
    assert 0.9 * between < taken < 1.1 * between


def test_any_seed_will_do(blank, room, monkeypatch):
    """Bands have seeds of their own, and Blender's end at two thousand millions."""
    scene_of(blank)
    parts.generate()
    in_small_bands(monkeypatch, room)
    blank.scene.cycles.seed = 2**31 - 1
    light_between_events(blank, room, 1)
    assert "Reflection Light" in bpy.data.images and blank.scene.cycles.seed == 2**31 - 1


def test_what_only_mirrors_see_is_baked_in_bands_too(blank, room, monkeypatch):
    """It is seen by no ray but theirs, and where it is denoised by none at all."""
    scene_of(blank, "UV").reflection_mesh.role = "MIRROR"
    for obj in map(bpy.data.objects.get, ("Box", "Floor")):
        obj.visible_camera = obj.visible_volume_scatter = obj.visible_transmission = False
    reference, other = picture(room), picture(room, seed=7)
    parts.generate()
    in_small_bands(monkeypatch, room)
    light_between_events(blank, room, 32)
    assert psnr(picture(room), reference) > min(38.0, psnr(other, reference) - 1.5)
