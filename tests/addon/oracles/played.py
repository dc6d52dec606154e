"""What a file shows at some frames in a fresh Blender without the extension, and pictures that Cycles makes of it."""
from __future__ import annotations

import inspect
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np


def attributes_of(mesh) -> dict:
    """The values of a mesh's attributes by "DOMAIN TYPE NAME"."""
    found = {}
    for entry in mesh.attributes:
        width, field = {"FLOAT2": (2, "vector"), "FLOAT_VECTOR": (3, "vector"), "FLOAT_COLOR": (4, "color"),
                        "BYTE_COLOR": (4, "color"), "FLOAT": (1, "value"), "INT": (1, "value"),
                        "BOOLEAN": (1, "value")}.get(entry.data_type, (0, ""))
        if not width or entry.name.startswith("."):
            continue
        values = np.empty(width * len(entry.data), dtype={"INT": np.int32, "BOOLEAN": bool}.get(
            entry.data_type, np.float32))
        entry.data.foreach_get(field, values)
        if entry.domain == "EDGE":
            # edges are numbered otherwise in files
            ends = np.empty(2 * len(mesh.edges), dtype=np.int32)
            mesh.edges.foreach_get("vertices", ends)
            values = values.reshape(-1, width)[np.lexsort(np.sort(ends.reshape(-1, 2), axis=1).T)].ravel()
        found[f"{entry.domain} {entry.data_type} {entry.name}"] = values
    return found


SCRIPT = "import json, os, sys\nimport bpy\nimport numpy as np\n\n" + inspect.getsource(attributes_of) + r"""

asked = json.loads(sys.argv[-1])
bpy.ops.wm.open_mainfile(filepath=asked["file"])
assert not hasattr(bpy.types.Object, "reflection_mesh")
scene = bpy.context.scene
told = {}
for name in asked["names"] if asked["every"] else ():
    scene.objects[name].animation_data_clear()
    scene.objects[name].hide_viewport = False
for frame in asked["frames"]:
    scene.frame_set(frame)
    if asked["picture"]:
        scene.render.engine = "CYCLES"
        scene.cycles.samples, scene.cycles.use_denoising = asked["picture"], False
        settings = scene.render.image_settings
        if hasattr(settings, "media_type"):
            settings.media_type = "IMAGE"
        settings.file_format, settings.color_depth = "OPEN_EXR", "32"
        scene.render.filepath = os.path.join(asked["folder"], f"{frame}.exr")
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(scene.render.filepath)
        pixels = np.empty(len(image.pixels), dtype=np.float32)
        image.pixels.foreach_get(pixels)
        told[f"{frame} picture"] = pixels.reshape(*tuple(image.size)[::-1], -1)[..., :3]
        bpy.data.images.remove(image)
        continue
    depsgraph = bpy.context.evaluated_depsgraph_get()
    for name in asked["names"]:
        shown = scene.objects[name].evaluated_get(depsgraph)
        mesh = shown.data
        told[f"{frame} {name} hidden"] = shown.hide_render
        places = np.empty(3 * len(mesh.vertices), dtype=np.float32)
        mesh.vertices.foreach_get("co", places)
        told[f"{frame} {name} places"] = places.reshape(-1, 3)
        told[f"{frame} {name} origin"] = np.array(shown.matrix_world.translation)
        corners = np.empty(len(mesh.loops), dtype=np.int32)
        mesh.loops.foreach_get("vertex_index", corners)
        told[f"{frame} {name} corners"] = corners
        told[f"{frame} {name} materials"] = np.array(
            [shown.material_slots[face.material_index].material.name for face in mesh.polygons], dtype=str)
        for what, values in attributes_of(mesh).items():
            told[f"{frame} {name} : {what}"] = values
np.savez(os.path.join(asked["folder"], "told.npz"), **told)
"""


def played(file: Path, frames: list, folder: Path, names=(), picture: int = 0,
           every: bool = False) -> dict:
    """Arrays by "FRAME NAME WHAT" of objects, or by "FRAME picture", with `picture` samples per pixel; of every
    object that is named, hidden ones too."""
    folder.mkdir(exist_ok=True)
    asked = {"file": str(file), "frames": list(frames), "names": list(names), "folder": str(folder),
             "picture": picture, "every": every}
    done = subprocess.run([sys.executable, "-c", SCRIPT, json.dumps(asked)], capture_output=True, text=True,
                          check=False, env={**os.environ, "BLENDER_USER_RESOURCES": str(folder)})
    assert (folder / "told.npz").exists(), done.stdout[-2000:] + done.stderr[-2000:]
    with np.load(folder / "told.npz") as told:
        return dict(told)


def generated(obj) -> dict:
    """The same of a result of the open file."""
    mesh = obj.data
    places = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.vertices.foreach_get("co", places)
    corners = np.empty(len(mesh.loops), dtype=np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    told = {"places": places.reshape(-1, 3), "origin": np.array(obj.matrix_world.translation), "corners": corners,
            "materials": np.array([mesh.materials[face.material_index].name for face in mesh.polygons], dtype=str)}
    own = ("position", "material_index")
    return told | {f": {what}": values for what, values in attributes_of(mesh).items()
                   if what.split(" ", 2)[2] not in own}
