"""Save Sheet to Print: transparency and the picture that is printed."""
from __future__ import annotations

from pathlib import Path

import bpy
import numpy as np
import parts
import pytest
from mirror_maps import corner_places, decoded, seen_of, uv_of, write


@pytest.fixture
def wall(blank) -> bpy.types.Object:
    """A square sheet before a flat wall mirror at y = 1 that sees it whole; both are selected, the mirror is active."""
    sheet = parts.add("plane", "Sheet", size=2.0, location=(0.0, -1.0, 0.3), rotation=(0.9, 0.0, 0.0))
    parts.select(sheet, parts.add_wall_mirror())
    return sheet


def image_of(pixels: np.ndarray, name: str = "Picture", is_float: bool = False) -> bpy.types.Image:
    """An image of this file with straight alpha, from (h, w, 4)."""
    image = bpy.data.images.new(name, pixels.shape[1], pixels.shape[0], alpha=True, float_buffer=is_float)
    image.pixels.foreach_set(pixels.astype(np.float32).ravel())
    return image


def printed(copy: bpy.types.Object, tmp_path: Path) -> np.ndarray:
    """Pixels (h, w, 3) of the print of a copy at 100 pixels a metre."""
    bpy.context.view_layer.objects.active = copy
    path = tmp_path / "sheet.png"
    assert bpy.ops.reflection_mesh.print_sheet(filepath=str(path), dpi=2.54) == {"FINISHED"}
    return decoded(path.read_bytes())[0]


@pytest.mark.thorough
def test_what_is_clear_has_no_colour_that_edges_mix_in(wall, tmp_path):
    """A red disc on clear black is red on white, and nowhere darker."""
    y, x = np.mgrid[:16, :16] - 7.5
    disc = np.zeros((16, 16, 4))
    disc[np.hypot(x, y) < 5.0] = (1.0, 0.0, 0.0, 1.0)
    shown = printed(write(picture=image_of(disc).name, frame="WHOLE"), tmp_path)
    assert (shown[..., 1] < 10).any() and (shown[..., 0] == 255).all() and (shown[..., 1] == shown[..., 2]).all()


def filed(tmp_path: Path, name: str, kind: str, pixels: np.ndarray, is_float: bool) -> bpy.types.Image:
    """An image that was saved to a file and loaded from there."""
    image = image_of(pixels, name, is_float)
    image.filepath_raw, image.file_format = str(tmp_path / name), kind
    image.save()
    bpy.data.images.remove(image)
    return bpy.data.images.load(str(tmp_path / name))


@pytest.mark.parametrize("mode", ["STRAIGHT", "PREMUL", "CHANNEL_PACKED", "NONE"])
@pytest.mark.parametrize("kind", ["PNG", "OPEN_EXR"])
def test_pictures_are_read_times_alpha_whatever_blender_makes_of_their_alpha(blank, room, tmp_path, kind, mode):
    """Against what the file has in it: bytes, or light in single precision."""
    colours, alpha = np.array((0.6, 0.3, 0.1)), 0.4
    image = filed(tmp_path, "picture", kind, np.broadcast_to((*colours, alpha), (4, 4, 4)), kind != "PNG")
    image.colorspace_settings.name = "sRGB" if kind == "PNG" else "Linear Rec.709"
    image.alpha_mode = "CHANNEL_PACKED"
    image.reload()
    image.pixels[0]
    in_file = np.array(image.pixels[:3], dtype=np.float64)
    image.alpha_mode = mode
    image.reload()
    if mode == "NONE":
        alpha = 1.0
    if mode == "PREMUL":
        in_file = in_file / alpha
    if kind == "PNG":
        in_file = np.minimum(in_file, 1.0)
    else:
        in_file = np.clip(in_file, 0.0, 1.0)
        in_file = np.where(in_file <= 0.0031308, 12.92 * in_file, 1.055 * in_file**(1.0 / 2.4) - 0.055)
    found = room("addon.anamorphosis").pixels_of(image)
    assert found.shape == (4, 4, 4)
    assert np.allclose(found, (*(in_file * alpha), alpha), atol=0.005)


@pytest.mark.parametrize("aspect", [(1.0, 1.0), (2.0, 1.0), (1.0, 1.5)])
def test_a_picture_keeps_its_proportions_whatever_the_shape_of_pixels(wall, room, aspect):
    """Against the closed form: a picture twice as wide as high fills a box of that shape of what the eye sees."""
    render = bpy.context.scene.render
    render.pixel_aspect_x, render.pixel_aspect_y = aspect
    copy = write(picture=image_of(np.ones((8, 16, 4))).name, frame="WHOLE", tolerance=0.25)
    seen = np.repeat(seen_of(copy), 3)
    view = room("addon.reading").read_view(bpy.context)
    pixels = view.pixels((corner_places(copy) * (1.0, -1.0, 1.0) + (0.0, 2.0, 0.0))[seen])
    uv = np.column_stack((uv_of(copy)[seen], np.ones(seen.sum())))
    (across, _), (_, up), _ = np.linalg.lstsq(uv, pixels, rcond=None)[0]
    # the box is of whole pixels
    assert across * aspect[0] / (up * aspect[1]) == pytest.approx(2.0, rel=0.03)


def shown_by(material: bpy.types.Material, image: bpy.types.Image, uv_map: str | None) -> None:
    """Let a material emit an image by a UV map: none is that of renders."""
    tree = material.node_tree
    look = tree.nodes.new("ShaderNodeTexImage")
    look.image = image
    if uv_map is not None:
        place = tree.nodes.new("ShaderNodeUVMap")
        place.uv_map = uv_map
        tree.links.new(place.outputs["UV"], look.inputs["Vector"])
    tree.links.new(look.outputs["Color"], tree.nodes["Emission"].inputs["Color"])


@pytest.mark.parametrize("uv_map", ["UVMap", None])
def test_a_picture_that_lies_by_another_map_is_not_printed_by_the_mirrors(wall, tmp_path, uv_map):
    material = parts.material("Wood")
    wall.data.materials.append(material)
    shown_by(material, image_of(np.ones((4, 4, 4)), "Grain"), uv_map)
    parts.select(write())
    assert "no picture by its UV map 'Mirror UV'" in parts.refusal(bpy.ops.reflection_mesh.print_sheet,
                                                                   filepath=str(tmp_path / "sheet.png"))
    assert not list(tmp_path.iterdir())


@pytest.mark.thorough
@pytest.mark.parametrize("how", ["Mirror UV", "rendered", "unused too"])
def test_the_picture_that_is_shown_by_the_mirrors_map_is_printed(wall, tmp_path, how):
    """Green, beside a red one that is shown by the object's own map, or by none at all."""
    red, green = (image_of(np.broadcast_to(colour, (4, 4, 4)), name)
                  for name, colour in (("Red", (1, 0, 0, 1)), ("Green", (0, 1, 0, 1))))
    other, material = parts.material("Other"), parts.material("Painted")
    for entry in (other, material):
        wall.data.materials.append(entry)
    shown_by(other, red, "UVMap")
    if how == "unused too":
        shown_by(material, red, "Mirror UV")    # its place is taken:
    shown_by(material, green, None if how == "rendered" else "Mirror UV")
    wall.data.polygons[0].material_index = 1
    copy = write(frame="WHOLE")
    copy.data.materials.clear()
    for entry in (other, material):
        copy.data.materials.append(entry)
    if how == "rendered":
        copy.data.uv_layers["Mirror UV"].active_render = True
    shown = printed(copy, tmp_path)
    assert (shown[..., 0] < 10).any() and (shown[..., 1] == 255).all()
