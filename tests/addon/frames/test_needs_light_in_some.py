"""Mirrors of which some frames look right without light, and others do not: each is rendered as Cycles traces it."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from baked_frames import bake
from caustic_scene import add_lamp
from played import played

FRAMES = [1, 2, 3]


def comes(obj: bpy.types.Object) -> None:
    """It is there in frame 2 alone."""
    for frame in FRAMES:
        obj.hide_render = frame != 2
        obj.keyframe_insert("hide_render", frame=frame)


@pytest.fixture
def shining(blank, tmp_path):
    """A wall of two colours that emits light, before a mirror that takes nothing of it: nothing of that needs light."""
    wall = parts.add("grid", "Wall", size=1.6, x_subdivisions=4, y_subdivisions=4, location=(-0.9, -1.0, 1.0),
                     rotation=(np.pi / 2, 0.0, 0.0))
    wall.visible_camera = False
    for name, colour in (("Red", (1.0, 0.0, 0.0, 1.0)), ("Blue", (0.0, 0.1, 1.0, 1.0))):
        wall.data.materials.append(parts.material(name))
        wall.data.materials[-1].node_tree.nodes["Emission"].inputs[0].default_value = colour
    for face in wall.data.polygons:
        face.material_index = face.index % 2
    mirror = parts.add_wall_mirror()
    mirror.data.materials.append(parts.material("Silver", "GLOSSY"))
    mirror.data.materials[0].node_tree.nodes[0].inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    scene = blank.scene
    scene.render.engine, scene.world = "CYCLES", None
    scene.render.resolution_x, scene.render.resolution_y = 96, 72
    scene.frame_start, scene.frame_end = FRAMES[0], FRAMES[-1]
    return tmp_path / "scene.blend"


@pytest.mark.thorough
@pytest.mark.parametrize("guest", ["cube", "lamp"])
def test_what_comes_for_a_while_and_needs_light(shining, room, tmp_path, guest):
    """A grey cube, or a lamp that the mirror shows as a body, for the second frame alone."""
    lamp = add_lamp("Lamp", "POINT", (-0.9, 0.0, 1.0), shadow_soft_size=0.15)
    lamp.data.energy = 10.0
    if guest == "cube":
        lamp.visible_glossy = False
        other = parts.add("cube", "Grey", size=0.8, location=(1.2, -1.2, 0.9))
        other.data.materials.append(parts.material("Paint", "DIFFUSE"))
        comes(other)
    else:
        comes(lamp)
    bpy.context.scene.frame_set(1)
    bpy.ops.wm.save_as_mainfile(filepath=str(shining))
    parts.select()
    assert bake(room, "--output", tmp_path / "out", "--light", "16") == 0
    truth = played(shining, FRAMES, tmp_path / "truth", picture=16)
    seen = played(tmp_path / "out" / "scene reflections.blend", FRAMES, tmp_path / "seen", picture=16)
    for frame in FRAMES:
        one, other = (np.clip(told[f"{frame} picture"], 0.0, 1.0) for told in (truth, seen))
        wrong = np.abs(one - other).max(axis=2) > 0.3
        assert wrong.sum() < 20, frame
