"""Makes the pictures that show what each part of the method adds: connection, clipping, filling, beside Cycles.

    python -m tools.pictures.parts [folder]

Leaves `parts_bowl.jpg`, `parts_water.jpg`, `parts_suzanne.jpg` and, of a sample with hardly any memory,
`parts_filling.jpg` in the folder, docs/pictures/ by default: the whole picture above, parts of it enlarged below.
"""
from __future__ import annotations

import importlib
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from unittest import mock

import numpy as np
from PIL import Image, ImageDraw, ImageFont
from scipy.ndimage import uniform_filter
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from tools import extension_zip

WRITING = "addon.writing.arrays.mesh_arrays"
WHOLE = 1e-6  # by how much the areas of a triangle's faces may miss the triangle's
TILE, GAP, LABEL = 396, 6, 26
CLOSE = 28  # pixels across the place where filling helps most
BOXES = {"bowl": (140, 250, 380, 490), "water": (770, 520, 1010, 760), "suzanne": (430, 650, 670, 890),
         "filling": (470, 420, 710, 660)}
SCARCE = "sphere", 0.012  # the sample for filling, which samples hardly need, and the gigabytes that it is allowed


def main(folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    with extension_zip.installed() as scratch:
        for sheet, box in BOXES.items():
            sample, memory = SCARCE if sheet == "filling" else (sheet, 2.0)
            _save(folder / f"parts_{sheet}.jpg", _pictures(sample, memory, scratch), box)


def _pictures(sample: str, memory: float, scratch: Path) -> list[tuple[str, Image.Image]]:
    """Each part's label and picture."""
    with _nothing_filled():
        obj, mesh = _generated(sample, memory)
    everything, whole = obj.data.copy(), joined_whole(mesh)
    _keep_faces(obj.data, whole)
    connected = _render(obj, scratch)
    obj.data = everything
    clipped = _render(obj, scratch)
    obj, filled = _generated(sample, memory)
    return [(f"connection only: {whole.sum():,} faces", connected),
            (f"+ clipping: {len(whole):,} faces", clipped),
            (f"+ filling: {filled.counts['filled']:,} pieces more", _render(obj, scratch)),
            ("Cycles, tracing the mirror", _render(None, scratch))]


def _generated(sample: str, memory: float) -> tuple:
    """Open the sample and reflect it: the object, and core's mesh as it was written, whose faces it has in the same
    order."""
    import bpy
    bpy.ops.wm.open_mainfile(filepath=str(extension_zip.ROOT / "sample_blends" / f"{sample}.blend"))
    for modifier in (modifier for obj in bpy.context.scene.objects for modifier in obj.modifiers):
        if modifier.type == "SUBSURF":
            # what is reflected is the viewport's mesh: a render shows no finer one
            modifier.render_levels = modifier.levels
    chosen = _room("addon.reading.roles").choose(bpy.context)
    settings = _room("core").Settings(maximum_memory=memory)
    steps, writing = _room("addon.operators.generate").generation(bpy.context, chosen, settings), _room(WRITING)
    written, rounded = [], writing.in_single_precision

    def writes(*given):
        written.append(rounded(*given))
        return written[-1]
    with mock.patch.object(writing, "in_single_precision", writes):
        while True:
            try:
                next(steps)
            except StopIteration as stop:
                bpy.context.view_layer.update()
                obj, mesh = stop.value.results[0]
                return obj, replace(written[-1], counts=mesh.counts)


def _room(name: str):
    """A module of the installed extension."""
    return importlib.import_module(f"{extension_zip.PACKAGE}.{name}")


@contextmanager
def _nothing_filled() -> Iterator[None]:
    """Leave the step `filling` out of the method: what it would fill stays as clipping left it."""
    crowds = _room("core.filling.crowds")
    with mock.patch.object(crowds.Crowds, "filled", lambda _, candidates: crowds.Filled(
            candidates, np.zeros((0, 3), dtype=np.int64), 0, 0, False)):
        yield


def joined_whole(mesh) -> np.ndarray:
    """Faces (m,) of the reflected triangles that no outline cuts: those whose faces of one parity, joined along
    edges, make up the whole diffuse triangle."""
    count = len(mesh.triangles)
    parity = mesh.image_parity[mesh.triangles].astype(np.int64)
    parity = np.sign(parity.sum(axis=1))
    edges = np.sort(np.stack((mesh.triangles, np.roll(mesh.triangles, -1, axis=1)), axis=2), axis=2).reshape(-1, 2)
    face = np.repeat(np.arange(count), 3)
    # an edge of this triangle's image, of this parity
    keys = np.column_stack((mesh.source_face[face], parity[face], edges))
    _, group = np.unique(keys, axis=0, return_inverse=True)
    group = group.ravel()
    order = np.argsort(group, kind="stable")
    same = group[order][1:] == group[order][:-1]
    first, second = face[order][:-1][same], face[order][1:][same]
    graph = coo_matrix((np.ones(len(first), dtype=np.int8), (first, second)), shape=(count, count))
    pieces, piece = connected_components(graph, directed=False)
    area = np.bincount(piece, np.abs(np.linalg.det(mesh.source_weights)), minlength=pieces)
    return (np.abs(area - 1.0) < WHOLE)[piece]


def _keep_faces(mesh, kept: np.ndarray) -> None:
    """Delete the other faces of a Blender mesh."""
    import bmesh
    edit = bmesh.new()
    edit.from_mesh(mesh)
    edit.faces.ensure_lookup_table()
    bmesh.ops.delete(edit, geom=[edit.faces[index] for index in np.flatnonzero(~kept)], context="FACES_ONLY")
    edit.to_mesh(mesh)
    edit.free()


def _render(result, scratch: Path) -> Image.Image:
    """The scene with `result` before a mirror that reflects the sky alone; where None, as Cycles traces it."""
    import bpy
    scene = bpy.context.scene
    for obj in scene.objects:
        if obj.reflection_mesh.role == "REFLECTION":
            obj.hide_render = obj != result
            for source in obj.reflection_mesh.sources:
                source.object.visible_glossy = result is None
    scene.cycles.samples, scene.cycles.use_denoising = 24, False
    scene.render.filepath = str(scratch / "part.png")
    bpy.ops.render.render(write_still=True)
    return Image.open(scratch / "part.png").convert("RGB")


def _save(path: Path, pictures: list[tuple[str, Image.Image]], box: tuple) -> None:
    """A sheet: the pictures side by side under their labels; below, the box (left, top, right, bottom) of each, and the
    place where filling helps most."""
    font = ImageFont.load_default(16)
    rows = [(box, "red"), *((found, "blue") for found in _filled_box(*(picture for _, picture in pictures[1:])))]
    step = TILE + GAP
    sheet = Image.new("RGB", (len(pictures) * step - GAP, LABEL + (1 + len(rows)) * step - GAP), "white")
    draw = ImageDraw.Draw(sheet)
    for column, (label, picture) in enumerate(pictures):
        left, scale = column * step, TILE / picture.width
        draw.text((left + 4, 4), label, fill="black", font=font)
        sheet.paste(picture.resize((TILE, TILE), Image.Resampling.LANCZOS), (left, LABEL))
        for row, (part, colour) in enumerate(rows):
            draw.rectangle([(left + x * scale, LABEL + y * scale) for x, y in (part[:2], part[2:])], outline=colour)
            method = Image.Resampling.LANCZOS if part == box else Image.Resampling.NEAREST
            enlarged = picture.crop(part).resize((TILE, TILE), method)
            top = LABEL + (1 + row) * step
            sheet.paste(enlarged, (left, top))
            draw.rectangle([left, top, left + TILE - 1, top + TILE - 1], outline=colour)
    sheet.save(path, quality=76, optimize=True)


def _filled_box(before: Image.Image, after: Image.Image, truth: Image.Image) -> list[tuple]:
    """The square of `CLOSE` pixels in which `after` is nearer to the truth by most; none where nothing changed."""
    was, now, true = (np.asarray(picture, dtype=np.float64) for picture in (before, after, truth))
    gain = (np.abs(was - true) - np.abs(now - true)).sum(axis=2)
    if not gain.any():
        return []
    row, column = np.unravel_index(np.argmax(uniform_filter(gain, CLOSE)), gain.shape)
    left, top = (int(np.clip(middle - CLOSE // 2, 0, side - CLOSE))
                 for middle, side in zip((column, row), gain.shape[::-1]))
    return [(left, top, left + CLOSE, top + CLOSE)]


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else extension_zip.ROOT / "docs" / "pictures")
