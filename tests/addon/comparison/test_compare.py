"""The comparison with Cycles: its truth against analytic rays, its tidiness."""
from __future__ import annotations

import json
from types import SimpleNamespace

import bpy
import numpy as np
import parts
import pytest

SIZE = 64
COUNTED = ("objects", "meshes", "materials", "scenes", "cameras", "lights", "worlds", "collections", "node_groups")


@pytest.fixture(scope="module")
def rooms(room) -> SimpleNamespace:
    """The extension's rooms for comparing."""
    names = ("compat", "operators.compare", "comparison.compare_pictures",
             "judge.cycles_codes", "judge.cycles_render", "judge.cycles_scene", "rendering.cycles_pictures",
             "reading.read_view", "faults")
    return SimpleNamespace(**{name.rpartition(".")[2]: room(f"addon.{name}") for name in names})


@pytest.fixture
def flat_scene():
    """A mirror on the ground, a sloping plate above, and an orthographic eye that looks down past the plate."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    scene = bpy.context.scene
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.data.type, camera.data.ortho_scale = "ORTHO", 2.0
    camera.location, camera.rotation_euler = (0.0, -4.0, 4.0), (np.pi / 4, 0.0, 0.0)
    scene.collection.objects.link(camera)
    scene.camera = camera
    bpy.ops.mesh.primitive_plane_add(size=8.0, location=(0.0, 3.0, 3.0), rotation=(-np.pi / 4, 0.0, 0.0))
    plate = bpy.context.object
    plate.data.materials.append(bpy.data.materials.new("Plain"))
    bpy.ops.mesh.primitive_plane_add(size=2.0)
    mirror = bpy.context.object
    plate.select_set(True)
    return SimpleNamespace(mirror=mirror, plate=plate, camera=camera)


def state() -> dict:
    """What a comparison must leave as it was."""
    scene, layer = bpy.context.scene, bpy.context.view_layer
    return {
        "data": {name: sorted(item.name for item in getattr(bpy.data, name)) for name in COUNTED},
        "images": sorted(image.name for image in bpy.data.images if image.type != "RENDER_RESULT"),
        "scene": scene.name, "active": layer.objects.active.name,
        "selected": sorted(obj.name for obj in bpy.context.selected_objects),
        "settings": (scene.render.engine, scene.render.filepath, scene.render.resolution_x, scene.frame_current,
                     scene.render.image_settings.file_format, scene.view_settings.view_transform,
                     scene.world and scene.world.name, scene.camera.name),
        "objects": {obj.name: (obj.hide_render, obj.visible_camera, obj.visible_glossy, obj.pass_index,
                               [slot.material and slot.material.name for slot in obj.material_slots],
                               [attribute.name for attribute in obj.data.attributes] if obj.type == "MESH" else [])
                    for obj in bpy.data.objects},
    }


def test_the_truth_agrees_with_mirrored_rays(rooms, flat_scene):
    """Each ray, mirrored at z = 0 and met with the plate's plane y + z = 6 by hand, against what Cycles shows."""
    with rooms.cycles_scene.copied_scene(bpy.context, [flat_scene.mirror], [flat_scene.plate], []) as copied:
        mirror, bent, truth, *_ = rooms.faults.finished(
            rooms.compare_pictures.render_comparison(bpy.context, copied, [flat_scene.plate], [], 1))
    view = rooms.read_view.read_view(bpy.context)
    rows, columns = np.mgrid[0:SIZE, 0:SIZE]
    origins, directions = view.rays(np.column_stack([columns.ravel(), rows.ravel()]) + 0.5)
    ground = origins - directions * (origins[:, 2:] / directions[:, 2:])
    reflected = directions * (1.0, 1.0, -1.0)
    length = (6.0 - ground[:, 1] - ground[:, 2]) / (reflected[:, 1] + reflected[:, 2])
    expected = (ground + length[:, None] * reflected).reshape(SIZE, SIZE, 3)
    seen = (np.abs(ground[:, :2]) < 1.0).all(axis=1).reshape(SIZE, SIZE)
    assert (mirror == seen).mean() > 0.995
    assert mirror.sum() > 1000 and not bent.any()
    both = mirror & seen
    assert (truth.source[both] == 0).all()
    pixel = 2.0 / SIZE
    # Cycles draws its sample within a hundredth of a pixel of the centre
    assert np.linalg.norm(truth.position[both] - expected[both], axis=1).max() < 0.03 * pixel


@pytest.mark.feature("compare")
def test_an_exact_reflection_is_found_exact(flat_scene, tmp_path):
    bpy.ops.reflection_mesh.generate(tolerance=0.1)
    assert bpy.ops.reflection_mesh.compare(filepath=str(tmp_path / "new" / "folder"), samples=1) == {"FINISHED"}
    report = json.loads((tmp_path / "new" / "folder" / "report.json").read_text())
    assert report["displacement_px"]["max"] < 0.1 + 0.03
    assert report["coverage_percent"]["all"] == 0.0
    assert report["resolution"] == [SIZE, SIZE]
    written = {path.name for path in (tmp_path / "new" / "folder").iterdir()}
    assert written == {"reference.png", "result.png", "difference.png", "displacement.png", "holes.png", "report.json",
                       "report.csv", "report.html"}


@pytest.mark.feature("compare")
def test_a_spoilt_reflection_is_found_spoilt(flat_scene, tmp_path):
    """Points moved along x by 0.75 pixels, which is 0.75 pixels on the plate too, since x is not foreshortened."""
    bpy.ops.reflection_mesh.generate(tolerance=0.1)
    mesh = bpy.context.view_layer.objects.active.data
    points = np.empty(len(mesh.vertices) * 3, dtype=np.float32)
    mesh.attributes["reflected_position"].data.foreach_get("vector", points)
    points[0::3] += 0.75 * 2.0 / SIZE
    mesh.attributes["reflected_position"].data.foreach_set("vector", points)
    mesh.update()
    bpy.ops.reflection_mesh.compare(filepath=str(tmp_path), samples=1)
    report = json.loads((tmp_path / "report.json").read_text())
    assert report["displacement_px"]["median"] == pytest.approx(0.75, abs=0.06)

    mesh.clear_geometry()
    for name, kind, domain in (("reflected_position", "FLOAT_VECTOR", "POINT"), ("source_object", "INT", "FACE"),
                               ("source_face", "INT", "FACE")):
        mesh.attributes.new(name, kind, domain)
    bpy.ops.reflection_mesh.compare(filepath=str(tmp_path), samples=1)
    report = json.loads((tmp_path / "report.json").read_text())
    assert report["coverage_percent"]["hole"] == 100.0
    assert report["displacement_px"]["median"] is None


def test_a_mirror_without_reflection_gets_one(flat_scene, tmp_path):
    assert bpy.ops.reflection_mesh.compare(filepath=str(tmp_path), samples=1) == {"FINISHED"}
    report = json.loads((tmp_path / "report.json").read_text())
    assert report["results"] == [f"{flat_scene.mirror.name} Reflection"]
    assert report["coverage_percent"]["all"] < 0.5


def test_nothing_changes(flat_scene, tmp_path):
    bpy.ops.reflection_mesh.generate()
    flat_scene.camera.data.dof.use_dof = True
    bpy.context.scene.frame_set(7)
    before = state()
    bpy.ops.reflection_mesh.compare(filepath=str(tmp_path), samples=1)
    assert state() == before


def test_nothing_changes_when_a_render_fails(rooms, flat_scene, tmp_path, monkeypatch):
    bpy.ops.reflection_mesh.generate()
    before = state()

    def fails(scene):
        raise rooms.compare.ReflectionError("The render failed: try again.")

    monkeypatch.setattr(rooms.cycles_render, "render_codes", fails)
    with pytest.raises(RuntimeError, match="The render failed: try again."):
        bpy.ops.reflection_mesh.compare(filepath=str(tmp_path), samples=1)
    assert state() == before
    assert not list(tmp_path.iterdir())


def test_nothing_is_left_when_a_render_is_cancelled(rooms, flat_scene, tmp_path, monkeypatch):
    """A render that is cancelled leaves no file; the reflection that was made for the comparison goes too."""
    before, render, count = state(), rooms.cycles_pictures._write_still, []

    def cancelled_at_the_last(scene):
        count.append(scene.name)
        if len(count) < 6:
            render(scene)

    monkeypatch.setattr(rooms.cycles_pictures, "_write_still", cancelled_at_the_last)
    with pytest.raises(RuntimeError, match="cancelled"):
        bpy.ops.reflection_mesh.compare(filepath=str(tmp_path), samples=1)
    assert len(count) == 6
    assert state() == before
    assert not list(tmp_path.iterdir())


def test_pictures_are_rendered_as_the_scene_is_set(rooms, flat_scene, tmp_path, monkeypatch):
    bpy.ops.reflection_mesh.generate()
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.glossy_bounces = 3, False, 7
    render, seen = rooms.cycles_pictures._write_still, []

    def watched(copy):
        seen.append((copy.cycles.samples, copy.cycles.glossy_bounces))
        render(copy)

    monkeypatch.setattr(rooms.cycles_pictures, "_write_still", watched)
    bpy.ops.reflection_mesh.compare(filepath=str(tmp_path), samples=0)
    assert seen[-2:] == [(3, 7), (3, 7)] and set(seen[:-2]) == {(1, 1)}


@pytest.mark.parametrize(("filepath", "message"), [("//pictures", "has not been saved"), ("", "No folder is named")])
def test_a_folder_that_cannot_be_is_refused(flat_scene, filepath, message):
    before = state()
    with pytest.raises(RuntimeError, match=message):
        bpy.ops.reflection_mesh.compare(filepath=filepath)
    assert state() == before


def test_a_file_in_place_of_the_folder_is_refused(flat_scene, tmp_path):
    (tmp_path / "taken").write_text("mine")
    before = state()
    with pytest.raises(RuntimeError, match="choose another one"):
        bpy.ops.reflection_mesh.compare(filepath=str(tmp_path / "taken"))
    assert state() == before
    assert (tmp_path / "taken").read_text() == "mine"


def test_a_hidden_reflection_is_refused(flat_scene, tmp_path):
    bpy.ops.reflection_mesh.generate()
    bpy.context.view_layer.objects.active.hide_render = True
    before = state()
    with pytest.raises(RuntimeError, match="is hidden"):
        bpy.ops.reflection_mesh.compare(filepath=str(tmp_path))
    assert state() == before


def test_edit_mode_is_refused(flat_scene, tmp_path):
    bpy.ops.object.mode_set(mode="EDIT")
    with pytest.raises(RuntimeError, match="Object Mode"):
        bpy.ops.reflection_mesh.compare(filepath=str(tmp_path))
    assert bpy.context.mode == "EDIT_MESH"
    bpy.ops.object.mode_set(mode="OBJECT")


def test_sheared_mirrored_and_instanced_objects_stand_where_they_are(flat_scene, tmp_path):
    """The plate as an instance below a parent that shears and turns it inside out: mesh and Cycles still agree."""
    plate = flat_scene.plate
    hidden = bpy.data.collections.new("Elsewhere")
    hidden.objects.link(plate)
    bpy.context.scene.collection.objects.unlink(plate)
    parent = bpy.data.objects.new("Parent", None)
    parent.scale = (-1.0, 1.5, 0.8)
    parent.rotation_euler = (0.2, 0.1, 0.3)
    instancer = bpy.data.objects.new("Instancer", None)
    instancer.instance_type, instancer.instance_collection = "COLLECTION", hidden
    instancer.rotation_euler = (0.3, -0.2, 0.4)
    instancer.parent = parent
    for obj in (parent, instancer):
        bpy.context.scene.collection.objects.link(obj)
    bpy.context.view_layer.update()
    instancer.select_set(True)
    bpy.ops.reflection_mesh.generate(tolerance=0.1)
    bpy.ops.reflection_mesh.compare(filepath=str(tmp_path), samples=1)
    report = json.loads((tmp_path / "report.json").read_text())
    assert report["diffuse"] == ["Instancer"]
    assert report["measured_pixels"] > 1000
    assert report["displacement_px"]["max"] < 0.1 + 0.03
    assert report["coverage_percent"]["all"] < 0.5


def test_a_scene_without_camera_is_refused(flat_scene, tmp_path):
    bpy.context.scene.camera = None
    with pytest.raises(RuntimeError, match="no camera"):
        bpy.ops.reflection_mesh.compare(filepath=str(tmp_path / "pictures"))
    assert not (tmp_path / "pictures").exists()


# ---- what Cycles does to normals ----------------------------------------------------------------------------------

def rounded(normals):
    """Normals as Cycles 5 stores them: on an octahedron, 2 x 16 bits, in float32.

    Written after `packed_normal` in intern/cycles/util/types_normal.h of Blender's sources, whose formula is that of
    Z. Cigolle et al., "A Survey of Efficient Representations for Independent Unit Vectors", JCGT 3(2), 2014.
    """
    normals = normals.astype(np.float32)
    half = np.float32(65535 / 2)
    flat = normals[:, :2] / (np.abs(normals).sum(axis=1, keepdims=True) + np.float32(1e-6))
    folded = (1 - np.abs(flat[:, ::-1])) * np.copysign(np.float32(1), flat)
    flat = np.where(normals[:, 2:] >= 0, flat, folded)
    code = np.floor(np.clip(flat * half + (half + np.float32(0.5)), 0, 65535))
    flat = (code / half - 1).astype(np.float32)
    up = 1 - np.abs(flat).sum(axis=1)
    flat += np.copysign(np.maximum(-up, 0)[:, None], -flat)
    unpacked = np.column_stack([flat, up])
    return unpacked / np.linalg.norm(unpacked, axis=1, keepdims=True)


def carry_stored_normals(rooms, copied):
    """Normals as Cycles stores them: from 5.0 on rounded in the object's space, and once more in the world's.

    Where objects share a mesh, it stays in the object's space.
    """
    for copy, _ in copied.mirrors:
        mesh, matrix = copy.data, np.array(copy.matrix_world)[:3, :3]
        normals = np.empty((len(mesh.loops), 3), dtype=np.float32)
        mesh.corner_normals.foreach_get("vector", normals.ravel())
        stored = rounded if bpy.app.version[0] >= 5 else np.asarray
        normals = stored(normals)
        if sum(other.data == mesh for other in copied.everything) == 1:
            world = normals @ np.linalg.inv(matrix)
            normals = stored(world / np.linalg.norm(world, axis=1, keepdims=True)) @ matrix
        name = rooms.cycles_codes.MIRROR_NORMAL
        mesh.attributes.new(name, "FLOAT_VECTOR", "CORNER").data.foreach_set(
            "vector", normals.astype(np.float32).ravel())


@pytest.fixture
def curved_scene(flat_scene):
    """The mirror of `flat_scene` as a dish, turned, sheared by its scale, and seen from its back."""
    bpy.data.objects.remove(flat_scene.mirror)
    bpy.ops.mesh.primitive_uv_sphere_add(segments=32, ring_count=24, location=(0.0, 0.3, -0.8),
                                         rotation=(0.3, 0.2, 0.5))
    mirror = bpy.context.object
    mirror.scale = (0.9, 0.7, 0.8)
    mirror.data.polygons.foreach_set("use_smooth", [True] * len(mirror.data.polygons))
    mirror.data.flip_normals()
    return SimpleNamespace(mirror=mirror, plate=flat_scene.plate)


@pytest.mark.parametrize("shared", [False, True])
def test_rounding_explains_all_that_cycles_does_to_normals(rooms, curved_scene, monkeypatch, shared):
    """Normals from an attribute, rounded by hand as Cycles stores its own, give Cycles' own picture, and no others."""
    if shared:
        twin = bpy.data.objects.new("Twin", curved_scene.mirror.data)
        twin.location.z = -50.0
        bpy.context.scene.collection.objects.link(twin)
    found = {}
    carry_exact = rooms.cycles_codes.carry_normals
    for kind, carry in (("stored", lambda copied: carry_stored_normals(rooms, copied)), ("exact", carry_exact)):
        with monkeypatch.context() as patch, rooms.cycles_scene.copied_scene(
                bpy.context, [curved_scene.mirror], [curved_scene.plate], []) as copied:
            patch.setattr(rooms.compat, "packs_normals", lambda: True)
            patch.setattr(rooms.cycles_codes, "carry_normals", carry)
            renders = rooms.faults.finished(
                rooms.compare_pictures.render_comparison(bpy.context, copied, [curved_scene.plate], [], 1))
        same = renders.mirror & (renders.truth.source == 0) & (renders.exact.source == 0)
        assert same.sum() > 250
        assert (renders.truth.source == renders.exact.source)[renders.mirror & ~renders.bent].mean() > 0.99
        found[kind] = np.linalg.norm(renders.truth.position - renders.exact.position, axis=2)[same]
    # positions of a few units in float32, along rays that the mirror spreads; rounding moves them by over 1e-4
    assert found["stored"].max() < 2e-5
    assert (np.median(found["exact"]) > 1e-4) == (bpy.app.version[0] >= 5)


def test_the_judge_shades_bent_faces_as_cycles_does(blank, tmp_path):
    """A flat wall mirror, one of whose corners is pulled out."""
    mirror = parts.add_wall_mirror()
    mirror.data.vertices[3].co.z = 0.5
    balls = [parts.add("ico_sphere", f"Ball {place}", radius=0.5, location=(place, -2.0, 1.0 + 0.2 * place))
             for place in (-2, 0, 2)]
    for ball in balls:
        ball.data.materials.append(parts.material("Paint"))
    parts.select(*balls, mirror)
    parts.generate()
    bpy.ops.reflection_mesh.compare(filepath=str(tmp_path), samples=1)
    report = json.loads((tmp_path / "report.json").read_text())
    for judged in (report, report["without_packed_normals"] or report):
        assert judged["displacement_px"]["max"] < 1.0
        assert judged["coverage_percent"]["all"] < 1.0
