"""Builds a scene from mesh files that are not in the repository, and measures it as `measure.py` does.

    python -m tools.outside scene.blend --mirror bunny.obj --scene duck.obj@Y kettle.stl [--shading flat]

Reads OBJ, PLY and STL, with Z up or the axis named behind an @. The mirrors stand side by side in the middle, brought
to one size; the scene's meshes stand round them, behind the camera too, with a chequered floor and plain columns, so
that every side of a mirror has something to show. Several scenes in one table: build each, then
`python -m tools.measure scene.blend other.blend`.
"""
from __future__ import annotations

import argparse
import subprocess
import sys
from math import cos, pi, radians, sin
from pathlib import Path

from tools import extension_zip

sys.path.insert(0, str(extension_zip.ROOT / "sample_blends"))
import bpy
import numpy as np
import sample_parts as samples
from mathutils import Vector

SHADINGS = ("smooth", "flat", "sharp", "mixed", "own")
SHARP = radians(30.0)
RING = 3.4  # distance of the scene's meshes from the middle
COLOURS = (samples.RED, samples.TEAL, samples.YELLOW, samples.VIOLET, samples.GREEN, samples.ORANGE, samples.BLUE,
           samples.WHITE)


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("blend", type=Path, help="the scene to write")
    parser.add_argument("--mirror", nargs="+", required=True, metavar="FILE")
    parser.add_argument("--scene", nargs="*", default=[], metavar="FILE")
    parser.add_argument("--shading", choices=SHADINGS, default="smooth",
                        help="of the mirrors: smooth, flat, sharp (edges over 30 degrees), mixed (flat below "
                             "the middle), own (the file's normals)")
    parser.add_argument("--turn", type=float, default=0.0, metavar="DEGREES", help="of the mirrors about the vertical")
    parser.add_argument("--height", type=float, default=2.2, metavar="M", help="of the camera above the floor")
    parser.add_argument("--measure", action="store_true", help="measure the scene once it is written")
    options = parser.parse_args(arguments)
    write(options)
    if not options.measure:
        return 0
    # a process of its own: the extension must choose its preferences before bpy is imported
    return subprocess.run([sys.executable, "-m", "tools.measure", str(options.blend.resolve()), "--runs", "1"],
                          cwd=extension_zip.ROOT, check=False).returncode


def write(options: argparse.Namespace) -> None:
    """Build the scene and save it."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    silver = samples.mirror_material("Mirror")
    count = len(options.mirror)
    mirrors = [stand(load(path), 2.2 / count ** 0.5, ((k - 0.5 * (count - 1)) * 1.5, 0.0),
                     radians(options.turn)) for k, path in enumerate(options.mirror)]
    for mirror in mirrors:
        shade(mirror, options.shading)
        mirror.data.materials.clear()
        mirror.data.materials.append(silver)
    # the first stands behind the camera, the others to its sides and beyond the mirror
    for k, path in enumerate(options.scene):
        angle = -0.5 * pi + 0.9 * (-1) ** k * ((k + 1) // 2)
        reach = RING if k else 2.2 * RING
        placed = stand(load(path), 1.7 if k else 4.0, (reach * cos(angle), reach * sin(angle)), angle)
        paint(placed, COLOURS[k % len(COLOURS)])
    samples.add("grid", "Floor", (0, 0, -0.02), samples.picture("Floor", samples.checks(
        512, 14, (0.22, 0.16, 0.14), (0.93, 0.88, 0.78), [(0, 0, 1.2)], 9.0)), size=18, x_subdivisions=18,
        y_subdivisions=18)
    for k, (x, y) in enumerate(((-4.4, -4.2), (4.4, -4.2), (-4.6, 2.6), (4.6, 2.6))):
        samples.add("cylinder", f"Column {k}", (x, y, 1.5), COLOURS[5 - k], radius=0.5, depth=3.0, vertices=24)
    look_at(mirrors, (0.6, -5.4, options.height))
    scene = bpy.context.scene
    scene.world = samples.sky()
    scene.render.engine = "CYCLES"
    scene.render.resolution_x = scene.render.resolution_y = samples.RESOLUTION
    scene.view_settings.view_transform = "Standard"
    for item in scene.objects:
        item.select_set(item.type == "MESH")
    bpy.context.view_layer.objects.active = mirrors[0]
    options.blend.resolve().parent.mkdir(parents=True, exist_ok=True)
    bpy.ops.wm.save_as_mainfile(filepath=str(options.blend.resolve()), compress=True)


def look_at(mirrors: list, place: tuple) -> None:
    """The camera, with the lens that lets the mirrors fill four fifths of the picture."""
    corners = np.array([mirror.matrix_world @ Vector(corner) for mirror in mirrors for corner in mirror.bound_box])
    middle = 0.5 * (corners.min(axis=0) + corners.max(axis=0))
    samples.eye(place, tuple(middle))
    camera = bpy.context.scene.camera
    bpy.context.view_layer.update()
    seen = np.array([camera.matrix_world.inverted() @ Vector(corner) for corner in corners])
    camera.data.lens = 0.4 * camera.data.sensor_width / np.abs(seen[:, :2] / seen[:, 2:]).max()


def load(name: str) -> bpy.types.Object:
    """The meshes of a file, named `file` or `file@axis`, as one object that stands upright."""
    path, _, up = name.partition("@")
    up = up or "Z"
    reader = {".obj": bpy.ops.wm.obj_import, ".ply": bpy.ops.wm.ply_import, ".stl": bpy.ops.wm.stl_import}.get(
        Path(path).suffix.lower())
    if reader is None:
        raise SystemExit(f"{path} is no OBJ, PLY or STL file.")
    bpy.ops.object.select_all(action="DESELECT")
    reader(filepath=path, up_axis=up, forward_axis="NEGATIVE_Z" if up.endswith("Y") else "Y")
    parts = [item for item in bpy.context.selected_objects if item.type == "MESH"]
    if not parts:
        raise SystemExit(f"{path} holds no mesh.")
    bpy.context.view_layer.objects.active = parts[0]
    if len(parts) > 1:
        bpy.ops.object.join()
    made = bpy.context.object
    bpy.ops.object.transform_apply()
    made.name = made.data.name = Path(path).stem
    made.data.validate(clean_customdata=False)
    return made


def stand(target: bpy.types.Object, size: float, spot: tuple, turn: float) -> bpy.types.Object:
    """Scale to `size` across, turn about the vertical and set on the floor at `spot`."""
    mesh = target.data
    points = np.empty(len(mesh.vertices) * 3, dtype=np.float64)
    mesh.vertices.foreach_get("co", points)
    points = points.reshape(-1, 3)
    low, high = points.min(axis=0), points.max(axis=0)
    middle = np.append(0.5 * (low + high)[:2], low[2])
    points = (points - middle) * (size / (high - low).max())
    # rounded once: the file holds float32, and no transform is left on the object
    mesh.vertices.foreach_set("co", points.ravel())
    mesh.update()
    target.location, target.rotation_euler = (*spot, 0.0), (0.0, 0.0, turn)
    bpy.context.view_layer.update()
    return target


def shade(target: bpy.types.Object, shading: str) -> None:
    """Give a mirror its normals."""
    mesh = target.data
    if shading == "own":
        return
    if mesh.has_custom_normals:
        bpy.context.view_layer.objects.active = target
        bpy.ops.mesh.customdata_custom_splitnormals_clear()
    mesh.shade_flat() if shading == "flat" else mesh.shade_smooth()
    if shading == "sharp":
        mesh.set_sharp_from_angle(angle=SHARP)
    elif shading == "mixed":
        height = np.array([polygon.center.z for polygon in mesh.polygons])
        mesh.polygons.foreach_set("use_smooth", height > 0.5 * (height.min() + height.max()))
    mesh.update()


def paint(target: bpy.types.Object, colour: tuple) -> None:
    """Colour times light on the faces, as the samples have it, so that what is reflected needs no lamp."""
    mesh = target.data
    mesh.materials.clear()
    mesh.materials.append(samples.painted(target, colour))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
