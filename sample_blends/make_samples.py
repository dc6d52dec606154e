"""Writes the sample scenes: one small .blend per kind of mirror, from Blender's own primitives.

    python sample_blends/make_samples.py [folder] [name ...]

Run it with the oldest supported `bpy` (4.2), so that every supported Blender opens the files. What most mirrors show
is unlit (emission of an image or of a colour attribute with the light painted in), so that a reflection can be judged
by its colours; frames, lids and stands are lit and take no part. Three scenes, of `LIT`, have lamps, and mirrors with
a colour and a Fresnel of their own; the mirrors of four, of `CAUSTIC`, throw the light of a lamp. Mirror and diffuse
objects, and that lamp, are saved selected.
"""
from __future__ import annotations

import os
import shutil
import sys
import tempfile
from pathlib import Path

os.environ["HOME"] = os.sep  # a .blend remembers the home folder of whoever wrote it, in its file browsers
import bpy
from caustic_scenes import dish, pool, ring, sunlight
from lit_scenes import anamorphosis, bathroom, pond, room
from mathutils import Vector
from painted_scenes import bowl, cylinder, flat_mirror, mirrors, sphere, suzanne, water
from sample_parts import LIGHT, RESOLUTION, sky

LIT = (room, bathroom, pond)
CAUSTIC = (ring, pool, sunlight, dish)
SCENES = {scene.__name__: scene for scene in (sphere, flat_mirror, bowl, water, cylinder, suzanne, mirrors,
                                             anamorphosis, *LIT, *CAUSTIC)}


def write(name: str, folder: Path) -> Path:
    """Builds the scene `name` in an empty file and saves it, compressed, into `folder`."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    mirror, bystanders = SCENES[name]()
    scene.world = sky()
    if SCENES[name] not in (room, bathroom, *CAUSTIC):
        sun = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
        sun.rotation_euler = Vector(-LIGHT).to_track_quat("-Z", "Y").to_euler()
        sun.data.energy = 3.0
        scene.collection.objects.link(sun)
    scene.render.engine = "CYCLES"
    scene.render.resolution_x = scene.render.resolution_y = RESOLUTION
    scene.cycles.samples = 64
    scene.view_settings.view_transform = "Standard"
    if SCENES[name] in CAUSTIC:
        scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0.12
        # faces of light lie over each other
        scene.cycles.transparent_max_bounces = 64
    for item in scene.objects:
        thrown = SCENES[name] in CAUSTIC and item.name in {"Sun", "Lamp"}
        item.select_set(thrown or (item.type == "MESH" and item not in bystanders))
    bpy.context.view_layer.objects.active = mirror
    # A .blend remembers where it was saved: a neutral folder first, so that no path of the writer's travels with it.
    with tempfile.TemporaryDirectory(prefix="sample_blends_") as neutral:
        saved = Path(neutral) / f"{name}.blend"
        bpy.ops.wm.save_as_mainfile(filepath=str(saved), compress=True, copy=False)
        return Path(shutil.copy(saved, folder / saved.name))


def main(arguments: list[str]) -> None:
    folder = Path(__file__).parent
    if arguments and arguments[0] not in SCENES:
        folder = Path(arguments.pop(0))
        folder.mkdir(parents=True, exist_ok=True)
    for name in arguments or SCENES:
        written = write(name, folder)
        print(f"{written.name}: {written.stat().st_size / 1024:.0f} KiB")


if __name__ == "__main__":
    main(sys.argv[1:])
