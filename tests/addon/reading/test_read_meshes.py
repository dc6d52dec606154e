"""Evaluated meshes in world space, against what Blender says of each face corner, one by one."""
import bpy
import numpy as np
import parts
import pytest
from mathutils import Matrix


def plain_triangles(obj: bpy.types.Object, of_vertices: bool = False,
                    bent: bool = False) -> tuple[np.ndarray, np.ndarray]:
    """World corners (m, 3, 3) and world corner normals of an object, through mathutils, one at a time.

    `of_vertices` asks for the vertices' normals on smooth faces, as Cycles takes them beside flat ones up to 4.5;
    `bent` for the triangles' own on flat faces.
    """
    def normal_of(triangle, vertex: int, index: int):
        if triangle.use_smooth and of_vertices:
            return mesh.vertices[vertex].normal
        return mesh.corner_normals[index].vector if triangle.use_smooth or not bent else triangle.normal
    evaluated = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh, matrix = evaluated.data, obj.matrix_world
    to_normal = matrix.to_3x3().inverted().transposed()
    corners = [[matrix @ mesh.vertices[index].co for index in triangle.vertices] for triangle in mesh.loop_triangles]
    normals = [[(to_normal @ normal_of(triangle, vertex, index)).normalized()
                for vertex, index in zip(triangle.vertices, triangle.loops)] for triangle in mesh.loop_triangles]
    return np.array(corners), np.array(normals)


def read_mirror(room, obj: bpy.types.Object):
    bpy.context.view_layer.update()
    return room("addon.reading.meshes.join_meshes").read_mirror(bpy.context.evaluated_depsgraph_get(), obj)


def read_scene(room, *objects: bpy.types.Object):
    bpy.context.view_layer.update()
    return room("addon.reading.meshes.join_meshes").read_scene(bpy.context.evaluated_depsgraph_get(), list(objects))


def suzanne(shading: str) -> bpy.types.Object:
    obj = parts.add("monkey", "Suzanne", location=(3.0, -2.0, 5.0), rotation=(0.3, 0.5, 0.7))
    obj.scale = 1.0, 2.0, 0.5
    mesh = obj.data
    if shading != "flat":
        mesh.shade_smooth()
    if shading == "mixed":
        mesh.polygons.foreach_set("use_smooth", np.arange(len(mesh.polygons)) % 2 == 0)
    if shading == "custom":
        random = np.random.default_rng(3).normal(size=(len(mesh.loops), 3)) * 0.2
        own = np.array([normal.vector for normal in mesh.corner_normals])
        mesh.normals_split_custom_set((own + random) / np.linalg.norm(own + random, axis=1, keepdims=True))
    return obj


@pytest.mark.parametrize("shading", ["flat", "smooth", "mixed", "custom"])
@pytest.mark.parametrize("mirrored", [False, True])
def test_corners_and_normals(blank, room, shading, mirrored):
    obj = suzanne(shading)
    if mirrored:
        obj.scale.x = -1.5
    surface = read_mirror(room, obj)
    of_vertices = shading == "mixed" and bpy.app.version < (5, 0, 0)
    corners, normals = plain_triangles(obj, of_vertices, of_vertices or shading == "flat")
    order = [0, 2, 1] if mirrored else [0, 1, 2]
    assert np.allclose(surface.mesh.positions[surface.mesh.triangles], corners[:, order], atol=2e-6)
    assert np.allclose(surface.mesh.corner_normals, normals[:, order], atol=2e-6)
    # faces and shading look to the same side
    agreement = np.einsum("ij,ij->i", surface.mesh.face_normals(), surface.mesh.corner_normals.mean(axis=1))
    assert (agreement > 0.0).mean() > 0.95


def shading_normals_in_cycles(picture) -> np.ndarray:
    """Render the open scene in a material that emits 2 + normal; (height, width, 3), zero where nothing is seen."""
    made = parts.material("Normals")
    nodes, links = made.node_tree.nodes, made.node_tree.links
    shift = nodes.new("ShaderNodeVectorMath")
    shift.inputs[1].default_value = 2.0, 2.0, 2.0
    links.new(nodes.new("ShaderNodeNewGeometry").outputs["Normal"], shift.inputs[0])
    links.new(shift.outputs["Vector"], next(node for node in nodes if node.type == "EMISSION").inputs["Color"])
    scene = bpy.context.scene
    for obj in scene.objects:
        if obj.type == "MESH":
            obj.data.materials.append(made)
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.samples, cycles.pixel_filter_type, cycles.filter_width, cycles.use_denoising = 1, "BOX", 0.01, False
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.filepath = str(picture)
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(str(picture))
    image.colorspace_settings.name = "Non-Color"
    pixels = np.array(image.pixels[:]).reshape(image.size[1], image.size[0], -1)[..., :3]
    return np.where(pixels.any(axis=2, keepdims=True), pixels - 2.0, 0.0)


@pytest.mark.parametrize("sharp_edge", [False, True])
def test_smooth_beside_flat_is_shaded_as_in_cycles(blank, room, tmp_path, sharp_edge):
    """A ridge of a flat and a smooth face, seen from above: normals just right and left of the ridge."""
    ridge = parts.add("grid", "Ridge", size=2.0, x_subdivisions=2, y_subdivisions=1)
    mesh = ridge.data
    for vertex in mesh.vertices:
        vertex.co.z = -0.5 * abs(vertex.co.x)
    mesh.polygons.foreach_set("use_smooth", [polygon.center.x > 0.0 for polygon in mesh.polygons])
    if sharp_edge:
        mesh.attributes.new("sharp_edge", "BOOLEAN", "EDGE").data[0].value = True
    mesh.update()
    scene = bpy.context.scene
    scene.camera.data.type, scene.camera.data.ortho_scale = "ORTHO", 2.0
    scene.camera.location, scene.camera.rotation_euler = (0.0, 0.0, 4.0), (0.0, 0.0, 0.0)
    scene.render.resolution_x = scene.render.resolution_y = 128
    surface = read_mirror(room, ridge).mesh
    shown = shading_normals_in_cycles(tmp_path / "normals.exr")[64, [63, 64]]
    middle = surface.positions[surface.triangles].mean(axis=1)[:, 0]
    at_ridge = np.abs(surface.positions[surface.triangles][..., 0]) < 1e-6
    for side, normal in ((middle < 0.0, shown[0]), (middle > 0.0, shown[1])):
        read = surface.corner_normals[side][at_ridge[side]]
        # a half pixel from the ridge the normal has turned by a 128th of the way
        assert np.linalg.norm(read - normal / np.linalg.norm(normal), axis=1).max() < 0.02


@pytest.mark.parametrize("beside", ["nothing", "a smooth face", "a sharp edge"])
def test_bent_faces_are_shaded_as_in_cycles(blank, room, tmp_path, beside):
    """A flat quad with a corner that is raised, seen from above: the normals of its two triangles."""
    quad = bpy.data.meshes.new("Bent")
    quad.from_pydata([(-1, -1, 0), (1, -1, 0), (1, 1, 0.7), (-1, 1, 0), (5, 5, 0), (6, 5, 1), (6, 6, 0)], [],
                     [(0, 1, 2, 3), (4, 5, 6)])
    quad.polygons.foreach_set("use_smooth", [False, beside != "nothing"])
    if beside == "a sharp edge":
        quad.attributes.new("sharp_edge", "BOOLEAN", "EDGE").data[0].value = True
    bent = bpy.data.objects.new("Bent", quad)
    scene = blank.scene
    scene.collection.objects.link(bent)
    scene.camera.data.type, scene.camera.data.ortho_scale = "ORTHO", 2.0
    scene.camera.location, scene.camera.rotation_euler = (0.0, 0.0, 4.0), (0.0, 0.0, 0.0)
    scene.render.resolution_x = scene.render.resolution_y = 128
    surface = read_mirror(room, bent).mesh
    shown = shading_normals_in_cycles(tmp_path / "normals.exr")
    middle = surface.positions[surface.triangles].mean(axis=1)
    for index in np.flatnonzero(np.abs(middle).max(axis=1) < 2.0):
        column, row = ((middle[index, :2] + 1.0) * 64.0).astype(int)
        assert np.abs(surface.corner_normals[index] - shown[row, column]).max() < 1e-3


def test_modifiers_are_applied(blank, room):
    cube = parts.add("cube", "Box", size=2.0)
    cube.modifiers.new("Subdivision", "SUBSURF").levels = 2
    array = cube.modifiers.new("Array", "ARRAY")
    array.count, array.use_relative_offset, array.use_constant_offset = 2, False, True
    array.constant_offset_displace = 5.0, 0.0, 0.0
    mesh = read_scene(room, cube).mesh
    assert len(mesh.triangles) == 2 * 6 * 16 * 2
    assert mesh.positions[:, 0].max() > 5.0 and mesh.positions[:, 0].min() > -1.0


def test_triangle_numbers_are_blenders(blank, room):
    """Quads, triangles and polygons with more corners, two objects: faces are counted within each object."""
    cone = parts.add("cone", "Cone", vertices=5, end_fill_type="NGON")
    sphere = parts.add("uv_sphere", "Ball", segments=6, ring_count=4, location=(5.0, 0.0, 0.0))
    scene = read_scene(room, cone, sphere)
    for index, obj in enumerate((cone, sphere)):
        own = np.flatnonzero(scene.source_object == index)
        corners = plain_triangles(obj)[0]
        assert sorted(scene.source_face[own]) == list(range(len(corners)))
        found = scene.mesh.positions[scene.mesh.triangles[own]]
        assert np.allclose(found, corners[scene.source_face[own]], atol=1e-6)


def test_instances_belong_to_their_instancer(blank, room):
    """A collection with a cube and a turned-over triangle, instanced twice, once through a negative scale."""
    cube = parts.add("cube", "Box", size=1.0)
    leaf = parts.add_triangle("Leaf", [(0, 0, 2), (1, 0, 2), (0, 1, 3)])
    kit = bpy.data.collections.new("Kit")
    for obj in (cube, leaf):
        kit.objects.link(obj)
        bpy.context.scene.collection.objects.unlink(obj)
    empties = []
    for matrix in (Matrix.Translation((10.0, 0.0, 0.0)), Matrix.Diagonal((-2.0, 1.0, 1.0, 1.0))):
        empty = bpy.data.objects.new("Instance", None)
        empty.instance_type, empty.instance_collection = "COLLECTION", kit
        empty.matrix_world = matrix
        bpy.context.scene.collection.objects.link(empty)
        empties.append(empty)
    scene = read_scene(room, *empties)
    assert len(scene.mesh.triangles) == 2 * 13
    for index, empty in enumerate(empties):
        own = scene.source_object == index
        assert sorted(scene.source_face[own]) == list(range(13))
        expected = np.array([empty.matrix_world @ vertex.co for vertex in leaf.data.vertices])
        corners = scene.mesh.positions[scene.mesh.triangles[own]]
        leaf_seen = corners[corners[:, :, 2].min(axis=1) > 1.0]
        order = [0, 1, 2] if index == 0 else [0, 2, 1]
        assert np.allclose(leaf_seen[0], expected[order], atol=1e-6)
    uv = scene.uv_maps["UVMap"][scene.mesh.positions[scene.mesh.triangles][:, :, 2].min(axis=1) > 1.0]
    assert np.allclose(uv[0], [(0, 0), (1, 0), (0, 1)]) and np.allclose(uv[1], [(0, 0), (0, 1), (1, 0)])


def test_vertex_instances(blank, room):
    cube = parts.add("cube", "Box", size=0.5)
    plane = parts.add("plane", "Field", size=6.0)
    cube.parent = plane
    plane.instance_type = "VERTS"
    plane.show_instancer_for_viewport = plane.show_instancer_for_render = False
    scene = read_scene(room, plane)
    assert len(scene.mesh.triangles) == 4 * 12
    centres = scene.mesh.positions.reshape(4, 8, 3).mean(axis=1)
    assert np.allclose(np.abs(centres[:, :2]), 3.0, atol=1e-6)


@pytest.mark.parametrize("add", ["text", "metaball", "curve", "surface"])
@pytest.mark.parametrize("mirror", [False, True])
def test_other_kinds_of_surface(blank, room, add, mirror):
    """Once, as Blender's own conversion makes them a mesh: they come as themselves and as instances of their meshes."""
    if add == "text":
        bpy.ops.object.text_add()
        bpy.context.object.data.extrude = 0.1
    elif add == "metaball":
        bpy.ops.object.metaball_add(type="BALL")
    elif add == "surface":
        bpy.ops.surface.primitive_nurbs_surface_sphere_add()
    else:
        bpy.ops.curve.primitive_bezier_circle_add()
        bpy.context.object.data.bevel_depth = 0.2
    obj = bpy.context.object
    obj.location = 0.0, 0.0, 7.0
    depsgraph = blank.evaluated_depsgraph_get()
    expected = bpy.data.meshes.new_from_object(obj.evaluated_get(depsgraph), depsgraph=depsgraph)
    expected.calc_loop_triangles()
    mesh = room("addon.reading").read_mirror(depsgraph, obj).mesh if mirror else read_scene(room, obj).mesh
    assert len(mesh.triangles) == len(expected.loop_triangles) > 10
    places = np.array([vertex.co for vertex in expected.vertices]) + (0.0, 0.0, 7.0)
    assert np.allclose(mesh.positions, places, atol=1e-5)


def test_materials_follow_the_object(blank, room):
    """A slot that is linked to the object hides the mesh's own material."""
    first = parts.add("cube", "First")
    first.data.materials.append(parts.material("Shared"))
    second = bpy.data.objects.new("Second", first.data)
    bpy.context.scene.collection.objects.link(second)
    second.material_slots[0].link = "OBJECT"
    second.material_slots[0].material = parts.material("Own")
    scene = read_scene(room, first, second)
    names = np.array([material.name for material in scene.materials])
    assert (names[scene.material] == np.where(scene.source_object == 0, "Shared", "Own")).all()


def test_layers_of_several_objects(blank, room):
    """An object without the active UV map shows its own active one; one that has none, zeros."""
    first = parts.add_triangle("First", [(0, 0, 0), (1, 0, 0), (0, 1, 0)])
    second = parts.add_triangle("Second", [(0, 0, 1), (1, 0, 1), (0, 1, 1)], uv=((5, 5), (6, 5), (5, 6)))
    second.data.uv_layers[0].name = "Other"
    third = parts.add_triangle("Third", [(0, 0, 2), (1, 0, 2), (0, 1, 2)])
    third.data.uv_layers.remove(third.data.uv_layers[0])
    third.data.update()
    scene = read_scene(room, first, second, third)
    assert scene.active_uv == "UVMap" and set(scene.uv_maps) == {"UVMap", "Other"}
    order = np.argsort(scene.source_object)
    assert np.allclose(scene.uv_maps["UVMap"][order[1]], [(5, 5), (6, 5), (5, 6)])
    assert np.allclose(scene.uv_maps["UVMap"][order[2]], 0.0)
    assert np.allclose(scene.uv_maps["Other"][order[0]], 0.0)


def test_the_active_layers_are_each_objects_own(blank, room):
    """Also where it has one of the name that is active on another: materials may ask for either."""
    first = parts.add_triangle("First", [(0, 0, 0), (1, 0, 0), (0, 1, 0)])
    second = parts.add_triangle("Second", [(0, 0, 1), (1, 0, 1), (0, 1, 1)], uv=((5, 5), (6, 5), (5, 6)))
    baked = second.data.uv_layers.new(name="Baked")
    baked.uv.foreach_set("vector", np.array([8, 8, 9, 8, 8, 9], dtype=np.float32))
    baked.active_render = True
    for triangle, names in ((first, "A"), (second, "AB")):
        for value, name in enumerate(names, 1):
            shade = triangle.data.color_attributes.new(name, "FLOAT_COLOR", "POINT")
            shade.data.foreach_set("color", np.full(12, 0.1 * value, dtype=np.float32))
        triangle.data.color_attributes.render_color_index = len(names) - 1
    scene = read_scene(room, first, second)
    one, other = np.argsort(scene.source_object)
    assert np.allclose(scene.uv_maps[scene.active_uv][one], [(0, 0), (1, 0), (0, 1)])
    assert np.allclose(scene.uv_maps[scene.active_uv][other], [(8, 8), (9, 8), (8, 9)])
    assert np.allclose(scene.uv_maps["UVMap"][other], [(5, 5), (6, 5), (5, 6)])
    shown, named = scene.colours[scene.active_colour][1], scene.colours["A"][1]
    assert np.allclose(shown[one], 0.1) and np.allclose(shown[other], 0.2) and np.allclose(named[other], 0.1)


def test_a_scale_of_zero_keeps_its_normals(blank, room):
    plane = parts.add("plane", "Flat")
    plane.scale.z = 0.0
    surface = read_mirror(room, plane)
    assert np.allclose(surface.mesh.corner_normals, (0.0, 0.0, 1.0))
