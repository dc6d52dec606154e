"""Files for other programs: a lit reflection goes out by glTF or USD, comes back, and has the colours that it had."""
from __future__ import annotations

import json
import struct

import bpy
import bmesh
import numpy as np
import parts
import pytest
import three_js

SIZE = 128
WHITE = (1.0, 1.0, 1.0, 1.0)


def floor_mirror(context: bpy.types.Context, source: bpy.types.Material, lamp: bool) -> bpy.types.Object:
    """A board behind a floor mirror that runs away from the camera, where places in the picture are far from linear on
    large faces; returns the result."""
    scene = context.scene
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    scene.render.engine = "CYCLES"
    scene.view_settings.view_transform = "Standard"
    board = parts.add("plane", "Board", size=4.0, location=(0.0, 4.0, 1.4), rotation=(np.pi / 2, 0.0, 0.4))
    board.data.materials.append(source)
    mirror = parts.add("plane", "Floor", size=7.0, location=(0.0, 0.0, -1.0))
    mirror.data.materials.append(parts.material("Chrome", "GLOSSY"))
    mirror.data.materials[0].node_tree.nodes[0].inputs["Color"].default_value = WHITE
    if lamp:
        bpy.ops.object.light_add(type="AREA", location=(-1.0, -2.0, 3.5), rotation=(0.8, 0.0, 0.0))
        context.object.data.energy, context.object.data.size = 100.0, 2.0
    parts.select(board, mirror)
    return parts.generate()


def checks() -> bpy.types.Material:
    """A diffuse board of checks by UV, which tell a wrong place."""
    made = parts.material("Checks", "DIFFUSE")
    tree = made.node_tree
    pattern = tree.nodes.new("ShaderNodeTexChecker")
    pattern.inputs["Scale"].default_value = 5.0
    pattern.inputs["Color1"].default_value, pattern.inputs["Color2"].default_value = (.9, .3, .1, 1), (.1, .2, .5, 1)
    tree.links.new(tree.nodes.new("ShaderNodeTexCoord").outputs["UV"], pattern.inputs["Vector"])
    tree.links.new(pattern.outputs["Color"], tree.nodes["Diffuse BSDF"].inputs["Color"])
    return made


def painted() -> bpy.types.Material:
    """Emission by vertex colours, which glTF cannot say."""
    made = parts.material("Painted")
    tree = made.node_tree
    colour = tree.nodes.new("ShaderNodeVertexColor")
    tree.links.new(colour.outputs["Color"], tree.nodes["Emission"].inputs["Color"])
    return made


def picture_of(room, objects: list) -> np.ndarray:
    """What Cycles shows of some objects alone, (height, width, 4), in linear light."""
    rendering, here = room("addon.rendering"), bpy.context.scene
    scene = bpy.data.scenes.new("Alone")
    try:
        for obj in (*objects, here.camera):
            scene.collection.objects.link(obj)
        scene.camera = here.camera
        scene.render.resolution_x, scene.render.resolution_y = here.render.resolution_x, here.render.resolution_y
        rendering.with_cycles(scene)
        scene.cycles.samples, scene.cycles.use_denoising, scene.render.film_transparent = 16, False, True
        return rendering.rendered(scene)
    finally:
        bpy.data.scenes.remove(scene)


def written(result: bpy.types.Object, kind: str, folder, **options) -> str:
    """The path of a file of one kind into which the result alone has gone."""
    parts.select(result)
    path = str(folder / f"result.{kind}")
    if kind == "glb":
        bpy.ops.export_scene.gltf(filepath=path, use_selection=True, **options)
    else:
        bpy.ops.wm.usd_export(filepath=path, selected_objects_only=True, **options)
    return path


def picture_brought_back(room, result: bpy.types.Object, kind: str, folder) -> np.ndarray:
    """What Cycles shows of the objects that a file of one kind brings back; they are gone afterwards."""
    path, before = written(result, kind, folder), set(bpy.data.objects)
    (bpy.ops.import_scene.gltf if kind == "glb" else bpy.ops.wm.usd_import)(filepath=path)
    new = [obj for obj in bpy.data.objects if obj not in before]
    shown = picture_of(room, [obj for obj in new if obj.type == "MESH"])
    bpy.data.batch_remove(new)
    return shown


def values_in_glb(path: str) -> dict:
    """The values of each attribute in the one primitive of a binary glTF file (Khronos glTF 2.0, 3.6.2 and 4.4), all
    of them of single precision."""
    with open(path, "rb") as file:
        whole = file.read()
    length, = struct.unpack_from("<I", whole, 12)
    told, start = json.loads(whole[20:20 + length]), 28 + length
    (primitive,), values = told["meshes"][0]["primitives"], {}
    for name, number in primitive["attributes"].items():
        accessor = told["accessors"][number]
        assert accessor["componentType"] == 5126
        width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}[accessor["type"]]
        view = told["bufferViews"][accessor["bufferView"]]
        offset = start + view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        values[name] = np.frombuffer(whole, "<f4", accessor["count"] * width, offset).reshape(-1, width)
    return values


def differs_by(one: np.ndarray, other: np.ndarray) -> float:
    """Root of the mean square of the difference, as the eye sees it, where both show the result whole."""
    shown = (one[..., 3] > 0.99) & (other[..., 3] > 0.99)
    assert shown.sum() > 0.95 * (one[..., 3] > 0.99).sum() > 500
    seen = [np.clip(picture[..., :3], 0.0, 1.0)[shown]**(1.0 / 2.2) for picture in (one, other)]
    return float(np.sqrt(np.square(seen[0] - seen[1]).mean()))


@pytest.mark.thorough
@pytest.mark.parametrize("kind", ["glb", "usdc"])
def test_what_is_lit_arrives_as_it_is_seen(blank, room, tmp_path, kind):
    result = floor_mirror(blank, checks(), lamp=True)
    bpy.ops.reflection_mesh.light(samples=16)
    seen = picture_of(room, [result])
    assert np.ptp(seen[..., 0][seen[..., 3] > 0.99]) > 0.2
    # measured: 0.0108: a pixel has 256 steps and the picture hundreds of borders, which a filter softens
    assert differs_by(seen, picture_brought_back(room, result, kind, tmp_path)) < 0.014


@pytest.mark.parametrize("kind", ["glb", "usdc"])
def test_what_is_cut_out_of_a_mirror_is_clear(blank, room, tmp_path, kind):
    """Against the mirror alone, as Cycles shows it."""
    floor_mirror(blank, checks(), lamp=False)
    floor = bpy.data.objects["Floor"]
    holed = parts.material("Holed", "PRINCIPLED", 0.0, 1.0)
    checker = holed.node_tree.nodes.new("ShaderNodeTexChecker")
    checker.inputs["Scale"].default_value = 4.0
    holed.node_tree.links.new(holed.node_tree.nodes.new("ShaderNodeTexCoord").outputs["UV"], checker.inputs["Vector"])
    holed.node_tree.links.new(checker.outputs["Fac"], holed.node_tree.nodes["Principled BSDF"].inputs["Alpha"])
    floor.data.materials[0] = holed
    result = floor_again()
    bpy.ops.reflection_mesh.light(samples=4)
    shown = picture_brought_back(room, result, kind, tmp_path)[..., 3]
    wanted = picture_of(room, [floor])[..., 3]
    assert (wanted > 0.99).sum() > 1000 and (wanted < 0.01).sum() > 1000
    # measured: 0.0075 and 0.0088
    assert np.abs(shown - wanted).mean() < 0.012


@pytest.mark.parametrize("preview", [False, True])
def test_what_is_not_lit_yet_has_the_colours_of_what_it_shows(blank, tmp_path, preview):
    """Also where the scene shows a preview, whose nodes exporters would take for white light."""
    paint = parts.material("Paint", "PRINCIPLED", 1.0, 0.0)
    paint.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (0.9, 0.3, 0.1, 1.0)
    floor_mirror(blank, paint, lamp=False)
    result = parts.generate(preview=preview)
    assert ("Preview" in result.material_slots[0].material.name) == preview
    parts.select(result)
    path = tmp_path / "result.gltf"
    bpy.ops.export_scene.gltf(filepath=str(path), export_format="GLTF_SEPARATE", use_selection=True)
    told, = json.loads(path.read_text())["materials"]
    assert np.allclose(told["pbrMetallicRoughness"]["baseColorFactor"], (0.9, 0.3, 0.1, 1.0))
    assert "emissiveFactor" not in told


@pytest.mark.thorough
@pytest.mark.parametrize("kind", ["glb", "usdc"])
def test_vertex_colours_arrive_where_they_are_lit(blank, room, tmp_path, kind):
    """Emission by vertex colours needs no light, and in glTF is white: the picture of it is not."""
    result = floor_mirror(blank, painted(), lamp=False)
    colours = bpy.data.objects["Board"].data.color_attributes.new("Paint", "FLOAT_COLOR", "CORNER")
    colours.data.foreach_set("color", np.array([(1, 0, 0, 1), (0, 1, 0, 1), (0, 0, 1, 1), (1, 1, 0, 1)], "f").ravel())
    result = floor_again()
    seen = picture_of(room, [result])
    assert differs_by(seen, picture_brought_back(room, result, kind, tmp_path)) > 0.1
    bpy.ops.reflection_mesh.light(samples=16)
    (tmp_path / "lit").mkdir()
    assert differs_by(seen, picture_brought_back(room, result, kind, tmp_path / "lit")) < 0.01


def floor_again() -> bpy.types.Object:
    parts.select(bpy.data.objects["Board"], bpy.data.objects["Floor"])
    return parts.generate()


def test_glTF_carries_what_points_know_where_attributes_are_asked_for(blank, tmp_path):
    result = floor_mirror(blank, checks(), lamp=False)
    assert set(values_in_glb(written(result, "glb", tmp_path))) == {"POSITION", "NORMAL", "TEXCOORD_0"}
    values = values_in_glb(written(result, "glb", tmp_path, export_attributes=True))
    place, length, shown = (values[f"_{name}".upper()] for name in
                            ("mirror_position", "path_length", "reflected_position"))
    # reflected once, a point is as far from the mirror as the path is long
    assert np.abs(np.linalg.norm(shown - place, axis=1) - length[:, 0]).max() < 1e-4 * length.max()
    assert np.abs(place[:, 2] + 1.0).max() < 1e-4
    assert set(values) == {"POSITION", "NORMAL", "TEXCOORD_0", "_REFLECTED_POSITION", "_MIRROR_POSITION",
                           "_PATH_LENGTH", "_IMAGE_PARITY", "_SOURCE_OBJECT", "_BOUNCES"}
    # points are torn apart along borders of textures alone
    assert len(place) < 1.1 * len(result.data.vertices)


def nodes_with_meshes(folder) -> set[str]:
    """The objects whose meshes are in the file into which the whole scene has gone."""
    path = folder / "scene.gltf"
    bpy.ops.export_scene.gltf(filepath=str(path), export_format="GLTF_SEPARATE")
    return {node["name"] for node in json.loads(path.read_text())["nodes"] if "mesh" in node}


def test_glTF_leaves_out_the_mirror_that_a_lit_reflection_covers(blank, tmp_path):
    result = floor_mirror(blank, checks(), lamp=True)
    everything = {"Board", "Floor", result.name}
    assert nodes_with_meshes(tmp_path) == everything
    bpy.ops.reflection_mesh.light(samples=1)
    assert nodes_with_meshes(tmp_path) == everything - {"Floor"}
    # without its reflection it is an object like any other
    result.hide_viewport = True
    parts.select(bpy.data.objects["Floor"])
    bpy.ops.export_scene.gltf(filepath=str(tmp_path / "alone.gltf"), export_format="GLTF_SEPARATE", use_selection=True)
    alone, = json.loads((tmp_path / "alone.gltf").read_text())["nodes"]
    assert "mesh" in alone


@pytest.mark.parametrize("placement, stays", [("LAYERED", True), ("VIRTUAL", False)])
def test_glTF_keeps_a_mirror_with_a_frame_unless_the_image_lies_behind_it(blank, tmp_path, placement, stays):
    floor_mirror(blank, checks(), lamp=True)
    bpy.ops.reflection_mesh.clear()
    floor = bpy.data.objects["Floor"]
    floor.data.materials.append(parts.material("Frame", "DIFFUSE"))
    work = bmesh.new()
    work.from_mesh(floor.data)
    corners = [work.verts.new((x, 5.0, 0.0)) for x in (-1.0, 1.0)] + [work.verts.new((0.0, 6.0, 0.0))]
    work.faces.new(corners).material_index = 1
    work.to_mesh(floor.data)
    work.free()
    parts.select(bpy.data.objects["Board"], floor)
    parts.generate(placement=placement)
    bpy.ops.reflection_mesh.light(samples=1)
    assert ("Floor" in nodes_with_meshes(tmp_path)) == stays


def test_solid_view_shows_the_light(blank):
    """By texture the active image of each material, by attribute the active colours."""
    floor_mirror(blank, checks(), lamp=True)
    bpy.data.objects["Board"].data.color_attributes.new("Paint", "FLOAT_COLOR", "CORNER")
    result = floor_again()
    assert result.data.color_attributes.active_color.name == "Paint"
    bpy.ops.reflection_mesh.light(samples=4)
    material, mesh = result.material_slots[0].material, result.data
    assert material.node_tree.nodes.active.image == bpy.data.images["Reflection Light Export"]
    assert mesh.uv_layers.active.name == "Reflection Light" and mesh.uv_layers.active.active_render
    image = bpy.data.images["Reflection Light Export"]
    texels = np.array(image.pixels[:], dtype=np.float32).reshape(image.size[1], image.size[0], 4)
    texels[..., :3] = three_js.linear(texels[..., :3])
    colours = parts.attribute(result, mesh.color_attributes.active_color.name)
    assert mesh.color_attributes.active_color_index == mesh.color_attributes.render_color_index
    # of the texel in which the camera sees the point
    spots = np.empty((len(mesh.loops), 2), dtype=np.float32)
    mesh.uv_layers.active.uv.foreach_get("vector", spots.reshape(-1))
    near = []
    # on a border of two texels either will do
    for nudge in ((-1e-3, -1e-3), (-1e-3, 1e-3), (1e-3, -1e-3), (1e-3, 1e-3)):
        column, row = np.clip(spots * image.size + nudge, 0, np.array(image.size) - 1).astype(int).T
        near.append(np.abs(colours - texels[row, column]).max(axis=1))
    # the picture is filtered, the colours are not
    assert np.median(np.min(near, axis=0)) < 0.005


def images_behind(node: bpy.types.Node) -> set[str]:
    """The images that nodes show which feed a node, in groups too."""
    own = {node.image.name} if node.type == "TEX_IMAGE" else set()
    if node.type == "GROUP":
        own = {inner.image.name for inner in node.node_tree.nodes if inner.type == "TEX_IMAGE"}
    return own.union(*(images_behind(link.from_node) for socket in node.inputs for link in socket.links))


def test_cycles_and_eevee_show_light_in_full_and_exporters_begin_at_what_they_can_say(blank):
    floor_mirror(blank, checks(), lamp=True)
    bpy.ops.reflection_mesh.light(samples=1)
    tree = bpy.data.materials["Reflection Light"].node_tree
    shown = {engine: images_behind(tree.get_output_node(engine)) for engine in ("CYCLES", "EEVEE", "ALL")}
    assert shown == {"CYCLES": {"Reflection Light"}, "EEVEE": {"Reflection Light"}, "ALL": {"Reflection Light Export"}}
    begun, = [node for node in tree.nodes if node.type == "OUTPUT_MATERIAL" and node.is_active_output]
    assert begun == tree.get_output_node("ALL")
    assert bpy.data.images["Reflection Light"].is_float and not bpy.data.images["Reflection Light Export"].is_float


def test_the_picture_lies_where_the_camera_sees_it_inside_faces_too(blank, room):
    """Its UV map, linear on each face, against the projection of places inside; and only where it was wrong are faces
    cut."""
    result = floor_mirror(blank, checks(), lamp=True)
    before = len(result.data.polygons)
    bpy.ops.reflection_mesh.light(samples=1)
    mesh, view = result.data, room("addon.reading").read_view(blank)
    # measured: 2255, which lie within a tenth of a pixel where there are two texels along its side
    assert before < len(mesh.polygons) < before + 3000
    known = json.loads(result.reflection_mesh.light)
    spots = np.empty((len(mesh.loops), 2), dtype=np.float32)
    mesh.uv_layers.active.uv.foreach_get("vector", spots.reshape(-1))
    told = spots.reshape(-1, 3, 2) * known["size"] / known["dense"]
    places = np.array([result.matrix_world @ vertex.co for vertex in mesh.vertices])[parts.corners(result)]
    # each source has a part of the picture, which may begin anywhere
    at = view.pixels(places.reshape(-1, 3)).reshape(told.shape)
    inside = ((at >= 0.0) & (at <= SIZE)).all(axis=(1, 2))
    assert inside.sum() > 500
    places, told = places[inside], (told - (told - at).mean(axis=1, keepdims=True))[inside]
    for weights in np.random.default_rng(1).dirichlet((1.0, 1.0, 1.0), 8):
        true = view.pixels(np.einsum("c,fcx->fx", weights, places))
        assert np.abs(true - np.einsum("c,fcx->fx", weights, told)).max() < 0.2
    # what is new lies between what was there
    assert np.abs(parts.attribute(result, "mirror_position")[:, 2] + 1.0).max() < 1e-5
    assert set(np.unique(parts.attribute(result, "image_parity"))) <= {-1, 1}


def test_eight_maps_leave_room_for_the_light(blank, room):
    result = floor_mirror(blank, checks(), lamp=True)
    board = bpy.data.objects["Board"]
    while len(board.data.uv_layers) < 8:
        board.data.uv_layers.new(name=f"Map {len(board.data.uv_layers)}")
    result = floor_again()
    assert len(result.data.uv_layers) == 8
    bpy.ops.reflection_mesh.light(samples=1)
    assert result.data.uv_layers.active.name == "Reflection Light"
    floor_again()
    assert len(result.data.uv_layers) == 8 and result.data.uv_layers.active.name == "Reflection Light"


def scan_before_a_floor_mirror(context: bpy.types.Context, options: dict) -> bpy.types.Object:
    """The board as a dense scan, shown by points."""
    floor_mirror(context, checks(), lamp=True)
    dense = bpy.data.objects["Board"].modifiers.new("Dense", "SUBSURF")
    dense.subdivision_type, dense.levels, dense.render_levels = "SIMPLE", 7, 7
    bpy.ops.reflection_mesh.clear()
    parts.select(bpy.data.objects["Board"], bpy.data.objects["Floor"])
    return parts.generate(method="POINTS", **options)


@pytest.mark.thorough
def test_discs_show_their_light_in_solid_view_and_in_usd(blank, room, tmp_path):
    """The map that is taken where none is named is the light's, as with faces; before they are lit, the source's."""
    result = scan_before_a_floor_mirror(blank, {})

    def shown() -> list[str]:
        mesh = bpy.data.meshes.new_from_object(result.evaluated_get(bpy.context.evaluated_depsgraph_get()))
        return [layer.name for layer in mesh.uv_layers if layer.active and layer.active_render]
    assert shown() == ["UVMap"]
    bpy.ops.reflection_mesh.light(samples=16)
    assert shown() == ["Reflection Light"]
    # of both maps each has its own values still
    assert np.ptp(parts.attribute(result, "UVMap")) == pytest.approx(1.0, abs=0.1)
    seen = picture_of(room, [result])
    # measured: 0.0005
    assert differs_by(seen, picture_brought_back(room, result, "usdc", tmp_path)) < 0.001
    bpy.ops.reflection_mesh.light(samples=1)
    assert shown() == ["Reflection Light"]
    bpy.context.scene.camera.location.x += 0.3     # where the light fits no more
    parts.generate(method="POINTS")
    assert shown() == ["UVMap"]


@pytest.mark.thorough
def test_discs_that_are_made_a_mesh_go_out_by_gltf_with_their_light(blank, room, tmp_path):
    """Its exporter leaves modifiers out, or an object's own materials."""
    result = scan_before_a_floor_mirror(blank, {})
    bpy.ops.reflection_mesh.light(samples=16)
    seen = picture_of(room, [result])
    parts.select(result)
    bpy.ops.object.convert(target="MESH")
    assert differs_by(seen, picture_brought_back(room, bpy.context.object, "glb", tmp_path)) < 0.001
