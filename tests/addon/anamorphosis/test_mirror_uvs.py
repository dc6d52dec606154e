"""Write Mirror UVs: the map is that of closed form, the copy is the object, the print is the sheet; and nothing else
changes."""
from __future__ import annotations

from pathlib import Path

import bpy
import numpy as np
import parts
import pytest
from mirror_maps import UV_MAP, corner_places, decoded, doubled, seen_of, uv_of, write

# corners of pieces of one triangle, as parts of two of its sides
SLIVERS = np.array((
    ((0.10268045216798782, 0.8973195552825928), (0.44944825768470764, 0.0), (0.10263928771018982, 0.8973607420921326)),
    ((0.10268045216798782, 0.8973195552825928), (0.4494795799255371, 0.0), (0.44944825768470764, 0.0)),
    ((0.10271022468805313, 0.8972897529602051), (0.4494795799255371, 0.0), (0.10268045216798782, 0.8973195552825928)),
    ((0.10271022468805313, 0.8972897529602051), (0.44949668645858765, 0.0), (0.4494795799255371, 0.0)),
    ((0.4494991898536682, 0.0), (0.10273873060941696, 0.8972612619400024), (0.4495130777359009, 0.0)),
    ((0.4494991898536682, 0.0), (0.10271457582712173, 0.8972854018211365), (0.10273873060941696, 0.8972612619400024)),
))


@pytest.fixture
def wall(blank) -> bpy.types.Object:
    """A sheet on the ground before a flat wall mirror at y = 1; both are selected, the mirror is active."""
    sheet = parts.add("grid", "Sheet", x_subdivisions=3, y_subdivisions=2, size=2.0, location=(0.2, -1.0, 0.1),
                      rotation=(0.2, 0.1, 0.3))
    mirror = parts.add_wall_mirror()
    parts.select(sheet, mirror)
    return sheet


def mirrored_uv(room, places: np.ndarray) -> np.ndarray:
    """Where the camera sees points in the wall mirror, as parts of its picture."""
    view = room("addon.reading").read_view(bpy.context)
    return view.pixels(places * (1.0, -1.0, 1.0) + (0.0, 2.0, 0.0)) / view.resolution


def test_a_flat_mirror_gives_every_corner_of_the_copy_its_place_in_closed_form(wall, room):
    copy = write(tolerance=0.25)
    seen = np.repeat(seen_of(copy), 3)
    places = corner_places(copy)
    off = np.linalg.norm((uv_of(copy) - mirrored_uv(room, places))[seen] * (256, 192), axis=1)
    assert seen.sum() > 100 and off.max() < 0.3
    middle = places.reshape(-1, 3, 3).mean(axis=1)
    off = (uv_of(copy).reshape(-1, 3, 2).mean(axis=1) - mirrored_uv(room, middle))[seen_of(copy)] * (256, 192)
    assert np.linalg.norm(off, axis=1).max() < 0.5


@pytest.mark.parametrize("count", [7, 8])
def test_a_map_that_a_copy_has_no_room_for_is_told(wall, capsys, count):
    while len(wall.data.uv_layers) < count:
        wall.data.uv_layers.new(name=f"Map {len(wall.data.uv_layers)}")
    copy = write()
    assert UV_MAP in copy.data.uv_layers and len(copy.data.uv_layers) == 8 and len(wall.data.uv_layers) == count
    missing = [name for name in wall.data.uv_layers.keys() if name not in copy.data.uv_layers]
    told = capsys.readouterr().out
    assert len(missing) == count - 7
    assert ("eight UV maps" in told) == bool(missing) and all(f"'{name}' of 'Sheet'" in told for name in missing)


def test_the_copy_is_the_object_cut(wall):
    material = parts.material("Own")
    wall.data.materials.append(material)
    wall.reflection_mesh.role = "DIFFUSE"
    area = sum(face.area for face in wall.data.polygons)
    copy = write()
    assert sum(face.area for face in copy.data.polygons) == pytest.approx(area, rel=1e-5)
    assert list(copy.data.materials) == [material] and copy.reflection_mesh.role == "DIFFUSE"
    assert np.allclose(np.array(copy.matrix_world), np.array(wall.matrix_world), atol=1e-6)
    # the source's map is linear over the sheet: (x + 1) / 2, (y + 1) / 2 in its own space
    local = np.linalg.inv(np.array(wall.matrix_world))
    own = corner_places(copy) @ local[:3, :3].T + local[:3, 3]
    assert np.allclose(uv_of(copy, "UVMap"), 0.5 * own[:, :2] + 0.5, atol=1e-5)
    assert copy.data.uv_layers.active.name == UV_MAP and copy.data.uv_layers["UVMap"].active_render
    assert not copy.data.validate()
    normals = np.array([corner.vector for corner in copy.data.corner_normals])
    assert np.allclose(normals, (0.0, 0.0, 1.0), atol=1e-3)
    assert wall.hide_render and wall.hide_get()


@pytest.mark.parametrize("scale", [(-1.0, 1.0, 1.0), (1.0, 0.5, -2.0), (-1.0, -1.0, 1.0)])
def test_the_copy_of_what_is_turned_over_by_its_scale_looks_to_the_same_side(wall, scale):
    """Or Cycles shows it black: faces and normals both look up in its own space, as the object's do."""
    wall.scale = scale
    copy = write()
    assert np.allclose([face.normal for face in copy.data.polygons if face.area > 1e-6], (0.0, 0.0, 1.0), atol=1e-2)
    assert np.allclose([corner.vector for corner in copy.data.corner_normals], (0.0, 0.0, 1.0), atol=1e-3)


def test_slivers_are_cut_too(room):
    """Of Suzanne's ear: Blender's triangulation runs through a corner twice where they crowd."""
    weights = np.concatenate((1.0 - SLIVERS.sum(axis=2, keepdims=True), SLIVERS), axis=2)
    face = np.zeros(len(SLIVERS), dtype=np.int64)
    pieces = room("core").PicturePieces(face, weights, 100.0 * SLIVERS, face)
    found = room("addon.faults").finished(room("addon.anamorphosis").cut_triangles(pieces, 1))
    areas = np.linalg.det(found.weights)
    # but for one that Blender turns over
    assert areas.min() > 0.0 and areas.sum() == pytest.approx(1.0, abs=5e-5)
    assert 0 < found.seen.sum() < len(areas)


def test_what_the_mirror_does_not_show_is_marked_and_lies_beside_the_picture(wall):
    bpy.data.objects["Mirror"].scale.x = 0.25
    bpy.context.view_layer.update()
    area = sum(face.area for face in wall.data.polygons)
    copy = write()
    seen = seen_of(copy)
    assert 0 < seen.sum() < len(seen)
    assert sum(face.area for face in copy.data.polygons) == pytest.approx(area, rel=1e-5)
    assert (uv_of(copy).reshape(-1, 3, 2)[~seen] == -1.0).all()
    assert (uv_of(copy).reshape(-1, 3, 2)[seen] > -0.5).all()


def test_of_two_images_the_larger_one_is_taken(wall, room):
    mirror = bpy.data.objects["Mirror"]
    wall.rotation_euler.x = 1.1     # so that the large pane sees it large
    mesh = bpy.data.meshes.new("Two")
    # in the wall's own plane's coordinates a large pane, and a small one beside it that is turned to the sheet
    mesh.from_pydata([(-1.7, -2, 0), (1.7, -2, 0), (1.7, 2, 0), (-1.7, 2, 0), (1.7, -0.4, 0), (2.5, -0.4, 0.37),
                      (2.5, 0.4, 0.52), (1.7, 0.4, 0.15)], [], [(0, 1, 2, 3), (4, 5, 6, 7)])
    mirror.data = mesh
    both = parts.attribute(parts.generate(), "mirror_face")
    assert (both < 2).any() and (both >= 2).any()
    bpy.ops.reflection_mesh.clear()
    parts.select(wall, mirror)
    area = sum(face.area for face in wall.data.polygons)
    copy = write(tolerance=0.25)
    assert sum(face.area for face in copy.data.polygons) == pytest.approx(area, rel=1e-5)
    seen = np.repeat(seen_of(copy), 3)
    off = (uv_of(copy) - mirrored_uv(room, corner_places(copy)))[seen] * (256, 192)
    assert seen.all() and np.linalg.norm(off, axis=1).max() < 0.6


def test_again_updates_the_copy_in_place(wall, room):
    first = write()
    name, before = first.name, uv_of(first)
    bpy.context.scene.camera.location.x += 0.7
    parts.select(first, bpy.data.objects["Mirror"])
    again = write()
    assert again == first and again.name == name and len(bpy.data.objects) == 4
    assert wall.hide_render and wall.hide_get()
    assert len(again.data.polygons) < 2 * len(before)
    seen = np.repeat(seen_of(again), 3)
    off = (uv_of(again) - mirrored_uv(room, corner_places(again)))[seen] * (256, 192)
    assert np.linalg.norm(off, axis=1).max() < 0.6


def test_on_the_object_itself_corners_are_exact_and_no_face_is_cut(wall, room):
    faces, objects = len(wall.data.polygons), len(bpy.data.objects)
    assert write(target="ORIGINAL", tolerance=0.1) == wall
    assert len(wall.data.polygons) == faces and len(bpy.data.objects) == objects and not wall.hide_render
    off = np.linalg.norm((uv_of(wall) - mirrored_uv(room, corner_places(wall))) * (256, 192), axis=1)
    assert seen_of(wall).all() and off.max() < 0.2


@pytest.mark.parametrize(("kind", "low", "high"), [("MIRROR", 0.0, 1.0), ("WHOLE", None, None)])
def test_what_a_picture_fills(wall, kind, low, high):
    wall.rotation_euler.x = 0.9
    copy = write(frame=kind)
    uv = uv_of(copy)[np.repeat(seen_of(copy), 3)]
    if kind == "MIRROR":
        assert uv.min(axis=0) == pytest.approx(low, abs=1e-5) and uv.max(axis=0) == pytest.approx(high, abs=1e-5)
        return
    # the whole unit square is shown, but for a part of a pixel at its rim
    triangles = uv_of(copy).reshape(-1, 3, 2)[seen_of(copy)]
    points = np.random.default_rng(2).uniform(0.03, 0.97, (300, 2))
    u, v, w = (triangles[:, k] - triangles[:, 0] for k in (1, 2, 0))
    to = points[:, None] - triangles[None, :, 0]
    area = doubled(triangles)
    second = (to[..., 0] * v[:, 1] - to[..., 1] * v[:, 0]) / area
    third = (u[:, 0] * to[..., 1] - u[:, 1] * to[..., 0]) / area
    held = ((second >= -1e-6) & (third >= -1e-6) & (second + third <= 1 + 1e-6)).any(axis=1)
    assert held.all(), points[~held]


@pytest.mark.parametrize("proportion", [0.6, 1.0, 2.3])
def test_the_largest_frame_is_found_as_by_trying_all(room, proportion):
    largest = room("addon.anamorphosis.frame")._largest_frame
    y, x = np.mgrid[:34, :41]
    shown = (np.hypot(x - 22, 1.3 * (y - 17)) < 15) & (x + y > 25)
    (column, row), (width, height) = (pair.astype(int) for pair in largest(shown, proportion))
    assert shown[row:row + height, column:column + width].all() and width == round(height * proportion)
    high, across = height + 1, round((height + 1) * proportion)
    assert not any(shown[r:r + high, c:c + across].all() for r in range(34 - high + 1) for c in range(41 - across + 1))


def ramp(tmp_path: Path) -> str:
    """A file with a picture whose red rises to the right and whose green rises upwards."""
    image = bpy.data.images.new("Ramp", 64, 64)
    pixels = np.ones((64, 64, 4), dtype=np.float32)
    pixels[..., 0], pixels[..., 1] = (np.arange(64) + 0.5) / 64, ((np.arange(64) + 0.5) / 64)[:, None]
    image.pixels.foreach_set(pixels.ravel())
    image.filepath_raw, image.file_format = str(tmp_path / "ramp.png"), "PNG"
    image.save()
    bpy.data.images.remove(image)
    return str(tmp_path / "ramp.png")


def test_the_print_is_the_sheet_in_its_size(wall, room, tmp_path):
    copy = write(picture=ramp(tmp_path))
    bpy.context.view_layer.objects.active = copy
    bpy.context.scene.unit_settings.scale_length = 0.1    # 2 units are 20 cm
    path = tmp_path / "sheet.png"
    assert bpy.ops.reflection_mesh.print_sheet(filepath=str(path), dpi=25.4) == {"FINISHED"}
    pixels, dots = decoded(path.read_bytes())
    assert pixels.shape == (200, 200, 3) and dots == (1000, 1000, 1)
    # a pixel lies on the sheet where its place in the file says, and shows what the mirror shows there
    y, x = (np.mgrid[:200, :200][:, ::-1] + 0.5) / 100 - 1.0
    local = np.stack((x, y, 0.0 * x), axis=2).reshape(-1, 3)
    matrix = np.array(copy.matrix_world)
    wanted = mirrored_uv(room, local @ matrix[:3, :3].T + matrix[:3, 3]).reshape(200, 200, 2)
    within = ((wanted > 0.02) & (wanted < 0.98)).all(axis=2)
    assert within.sum() > 10_000
    assert np.abs(pixels[..., :2] / 255.0 - wanted)[within].max() < 0.015
    beside = ((wanted < -0.02) | (wanted > 1.02)).any(axis=2)
    assert (pixels[beside] == 255).all()


@pytest.mark.thorough
def test_an_svg_has_the_sheets_size(wall, tmp_path):
    bpy.context.view_layer.objects.active = write(picture=ramp(tmp_path))
    path = tmp_path / "sheet.svg"
    assert bpy.ops.reflection_mesh.print_sheet(filepath=str(path), dpi=10.0) == {"FINISHED"}
    text = path.read_text()
    assert 'width="2000.000mm" height="2000.000mm"' in text and "data:image/png;base64," in text


def test_esc_leaves_no_trace(wall, room, tmp_path):
    picture, before = ramp(tmp_path), parts.state()
    module, settings = room("addon.operators.mirror_uvs"), room("core").Settings(placement="SURFACE")
    stages = []
    for stop in range(1, 200):
        chosen = room("addon.reading").choose(bpy.context)
        steps = module.mapping(bpy.context, chosen, settings, module.Choices(picture=picture))
        told = []
        # how many steps there are goes by the clock, and after the last one nothing is left to be taken back
        while len(told) < stop and told[-1:] != ["Writing"]:
            told.append(next(steps)[1])
        steps.close()
        assert parts.state() == before
        stages = told
        if told[-1] == "Writing":
            break
    assert stages[-1] == "Writing" and "Cutting faces" in stages


def test_esc_between_two_copies_leaves_no_trace(wall, room):
    other = parts.add("plane", "Other", size=1.0, location=(-1.2, -1.0, 0.6))
    parts.select(wall, other, bpy.data.objects["Mirror"])
    before = parts.state()
    module, settings = room("addon.operators.mirror_uvs"), room("core").Settings(placement="SURFACE")
    steps = module.mapping(bpy.context, room("addon.reading").choose(bpy.context), settings)
    writing = 0
    while writing < 2:
        writing += next(steps)[1] == "Writing"
    assert "Sheet Anamorphosis" in bpy.data.objects or "Other Anamorphosis" in bpy.data.objects
    steps.close()
    assert parts.state() == before


def test_an_error_while_writing_leaves_no_trace(wall, room, tmp_path, monkeypatch):
    picture, before = ramp(tmp_path), parts.state()

    def fails(*_):
        raise ValueError("no")
    monkeypatch.setattr(room("addon.anamorphosis.copies"), "_hide", fails)
    with pytest.raises(RuntimeError, match="not foreseen"):
        bpy.ops.reflection_mesh.mirror_uvs(picture=picture)
    assert parts.state() == before


def test_refusals(wall, tmp_path):
    refused = bpy.ops.reflection_mesh.mirror_uvs
    assert "no picture 'nothing.png'" in parts.refusal(refused, picture="nothing.png")
    assert "copies alone" in parts.refusal(refused, picture="x", target="ORIGINAL")
    (tmp_path / "text.png").write_text("no picture")
    assert "no picture that Blender can read" in parts.refusal(refused, picture=str(tmp_path / "text.png"))
    bend = wall.modifiers.new("Bend", "SUBSURF")
    # by the name that the choice has in the panel
    label = refused.get_rna_type().properties["target"].enum_items["COPY"].name
    assert f"modifiers: apply them, or choose {label}." in parts.refusal(refused, target="ORIGINAL")
    wall.modifiers.remove(bend)
    printing = bpy.ops.reflection_mesh.print_sheet
    bpy.context.view_layer.objects.active = wall
    assert "press Write Mirror UVs" in parts.refusal(printing, filepath=str(tmp_path / "sheet.png"))
    other = parts.add_wall_mirror("Other")
    wall.reflection_mesh.role = "DIFFUSE"
    for obj in (other, bpy.data.objects["Mirror"]):
        obj.reflection_mesh.role = "MIRROR"
    parts.select(wall, other, bpy.data.objects["Mirror"])
    assert "those of one mirror" in parts.refusal(refused)


def test_a_bent_sheet_is_not_printed(wall, tmp_path):
    ball = parts.add("uv_sphere", "Ball", radius=0.5, location=(0.0, -1.0, 1.0))
    parts.select(ball, bpy.data.objects["Mirror"])
    bpy.context.view_layer.objects.active = write(picture=ramp(tmp_path))
    for path in ("", f"{tmp_path}/"):
        assert "No file is named" in parts.refusal(bpy.ops.reflection_mesh.print_sheet, filepath=path)
    assert "neither a .png nor a .svg" in parts.refusal(bpy.ops.reflection_mesh.print_sheet,
                                                        filepath=str(tmp_path / "ball.jpg"))
    assert "not flat" in parts.refusal(bpy.ops.reflection_mesh.print_sheet, filepath=str(tmp_path / "ball.png"))


def test_an_object_that_is_not_shown_is_left_out(wall):
    behind = parts.add("cube", "Behind", location=(0.0, 6.0, 0.0))
    parts.select(wall, behind, bpy.data.objects["Mirror"])
    write()
    assert bpy.data.objects.get("Behind Anamorphosis") is None and not behind.hide_render


def test_the_verb_writes_maps_and_prints(wall, room, tmp_path, capsys):
    picture, path = ramp(tmp_path), tmp_path / "scene.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    output, sheet = tmp_path / "mapped.blend", tmp_path / "sheet.svg"
    assert room("addon.command_line").run(
        ["mirror-uvs", "--mirror", "Mirror", "--diffuse", "Sheet", "--picture", picture, "--fills", "WHOLE", "--print",
         str(sheet), "--dpi", "10", "--output", str(output)]) == 0
    assert "'Sheet Anamorphosis'" in capsys.readouterr().out and sheet.stat().st_size > 1000
    bpy.ops.wm.open_mainfile(filepath=str(output))
    assert UV_MAP in bpy.data.objects["Sheet Anamorphosis"].data.uv_layers
    assert room("addon.command_line").run(["mirror-uvs", "--print", "sheet.jpg", "--output", str(output)]) == 1
    capsys.readouterr()
    assert room("addon.command_line").run(["mirror-uvs", "--tolerance", "-1", "--output", str(output)]) == 1
    assert "not foreseen" not in capsys.readouterr().err


@pytest.mark.parametrize(("scale", "told"), [(float("nan"), "not a finite number"), (0.0, "no area to print")])
def test_a_sheet_that_has_no_size_is_not_printed(wall, tmp_path, scale, told):
    """The first failed for a reason that was not foreseen."""
    copy = write()
    copy.scale.x = scale
    bpy.context.view_layer.update()
    parts.select(copy)
    assert told in parts.refusal(bpy.ops.reflection_mesh.print_sheet, filepath=str(tmp_path / "sheet.png"))
    assert not list(tmp_path.iterdir())
