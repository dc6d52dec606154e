"""Makes the manual's pictures of settings from the software's own output.

    python -m tools.pictures.manual [folder] [picture ...]

Leaves `tolerance.jpg` (0.5, 4 and 16 pixels, with the edges of the mesh), `placement.jpg` (layered, on the surface and
virtual, from beside the camera), `made_of.jpg` (faces, and points with discs, of a coarse and a dense mesh),
`light_samples.jpg` (1, 8
and 64), `memory.jpg` (little and enough) and `hidden_faces.jpg` (objects taken away, without hidden
faces and with them) in the folder, docs/pictures/ by default; or those of them that are named.
"""
from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from tools import extension_zip
from tools.pictures.samples import SAMPLES, draw_edges, save

BALL = (212, 183, 772, 743)
LIT_BALL = (131, 130, 381, 380)  # of the room at 50 %
CLOSE = (520, 510, 660, 650)  # round the ring in the ball
BEFORE_THE_BALL = (330, 330, 710, 710)
NEAR = ("Violet Gem", "Teal Ring")


def main(folder: Path, asked: list[str]) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    with extension_zip.installed() as scratch:
        for name, (make, crop) in PICTURES.items():
            if not asked or name in asked:
                made = make(scratch)
                save(folder / f"{name}.jpg", made, columns=len(made), crop=crop)


def tolerance(scratch: Path) -> list[Path]:
    return [_tile(scratch / f"tolerance{value}.png", edges=True, tolerance=value) for value in (0.5, 4.0, 16.0)]


def placement(scratch: Path) -> list[Path]:
    # from beside, what the camera does not see is missed
    return [_tile(scratch / f"{name}.png", beside=True, placement=name, hidden_faces=True)
            for name in ("LAYERED", "SURFACE", "VIRTUAL")]


def made_of(scratch: Path) -> list[Path]:
    return [_tile(scratch / "faces.png"), _tile(scratch / "points.png", method="POINTS"),
            _tile(scratch / "dense.png", dense=True, method="POINTS")]


def light_samples(scratch: Path) -> list[Path]:
    made = []
    for samples in (1, 8, 64):
        _lit_room(light_samples=samples)
        made.append(_rendered(scratch / f"samples{samples}.png", 64))
    return made


def memory(scratch: Path) -> list[Path]:
    made = []
    for gigabytes in (0.1, 2.0):
        scene = _opened("sphere", memory=gigabytes)
        sources = _subdivided(scene)
        _generate()
        _leave_sky(sources)
        _look_closely(scene.render)
        made.append(_rendered(scratch / f"memory{gigabytes}.png"))
    return made


def hidden_faces(scratch: Path) -> list[Path]:
    made = []
    for hidden in (False, True):
        scene = _opened("sphere", hidden_faces=hidden)
        sources = _subdivided(scene)
        result = _generate()
        _leave_sky(sources)
        if not hidden:
            made.append(_rendered(scratch / "hidden.png"))
        _take_away(result, NEAR)
        made.append(_rendered(scratch / f"hidden {hidden}.png"))
    return made


PICTURES = {"tolerance": (tolerance, BALL), "placement": (placement, (256, 256, 768, 768)), "made_of": (made_of, BALL),
            "light_samples": (light_samples, LIT_BALL),
            "memory": (memory, None), "hidden_faces": (hidden_faces, BEFORE_THE_BALL)}


def _tile(path: Path, edges: bool = False, beside: bool = False, dense: bool = False, **settings) -> Path:
    """A render of the ball with its reflection by these settings of the scene.

    Parameters
    ----------
    edges : bool
        With the mesh's edges.
    beside : bool
        Not from where the reflection is right.
    dense : bool
        Of objects whose triangles are smaller than a pixel.
    """
    scene = _opened("sphere", **settings)
    if dense:
        _subdivide([obj for obj in scene.objects if obj.type == "MESH" and obj.name not in {"Mirror Sphere", "Floor"}],
                   5)
    result = _generate()
    if edges:
        _draw_edges(result)
    if beside:
        from mathutils import Vector
        camera = scene.camera
        camera.location = (-5.2, -2.6, 3.0)
        camera.rotation_euler = (Vector((0.0, 0.0, 1.25)) - camera.location).to_track_quat("-Z", "Y").to_euler()
        camera.data.shift_x = camera.data.shift_y = 0.0
    return _rendered(path)


def _opened(name: str, **settings):
    """The scene of a sample, with these settings."""
    import bpy
    bpy.ops.wm.open_mainfile(filepath=str(SAMPLES / f"{name}.blend"))
    for setting, value in settings.items():
        setattr(bpy.context.scene.reflection_mesh, setting, value)
    return bpy.context.scene


def _lit_room(**settings):
    """The scene of the room, its ball lit."""
    import bpy
    scene = _opened("room", **settings)
    scene.render.resolution_percentage = 50
    _generate()
    bpy.ops.reflection_mesh.light()
    return scene


def _generate():
    """The result, as the button makes it."""
    import bpy
    bpy.ops.reflection_mesh.generate(preview=True)
    return bpy.context.view_layer.objects.active


def _subdivide(objects: list, levels: int) -> None:
    for obj in objects:
        modifier = obj.modifiers.new("Dense", "SUBSURF")
        modifier.levels, modifier.subdivision_type = levels, "SIMPLE"


def _subdivided(scene) -> list:
    """What the ball shows, of triangles smaller than pixels."""
    sources = [obj for obj in scene.objects if obj.type == "MESH" and obj.name != "Mirror Sphere"]
    _subdivide(sources, 4)
    return sources


def _leave_sky(sources: list) -> None:
    """The mirror itself shows the sky alone."""
    for obj in sources:
        obj.visible_glossy = False


def _look_closely(render) -> None:
    """Render a part of the picture alone, four times as large."""
    left, top, right, bottom = (value / 1024 for value in CLOSE)
    render.resolution_percentage, render.use_border, render.use_crop_to_border = 400, True, True
    render.border_min_x, render.border_max_x = left, right
    render.border_min_y, render.border_max_y = 1.0 - bottom, 1.0 - top


def _draw_edges(result) -> None:
    for index, material in enumerate(result.data.materials):
        result.data.materials[index] = material.copy()
        draw_edges(result.data.materials[index].node_tree)


def _take_away(result, names: tuple) -> None:
    """Delete the faces of a result that show these objects."""
    import bmesh
    shown = np.array([source.object.name in names for source in result.reflection_mesh.sources])
    source = np.empty(len(result.data.polygons), dtype=np.int32)
    result.data.attributes["source_object"].data.foreach_get("value", source)
    mesh = bmesh.new()
    mesh.from_mesh(result.data)
    mesh.faces.ensure_lookup_table()
    bmesh.ops.delete(mesh, geom=[mesh.faces[index] for index in np.flatnonzero(shown[source])], context="FACES")
    mesh.to_mesh(result.data)
    mesh.free()


def _rendered(path: Path, samples: int = 16) -> Path:
    """A render of the open file."""
    import bpy
    scene = bpy.context.scene
    scene.cycles.samples, scene.cycles.use_denoising = samples, False
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
    return path


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else extension_zip.ROOT / "docs" / "pictures", sys.argv[2:])
