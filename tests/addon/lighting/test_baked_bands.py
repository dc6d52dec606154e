"""Light on objects in bands, between which a window goes on: as near to Cycles as in one, and stopped anywhere."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from lamp_scenes import lit_state, picture, psnr, scene_of, shader_of

TILE = 96  # texels


def light_between_events(context: bpy.types.Context, room, samples: int) -> list[str]:
    """Light as a window makes it; returns the stages."""
    results = [obj for obj in context.scene.objects if obj.name.endswith("Reflection")]
    with room("addon.faults.between_events").steps_taken(apart=True):
        return [stage for _, stage in room("addon.operators.light").lighting(context, results, samples, "OBJECTS")]


def in_small_bands(monkeypatch, room) -> list:
    """Bands of a few rows and small tiles, as of a slow scene and a large map; returns what becomes the size of each
    bake and whether it denoises."""
    made, bakes = [], room("addon.baking.stage.bakes")
    bake = bakes.BakeScene._bake_into

    def noted(self, image, values, objects, scene, **what):
        made.append((values.shape[:2], scene.cycles.use_denoising))
        bake(self, image, values, objects, scene, **what)
    monkeypatch.setattr(room("addon.baking.stage.bands").Bands, "rows",
                        lambda _, samples, row: min(24, len(samples) - row))
    monkeypatch.setattr(room("addon.baking.stage.tiles"), "LONGEST", TILE)
    monkeypatch.setattr(bakes.BakeScene, "_bake_into", noted)
    return made


@pytest.mark.thorough
@pytest.mark.parametrize(("kind", "measured"), [("shines", 46.4), *(
    pytest.param(*kinds, marks=pytest.mark.slow) for kinds in (("UV", 44.3), ("Gloss", 42.1), ("Alpha", 44.0)))])
def test_it_is_what_the_mirror_shows(blank, room, monkeypatch, kind, measured):
    """Also what shines by itself, which is added to the light on it after that is denoised."""
    scene_of(blank, "" if kind == "shines" else kind).reflection_mesh.role = "MIRROR"
    if kind == "shines":
        shader_of(bpy.data.materials["Source"]).inputs["Emission Strength"].default_value = 0.5
    reference = picture(room)
    parts.generate()
    whole = in_small_bands(monkeypatch, room)
    assert bpy.ops.reflection_mesh.light(samples=32, kind="OBJECTS") == {"FINISHED"}
    in_one = psnr(picture(room), reference)
    count = len(whole)
    light_between_events(blank, room, 32)
    in_bands = psnr(picture(room), reference)
    assert len(whole) - count > 3 * count
    assert in_bands > measured - 2.5 and in_bands > in_one - 1.5


@pytest.mark.thorough
def test_bands_are_denoised_in_tiles(blank, room, monkeypatch):
    """Wider than bands, which have a seed each, and no larger than what takes a moment: nothing is to be waited for."""
    scene_of(blank, "UV").reflection_mesh.role = "MIRROR"
    parts.generate()
    made = in_small_bands(monkeypatch, room)
    stages = light_between_events(blank, room, 8)
    sizes = np.array([size for size, denoised in made if denoised])
    assert len(sizes) and (sizes <= TILE).all() and (sizes > 24).all()
    assert len(made) - len(sizes) > len(sizes)
    baked = [stage for stage in stages if stage.startswith("Baking light on '")]
    assert baked and not any(isinstance(stage, room("addon.faults").Undivided) for stage in baked)


@pytest.mark.thorough
@pytest.mark.parametrize("apart", [False, True])
def test_what_is_lit_already_takes_no_part(blank, room, monkeypatch, apart):
    """Cycles would take up the picture of its light for each band: a relit bathroom took twice as long as at first."""
    scene_of(blank, "UV").reflection_mesh.role = "MIRROR"
    result, scenes = parts.generate(), []
    if apart:
        place = bpy.data.collections.new("Reflections")
        blank.scene.collection.children.link(place)
        for other in list(result.users_collection):
            other.objects.unlink(result)
        place.objects.link(result)
    bake = room("addon.baking.stage.bakes").BakeScene._bake_into

    def noted(self, image, values, objects, scene, **what):
        # as Blender does before it bakes
        scene.view_layers[0].update()
        scenes.append({obj.original for obj in scene.view_layers[0].objects})
        bake(self, image, values, objects, scene, **what)
    monkeypatch.setattr(room("addon.baking.stage.bakes").BakeScene, "_bake_into", noted)
    layers = [layer.exclude for layer in blank.view_layer.layer_collection.children]
    for _ in range(2):
        light_between_events(blank, room, 1)
        assert scenes and not any(result in shown for shown in scenes)
    assert any(bpy.data.objects["Mirror"] in shown for shown in scenes)
    assert result.reflection_mesh.light_material and result in set(blank.view_layer.objects)
    assert [layer.exclude for layer in blank.view_layer.layer_collection.children] == layers


@pytest.mark.parametrize("size", [(1, 1), (1, 700), (33, 321), (320, 320), (321, 320), (700, 1000)])
def test_tiles_cover_a_picture(room, size):
    tiles = room("addon.baking.stage.tiles")
    count = np.zeros(size, dtype=int)
    for rows, columns in tiles.tiles(*size):
        assert max(count[rows, columns].shape) <= tiles.LONGEST
        count[rows, columns] += 1
    assert count.min() == 1 and count.max() <= 4


def test_tiles_fade_into_each_other(room):
    """Each as bright as it likes: nowhere is there a step, as a denoiser that sees parts would make it; what is not
    there, or was found by none, stays as it was."""
    tiles = room("addon.baking.stage.tiles")
    rng = np.random.default_rng(2)
    values = rng.uniform(size=(700, 900, 4)).astype(np.float32)
    values[300:310, :, 3] = values[0, 0, 3] = tiles.UNTOUCHED
    before, bright = values.copy(), iter(rng.uniform(size=100).tolist())

    def changed(tile):
        found = np.where(before[tile][..., 3:] == tiles.UNTOUCHED, tiles.UNTOUCHED, next(bright)).astype(np.float32)
        found = np.repeat(found, 4, axis=2)
        found[before[tile][..., 0] > 0.999] = tiles.UNTOUCHED
        return found
    shares = list(tiles.in_tiles(values, changed))
    assert shares == sorted(shares) and shares[0] == 0.0 and len(shares) == len(tiles.tiles(700, 900))
    kept = (before[..., 3] == tiles.UNTOUCHED) | (before[..., 0] > 0.999)
    assert (values[kept] == before[kept]).all() and (values[~kept] != before[~kept]).all()
    for axis in (0, 1):
        step = np.abs(np.diff(np.where(kept, np.nan, values[..., 1]), axis=axis))
        assert np.nanmax(step) < 2.0 / tiles.OVERLAP


@pytest.mark.thorough
@pytest.mark.parametrize("step", [0, 1, 2, 5, 9, 13, 20, 30])
def test_stopped_between_bands_it_leaves_no_trace(blank, room, monkeypatch, step):
    scene_of(blank, "Alpha")
    result = parts.generate()
    before = lit_state()
    in_small_bands(monkeypatch, room)
    with room("addon.faults.between_events").steps_taken(apart=True):
        steps = room("addon.operators.light").lighting(blank, [result], 4, "OBJECTS")
        while step >= 0:
            step -= next(steps)[1].startswith("Baking light")
        steps.close()
    assert lit_state() == before


@pytest.mark.thorough
@pytest.mark.parametrize("noise", [0.0, 0.1, 0.4])
@pytest.mark.parametrize("before", [0.05, 0.15, 1.0])
@pytest.mark.parametrize("speed", [3e4, 3e5, 3e6])
@pytest.mark.parametrize("empty", [0.0, 0.9])
def test_bands_are_as_long_as_a_window_waits(room, before, speed, noise, empty):
    """A band takes half a second, or what goes before its first sample twice, or a part of very long work; all together
    takes twice as long as in one, and what is learned at the beginning. It is alike where times are hardly known: ever
    smaller bands, because one was slow, would never end; and where most of a picture is empty."""
    rng, rows = np.random.default_rng(1), 4000
    samples = np.where(np.sin(np.arange(rows) / 100.0) < 2.0 * empty - 1.0, 0.02, 1.0)
    samples *= 4000.0 * rows / samples.sum()
    whole = before + samples.sum() / speed
    for _ in range(10):
        bands, row, taken = room("addon.baking.stage.bands").Bands(), 0, []
        while row < rows:
            end = row + bands.rows(samples, row)
            taken.append((before + samples[row:end].sum() / speed) * rng.uniform(1.0 - noise, 1.0 + noise))
            if end < rows:
                bands.took(taken[-1], samples[row:end].sum())
            row = end
        assert row == rows and np.sum(taken) < (2.2 if noise == 0.0 else 4.0) * whole + 12.0 * before
        if noise == 0.0:
            assert max(taken) < max(0.5, 2.1 * before, whole / 100)
            assert bands.are_long == (before > 0.25)


def test_bands_are_no_shorter_than_what_a_window_takes_to_draw(room):
    """Else all together would take far longer, and the window would not be the quicker for it."""
    bands, before, between, speed = room("addon.baking.stage.bands").Bands(), 0.1, 2.0, 3e5
    samples, row = np.full(40000, 200.0), 0
    for _ in range(12):
        end = row + bands.rows(samples, row)
        taken = before + samples[row:end].sum() / speed
        bands.took(taken, samples[row:end].sum(), between)
        row = end
    assert 0.9 * between < taken < 1.1 * between and bands.are_long


def test_rows_tell_what_is_baked_into_them(blank, room):
    """Against the middles of texels that lie in triangles."""
    rng, (width, height) = np.random.default_rng(3), (360, 240)
    places = rng.uniform(0.05, 0.25, size=(12, 3, 2)) + np.stack(np.meshgrid(
        np.arange(4) / 4, np.arange(3) / 3), axis=-1).reshape(12, 1, 2)
    objects = [parts.add_triangle(str(k), np.eye(3), uv=uv) for k, uv in enumerate(places)]
    for obj in objects:
        obj.data.uv_layers[0].name = room("addon.writing").UV_MAP
    middles = (np.stack(np.meshgrid(np.arange(width), np.arange(height)), axis=-1) + 0.5) / (width, height)
    inside = np.zeros((height, width), dtype=bool)
    for uv in places:
        sides = [(ahead[0] * away[..., 1] - ahead[1] * away[..., 0]) for ahead, away in
                 ((uv[(k + 1) % 3] - uv[k], middles - uv[k]) for k in range(3))]
        inside |= (np.array(sides) > 0.0).all(axis=0) | (np.array(sides) < 0.0).all(axis=0)
    bands = room("addon.baking.stage.bands")
    told = (bands.samples_in_rows(objects, (width, height), 5) - bands.EMPTY * width) / 5
    assert np.isclose(told.sum(), inside.sum(), rtol=0.03)
    blocks = [values.reshape(3, -1).sum(axis=1) for values in (told, inside.sum(axis=1))]
    assert np.allclose(*blocks, rtol=0.05)


def test_any_seed_will_do(blank, room, monkeypatch):
    """Bands have seeds of their own, and Blender's end at two thousand millions."""
    scene_of(blank)
    parts.generate()
    in_small_bands(monkeypatch, room)
    blank.scene.cycles.seed = 2**31 - 1
    light_between_events(blank, room, 1)
    assert "Reflection Light" in bpy.data.images and blank.scene.cycles.seed == 2**31 - 1


@pytest.mark.thorough
def test_what_only_mirrors_see_is_baked_in_bands_too(blank, room, monkeypatch):
    """It is seen by no ray but theirs, and where it is denoised by none at all."""
    scene_of(blank, "UV").reflection_mesh.role = "MIRROR"
    for obj in map(bpy.data.objects.get, ("Box", "Floor")):
        obj.visible_camera = obj.visible_volume_scatter = obj.visible_transmission = False
    reference = picture(room)
    parts.generate()
    in_small_bands(monkeypatch, room)
    light_between_events(blank, room, 32)
    # measured: 43.7 dB
    assert psnr(picture(room), reference) > 41.5
