"""Scenes as they come: thousands of instances, libraries and overrides, view layers, collections that are held out or
seen in mirrors alone, every size. Mirrors show what they show in Cycles."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from mathutils import Matrix


def bent_leaf() -> bpy.types.Object:
    """A mesh with quads, a UV map, a colour, a marked edge, a sharp face, and a bend that is a crease where it is
    stretched."""
    mesh = bpy.data.meshes.new("Leaf")
    mesh.from_pydata([(0, 0, 0), (1, 0, 0), (1, 1, 0.3), (0, 1, 0.3), (1, 2, 0), (0, 2, 0), (0.5, 3, 1)], [],
                     [(0, 1, 2, 3), (3, 2, 4, 5), (5, 4, 6)])
    rng = np.random.default_rng(5)
    mesh.uv_layers.new(name="UVMap").uv.foreach_set("vector", rng.random(22, dtype=np.float32))
    tone = mesh.color_attributes.new("Tone", "FLOAT_COLOR", "CORNER")
    tone.data.foreach_set("color", rng.random(44, dtype=np.float32))
    mesh.polygons.foreach_set("use_smooth", [True, True, False])
    next(edge for edge in mesh.edges if set(edge.vertices) == {0, 1}).use_edge_sharp = True
    mesh.update()
    obj = bpy.data.objects.new("Leaf", mesh)
    bpy.context.scene.collection.objects.link(obj)
    return obj


UNSTRETCHED = 15


def placings(count: int) -> list:
    """Turned, some of them inside out, all but the first ones stretched."""
    rng = np.random.default_rng(6)
    found = []
    for number in range(count):
        scale = rng.uniform(0.3, 3.0, 3 if number >= UNSTRETCHED else 1) * np.where(rng.random(3) < 0.3, -1.0, 1.0)
        found.append(Matrix.LocRotScale(rng.uniform(-2.0, 2.0, 3), Matrix.Rotation(rng.uniform(0, 6), 3, (1, 2, 3)),
                                        scale))
    return found


def read(room, objects):
    bpy.context.view_layer.update()
    return room("addon.reading").read_scene(bpy.context.evaluated_depsgraph_get(), objects)


def unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def test_a_mesh_in_many_places_is_as_many_meshes_in_theirs(blank, room):
    """One mesh placed by matrices against meshes that Blender itself has transformed, at some triangles."""
    leaf, matrices = bent_leaf(), placings(40)
    shared, own = [], []
    for matrix in matrices:
        copy = bpy.data.objects.new("Copy", leaf.data)
        copy.matrix_world = matrix
        applied = bpy.data.objects.new("Applied", leaf.data.copy())
        applied.data.transform(matrix)
        if matrix.determinant() < 0.0:
            # as the tool that applies a scale does
            applied.data.flip_normals()
        for obj, group in ((copy, shared), (applied, own)):
            bpy.context.scene.collection.objects.link(obj)
            group.append(obj)
    one, other = read(room, shared), read(room, own)
    assert len(one.source_object) == len(other.source_object) == 40 * 5
    rng = np.random.default_rng(7)
    # the same triangles in both, corner by corner
    corners = [scene.mesh.positions[scene.mesh.triangles] for scene in (one, other)]
    for triangle in rng.permutation(200)[:120]:
        turns = np.stack([np.roll(corners[0][triangle], -k, axis=0) for k in range(3)])
        same = np.abs(corners[1][:, None] - turns).max(axis=(2, 3))
        match, turn = np.unravel_index(np.argmin(same), same.shape)
        assert same[match, turn] < 1e-4
        ours, theirs = np.array([triangle]), np.array([match])
        assert one.source_object[triangle] == other.source_object[match]
        back = (np.arange(3) + turn) % 3
        assert np.allclose(one.uv_maps["UVMap"][ours][0][back], other.uv_maps["UVMap"][theirs][0], atol=1e-6)
        assert np.allclose(one.colours["Tone"][1][ours][0][back], other.colours["Tone"][1][theirs][0], atol=1e-6)
        assert one.sharp_face[ours] == other.sharp_face[theirs]
        assert (one.sharp_side[ours][0][back] == other.sharp_side[theirs][0]).all()
        if not one.sharp_face[ours][0] and one.source_object[triangle] >= UNSTRETCHED:
            # Blender weighs the faces' normals anew
            continue
        normals = unit(one.normals[ours])[0][back], unit(other.normals[theirs])[0]
        assert np.allclose(*normals, atol=1e-3)


def test_rows_are_found_by_any_index(blank, room):
    leaf = bent_leaf()
    copy = bpy.data.objects.new("Copy", leaf.data)
    copy.matrix_world = Matrix.Diagonal((-1.0, 2.0, 1.0, 1.0))
    bpy.context.scene.collection.objects.link(copy)
    scene = read(room, [leaf, copy, parts.add("cube", "Box")])
    for values in (scene.normals, scene.uv_maps["UVMap"], scene.sharp_side, scene.marked_face):
        whole, rows = values[:], np.array([3, 17, 3, 0, 9])
        assert len(whole) == len(values) == 10 + 12 and (values[rows] == whole[rows]).all()
        assert (values[np.arange(22) > 5] == whole[6:]).all()
        if whole.ndim > 1:
            assert (values[rows, rows % 3] == whole[rows, rows % 3]).all()


def test_each_mesh_is_read_once(blank, room, monkeypatch):
    module = room("addon.reading.meshes.read_meshes")
    seen, plain = [], module._read
    monkeypatch.setattr(module, "_read", lambda *given: seen.append(given[0].name) or plain(*given))
    cube, plane = parts.add("cube", "Box", size=0.1), parts.add("grid", "Field", x_subdivisions=31, y_subdivisions=31)
    cube.parent, plane.instance_type = plane, "VERTS"
    scene = read(room, [plane])
    assert sorted(seen) == ["Box", "Field"] and len(scene.mesh.triangles) == 2 * 31 * 31 + 12 * 32 * 32
    # counted on from place to place
    assert sorted(scene.source_face) == list(range(len(scene.source_face)))


def test_a_hidden_one_of_thousands_is_found_soon(blank, room, monkeypatch):
    """Choosing takes a look at each object, not at all of them for each."""
    cube, mirror = parts.add("cube", "Box"), parts.add_wall_mirror()
    many = [bpy.data.objects.new("Many", cube.data) for _ in range(3000)]
    for obj in many:
        bpy.context.scene.collection.objects.link(obj)
    bpy.context.view_layer.update()
    parts.select(cube, *many, mirror)
    asked, plain = [], bpy.types.Object.users_collection
    monkeypatch.setattr(bpy.types.Object, "users_collection",
                        property(lambda obj: asked.append(obj) or plain.fget(obj)))
    chosen = room("addon.reading").choose(bpy.context)
    assert (len(chosen.mirrors), len(chosen.diffuse), len(asked)) == (1, 3001, 0)


@pytest.fixture
def ball_scene(blank):
    """A cube and a cone before a curved mirror."""
    sources = [parts.add("cube", "Box", size=0.8, location=(0.8, -1.5, 1.0)),
               parts.add("cone", "Cone", radius1=0.5, depth=1.0, location=(-0.8, -1.5, 1.2))]
    for obj in sources:
        obj.data.materials.append(parts.material(obj.name))
    mirror = parts.add("uv_sphere", "Mirror", segments=48, ring_count=24, radius=1.6, location=(0.0, 1.2, 1.0))
    mirror.data.polygons.foreach_set("use_smooth", np.ones(len(mirror.data.polygons), dtype=bool))
    mirror.data.materials.append(parts.material("Chrome", "GLOSSY"))
    parts.select(*sources, mirror)
    return mirror, *sources


def in_collection(obj, **settings) -> None:
    """Move an object into a collection of its own, with settings of its layer collection."""
    made = bpy.data.collections.new("Special")
    bpy.context.scene.collection.children.link(made)
    made.objects.link(obj)
    bpy.context.scene.collection.objects.unlink(obj)
    layer = bpy.context.view_layer.layer_collection.children["Special"]
    for name, value in settings.items():
        setattr(layer, name, value)
    bpy.context.view_layer.update()


def difference(result) -> tuple:
    """Of the pixels of Cycles' pictures with the mirror and with the result: the share that differs, and the share
    that shows anything."""
    scene = bpy.context.scene
    scene.render.engine, scene.cycles.samples, scene.render.film_transparent = "CYCLES", 1, True
    scene.cycles.pixel_filter_type, scene.view_settings.view_transform = "BOX", "Raw"
    scene.render.image_settings.file_format = "OPEN_EXR"
    pictures = []
    for hidden in (True, False):
        result.hide_render = hidden
        scene.render.filepath = bpy.app.tempdir + f"/everyday {hidden}.exr"
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(scene.render.filepath)
        pixels = np.array(image.pixels[:], dtype=np.float32).reshape(-1, 4)
        bpy.data.images.remove(image)
        pictures.append(np.column_stack((pixels[:, :3].max(axis=1) > 0.3, pixels[:, 3] > 0.5)))
    return float((pictures[0] != pictures[1]).any(axis=1).mean()), float(pictures[0][:, 0].mean())


@pytest.mark.thorough
@pytest.mark.parametrize("case", ["holdout source", "holdout mirror", "indirect source", "indirect mirror",
                                  "no glossy rays", "tiny", "huge", "stretched"])
def test_cycles_shows_the_same(ball_scene, case):
    mirror, box, cone = ball_scene
    kind, _, who = case.partition(" ")
    camera = bpy.context.scene.camera
    if kind in {"holdout", "indirect"}:
        in_collection(box if who == "source" else mirror, **{{"indirect": "indirect_only"}.get(kind, kind): True})
    elif kind == "no":
        box.visible_glossy = False
    elif kind == "stretched":
        mirror.scale, cone.scale = (1.0, 0.4, 1.5), (1.0, 2.0, -0.3)
    else:
        size = {"tiny": 1e-4, "huge": 1e4}[kind]
        for obj in (mirror, box, cone, camera):
            obj.location *= size
            if obj != camera:
                obj.scale *= size
        camera.data.clip_start *= size
        camera.data.clip_end *= size
    bpy.context.view_layer.update()
    parts.select(box, cone, mirror)
    result = parts.generate(collect=True)
    assert (box in [source.object for source in result.reflection_mesh.sources]) == (kind != "no")
    differing, shown = difference(result)
    # rays through pixels' middles cross edges of the box and the cone by half a pixel at the most
    assert differing < 0.004 and shown > 0.05


def test_what_no_glossy_ray_meets_is_told(ball_scene):
    mirror, box, cone = ball_scene
    box.visible_glossy = cone.visible_glossy = False
    assert parts.refusal() == ("The reflected object 'Box' is hidden: show it in the viewport, in renders and to "
                               "glossy rays.")


def test_each_view_layer_shows_its_own(ball_scene):
    """A result shows what its view layer does, and is generated by the one that is open."""
    mirror, box, cone = ball_scene
    in_collection(box)
    scene = bpy.context.scene
    other = scene.view_layers.new("Other")
    other.layer_collection.children["Special"].exclude = True
    window = bpy.context.window
    with bpy.context.temp_override(scene=scene, view_layer=other, window=window):
        for obj in (cone, mirror):
            obj.select_set(True, view_layer=other)
        other.objects.active = mirror
        assert bpy.ops.reflection_mesh.generate("EXEC_DEFAULT") == {"FINISHED"}
    result = bpy.data.objects["Mirror Reflection"]
    assert [source.object for source in result.reflection_mesh.sources] == [cone]
    parts.select(box, cone, mirror)
    assert parts.generate() == result and len(result.reflection_mesh.sources) == 2


@pytest.mark.parametrize("who", ["mirror", "sources", "all"])
def test_overrides_of_a_library(blank, tmp_path, who):
    """Mirror, sources or both as overrides of linked objects: result, window and second click as ever."""
    box = parts.add("cube", "Box", size=0.8, location=(0.0, -2.5, 1.0))
    mirror = parts.add_wall_mirror()
    box.data.materials.append(parts.material("Plain"))
    mirror.data.materials.append(parts.material("Chrome", "GLOSSY"))
    chosen = {"mirror": [mirror], "sources": [box], "all": [mirror, box]}[who]
    path, names = str(tmp_path / "library.blend"), [obj.name for obj in chosen]
    bpy.data.libraries.write(path, set(chosen))
    for obj in chosen:
        bpy.data.objects.remove(obj)
    with bpy.data.libraries.load(path, link=True) as (_, wanted):
        wanted.objects = names
    for obj in wanted.objects:
        bpy.context.scene.collection.objects.link(obj)
        assert obj.override_create(remap_local_usages=True).override_library
    mirror, box = (bpy.data.objects[name, None] for name in ("Mirror", "Box"))
    for obj in bpy.context.scene.collection.objects:
        if obj.library is not None:
            bpy.context.scene.collection.objects.unlink(obj)
    for obj in (mirror, box):
        if obj.name not in bpy.context.scene.collection.objects:
            bpy.context.scene.collection.objects.link(obj)
    bpy.context.view_layer.update()
    parts.select(box, mirror)
    result = parts.generate(placement="VIRTUAL")
    assert result.library is None and result.reflection_mesh.mirror == mirror and not mirror.visible_camera
    assert result.reflection_mesh.sources[0].object == box
    box.location.x += 0.25
    bpy.context.view_layer.update()
    parts.select(mirror)
    assert parts.generate(placement="LAYERED") == result and mirror.visible_camera
    assert parts.attribute(result, "reflected_position")[:, 0].max() == pytest.approx(0.65, abs=1e-6)
