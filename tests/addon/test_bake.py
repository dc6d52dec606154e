"""Frames that play without the extension show what `generate` and `light` make of them; whatever ends a bake, what is
done stays and the rest follows."""
from __future__ import annotations

import json
import signal
from pathlib import Path

import bpy
import faults
import numpy as np
import parts
import pytest
from played import generated, played

FRAMES = [1, 2, 3, 4]


@pytest.fixture
def moving(blank, tmp_path) -> Path:
    """A cube of two colours that moves before a wall mirror, with a UV map, colours and an attribute, 96 x 72 pixels,
    saved; the mirror moves too."""
    cube = parts.add("cube", "Box", size=1.0, location=(0.0, -1.5, 1.0))
    for name, colour in (("Plain", (0.8, 0.8, 0.8, 1.0)), ("Red one", (1.0, 0.0, 0.0, 1.0))):
        cube.data.materials.append(parts.material(name))
        cube.data.materials[-1].node_tree.nodes["Emission"].inputs[0].default_value = colour
    rng = np.random.default_rng(5)
    for face in cube.data.polygons:
        face.material_index = face.index % 2
    for name, kind, domain, width in (("My Colour", "FLOAT_COLOR", "POINT", 4), ("wet spots", "FLOAT", "FACE", 1),
                                      ("Zähler", "INT", "FACE", 1)):
        entry = cube.data.attributes.new(name, kind, domain)
        values = rng.uniform(-3.0, 1e6, width * len(entry.data))
        entry.data.foreach_set("color" if width == 4 else "value",
                               values.astype(np.int32 if kind == "INT" else np.float32))
    mirror = parts.add_wall_mirror()
    mirror.data.materials.append(parts.material("Glass", "GLOSSY"))
    cube.reflection_mesh.role, mirror.reflection_mesh.role = "DIFFUSE", "MIRROR"
    for obj, frame, place in ((cube, 1, (0.0, -1.5, 1.0)), (cube, 5, (1.2, -1.0, 1.3)),
                              (mirror, 1, (0.0, 1.0, 1.0)), (mirror, 5, (0.0, 1.5, 1.0))):
        obj.location = place
        obj.keyframe_insert("location", frame=frame)
    scene = blank.scene
    scene.render.resolution_x, scene.render.resolution_y = 96, 72
    scene.frame_start, scene.frame_end = FRAMES[0], FRAMES[-1]
    blank.preferences.filepaths.save_version = 0
    path = tmp_path / "work" / "scene.blend"
    path.parent.mkdir()
    bpy.ops.wm.save_as_mainfile(filepath=str(path), compress=False)
    return path


def bake(room, *arguments) -> int:
    return room("addon.command_line").run(["bake", *map(str, arguments)])


def names(folder: Path) -> set[str]:
    return {path.name for path in folder.iterdir()}


def expected(frame: int, light: bool = False, **options) -> dict:
    """What `generate` makes of a frame of the open file."""
    bpy.context.scene.frame_set(frame)
    parts.select()
    result = parts.generate(**options)
    if light:
        bpy.ops.reflection_mesh.light(samples=4, every=True)
    return generated(result)


def assert_same(told: dict, frame: int, name: str, wanted: dict) -> None:
    for what, values in wanted.items():
        found = told[f"{frame} {name} {what}"]
        assert found.dtype == values.dtype or what == "materials", what
        if ": FACE FLOAT " in what:
            # the mean of three equal numbers
            assert np.allclose(found, values, rtol=2e-7, atol=0.0), what
        elif what == "origin":
            assert np.allclose(found, values, atol=1e-6)
        else:
            assert np.array_equal(found, values), what


def test_frames_play_without_the_extension(moving, room, tmp_path):
    """Bit for bit: places, faces, materials and whatever else the result knows."""
    out = tmp_path / "out"
    before = moving.read_bytes()
    assert bake(room, "--output", out, "--light", "0") == 0
    assert moving.read_bytes() == before
    assert names(out) == {"scene reflections.blend", *(f"Frame.{frame:04d}.json" for frame in FRAMES),
                          *(f"Mirror_Reflection.{frame:04d}.usdc" for frame in FRAMES)}
    told = played(out / "scene reflections.blend", [*FRAMES[::-1], 2], tmp_path / "played", ["Mirror Reflection"])
    bpy.ops.wm.open_mainfile(filepath=str(moving))
    counts = set()
    for frame in FRAMES:
        wanted = expected(frame)
        assert {": POINT FLOAT_VECTOR reflected_position", ": CORNER FLOAT_COLOR My Colour", ": CORNER FLOAT2 UVMap",
                ": FACE INT source_face"} <= set(wanted)
        assert set(wanted["materials"]) == {"Plain", "Red one"}
        counts.add(wanted["places"].tobytes())
        assert_same(told, frame, "Mirror Reflection", wanted)
    assert len(counts) == len(FRAMES)
