"""Lines of reflections: what Line Art and Freestyle draw, against where edges must be seen; sides and normals."""
import bpy
import numpy as np
import parts
import pytest
from drawn_lines import (
    BESIDE,
    INNER,
    add_line_art,
    add_mirror,
    apart,
    cube_edges,
    dense,
    line_art,
    meeting,
    off_lines,
    pixels,
    seen_at,
    smooth,
)
from mathutils import Vector
from mathutils.bvhtree import BVHTree
from mathutils.interpolate import poly_3d_calc


@pytest.fixture
def cube(blank):
    """A cube whose image the mirrors show beside it, in a picture of 512 x 384."""
    blank.scene.render.resolution_x, blank.scene.render.resolution_y = 512, 384
    box = parts.add("cube", "Box", size=1.0, location=BESIDE, rotation=(0.3, 0.2, 0.9))
    box.data.materials.append(parts.material("Plain"))
    return box


@pytest.mark.feature("lines")
@pytest.mark.parametrize("kind, placement", [("wall", "LAYERED"), ("wall", "VIRTUAL"), ("ball", "LAYERED")])
def test_line_art_draws_the_visible_edges_of_a_cube_and_nothing_else(cube, kind, placement):
    mirror = add_mirror(kind)
    parts.select(cube, mirror)
    result = parts.generate(placement=placement)
    if placement == "VIRTUAL":
        mirror.lineart.usage = "EXCLUDE"  # Line Art asks no camera what it sees
    strokes = line_art(result)
    expected, seen = cube_edges(cube, kind)
    assert len(seen) in (7, 9)
    assert off_lines(np.concatenate(expected), strokes).max() < 1.5
    assert off_lines(dense(strokes), expected).max() < 1.5


@pytest.mark.thorough
@pytest.mark.parametrize("kind, placement", [("wall", "LAYERED"), ("wall", "VIRTUAL"), ("ball", "LAYERED")])
def test_where_objects_pass_through_each_other_line_art_draws_that_if_it_may(cube, kind, placement):
    """All of it and nothing else, once the user lets the result have intersections; faces by rays end there, so that it
    is among their contours."""
    place = np.array(BESIDE) + (-0.45, -0.1, 0.35)
    other = parts.add("cube", "Other", size=0.8, location=place, rotation=(0.1, 0.5, 0.3))
    other.data.materials.append(cube.active_material)
    mirror = add_mirror(kind)
    parts.select(cube, other, mirror)
    result = parts.generate(placement=placement)
    if placement == "VIRTUAL":
        mirror.lineart.usage = "EXCLUDE"
    expected = meeting(cube, other, kind)
    assert len(expected) > 500 and not line_art(result, "intersection")
    if kind == "ball":
        assert (off_lines(expected, line_art(result, "contour")) < 1.0).all()
        return
    result.lineart.usage = "INHERIT"
    strokes = line_art(result, "intersection")
    assert (off_lines(expected, strokes) < 1.0).all()
    assert max(np.linalg.norm(expected - point, axis=1).min() for point in dense(strokes)) < 1.0


def test_a_floor_has_no_lines_but_its_outline(blank):
    """Straight before the camera the rows of a ball's triangles and the floor's middle agree to the last digits, and
    leave slivers, which rounding to single precision turns over or flattens."""
    camera = blank.scene.camera
    camera.location, camera.rotation_euler, camera.data.lens = (0.0, -7.5, 2.6), (1.36, 0.0, 0.0), 42.0
    blank.scene.render.resolution_x = blank.scene.render.resolution_y = 900
    floor = parts.add("plane", "Floor", size=14.0, location=(0.0, 0.0, 0.0))
    ball = parts.add("uv_sphere", "Mirror", radius=1.6, segments=96, ring_count=48, location=(0.0, 0.0, 1.6))
    ring = parts.add("torus", "Ring", major_radius=0.6, minor_radius=0.2, major_segments=96, minor_segments=48,
                     location=(0.6, -3.0, 0.22))
    smooth(ball)
    smooth(ring)
    parts.select(floor, ring, ball)
    result = parts.generate()
    places = parts.attribute(result, "position")[parts.corners(result)][parts.attribute(result, "source_object") == 0]
    a, b, c = np.moveaxis(places, 1, 0)
    eye = np.array(blank.scene.camera.location) - np.array(result.location)
    assert len(places) > 3000
    assert ((np.cross(a - b, b - c) * (eye - a)).sum(axis=1) > 0.0).all()
    assert line_art(result, "crease", "intersection", "edge_mark") == []


def shows_floor(mirror: bpy.types.Object, spots: np.ndarray) -> np.ndarray:
    """Whether a mirror shows, at spots (n, 2) of the picture, a floor of 14 x 14 at a height of 0: by rays."""
    depsgraph, scene = bpy.context.evaluated_depsgraph_get(), bpy.context.scene
    mesh, turn = mirror.data, np.array(mirror.matrix_world)[:3, :3]
    mesh.calc_loop_triangles()
    faces = [[(mesh.vertices[vertex].co, mesh.vertices[vertex].normal) for vertex in face.vertices]
             for face in mesh.loop_triangles]
    tree = BVHTree.FromPolygons([corner for face in faces for corner, _ in face],
                                np.arange(3 * len(faces)).reshape(-1, 3).tolist())
    into, eye = mirror.matrix_world.inverted(), scene.camera.matrix_world.translation
    size = (scene.render.resolution_x, scene.render.resolution_y)
    back = (scene.camera.calc_matrix_camera(depsgraph, x=size[0], y=size[1])
            @ scene.camera.matrix_world.inverted()).inverted()
    found = []
    for spot in spots:
        ahead = back @ Vector((*(2.0 * spot / size - 1.0), 1.0, 1.0))
        way = (ahead.xyz / ahead.w - eye).normalized()
        place, _, face, _ = tree.ray_cast(into @ eye, into.to_3x3() @ way)
        if place is None:
            found.append(False)
            continue
        weights = poly_3d_calc([corner for corner, _ in faces[face]], place)
        normal = Vector(turn @ sum(weight * np.array(own) for weight, (_, own) in zip(weights, faces[face])))
        on = way.reflect(normal.normalized())
        again = tree.ray_cast(place + 1e-4 * (into.to_3x3() @ on), into.to_3x3() @ on)[0]
        start = mirror.matrix_world @ place
        down = start - (start.z / on.z) * on if on.z < 0.0 else Vector((np.inf, 0.0, 0.0))
        found.append(again is None and max(abs(down.x), abs(down.y)) < 7.0)
    return np.array(found)


@pytest.mark.thorough
@pytest.mark.parametrize("kind, options", [
    ("uv_sphere", {"radius": 2.2, "segments": 24, "ring_count": 12, "location": (0.07, 0.6, 2.2)}),
    ("torus", {"major_radius": 1.6, "minor_radius": 0.7, "major_segments": 96, "minor_segments": 48,
               "location": (0.0, 0.6, 2.3), "rotation": (1.3, 0.0, 0.0)})])
def test_within_a_floor_there_are_no_lines(blank, kind, options):
    """Of a coarse ball, parts of the mirror that show the floor whole and parts that are cut have borders of their own,
    and so have cells that rays show in a ring."""
    camera = blank.scene.camera
    camera.location, camera.rotation_euler, camera.data.lens = (0.0, -9.0, 4.4), (1.26, 0.0, 0.0), 54.0
    blank.scene.render.resolution_x = blank.scene.render.resolution_y = 400
    floor, mirror = parts.add("plane", "Floor", size=14.0), parts.add(kind, "Mirror", **options)
    smooth(mirror)
    add_line_art(mirror)
    parts.select(floor, mirror)
    points = dense(line_art(parts.generate()))
    beside = np.array([[x, y] for x in (-2.5, 0.0, 2.5) for y in (-2.5, 0.0, 2.5) if x or y])
    within = shows_floor(mirror, (points[::4, None] + beside).reshape(-1, 2)).reshape(-1, len(beside)).all(axis=1)
    assert len(within) > 500 and within.mean() < 0.01


def test_line_art_draws_the_silhouette_of_a_ball(blank):
    ball = parts.add("uv_sphere", "Ball", radius=0.6, segments=96, ring_count=48, location=(2.0, -2.5, 1.2))
    smooth(ball)
    parts.select(ball, parts.add_wall_mirror())
    strokes = line_art(parts.generate())
    eye, middle = np.array(blank.scene.camera.location), np.array((2.0, 4.5, 1.2))
    away = middle - eye
    distance = np.linalg.norm(away)
    across = np.linalg.svd(away[None])[2][1:]
    turn = np.linspace(0.0, 2.0 * np.pi, 200)[:, None]
    # the circle where rays from the eye touch the mirrored ball
    rim = (middle - 0.6**2 / distance**2 * away
           + 0.6 * np.sqrt(1.0 - 0.6**2 / distance**2) * (np.cos(turn) * across[0] + np.sin(turn) * across[1]))
    assert off_lines(pixels(rim), strokes).max() < 1.0
    assert off_lines(dense(strokes), [pixels(rim)]).max() < 1.0


def grid(chosen: int | None) -> tuple:
    """A sheet of 2 x 2 faces in a wall, with the `chosen` edge marked for Freestyle, `INNER` for one that its
    middle ends: the result, and the edge's ends."""
    sheet = parts.add("grid", "Sheet", x_subdivisions=2, y_subdivisions=2, size=1.6, location=BESIDE,
                      rotation=(1.2, 0.1, 0.9))
    inner = [edge.index for edge in sheet.data.edges if any(
        np.allclose(sheet.data.vertices[vertex].co, 0.0) for vertex in edge.vertices)]
    edge = sheet.data.edges[inner[0] if chosen in (None, INNER) else chosen]
    if chosen is not None and bpy.app.version < (5, 0, 0):
        edge.use_freestyle_mark = True
    elif chosen is not None:
        sheet.data.attributes.new("freestyle_edge", "BOOLEAN", "EDGE").data[edge.index].value = True
    parts.select(sheet, parts.add_wall_mirror())
    return parts.generate(), np.array([sheet.matrix_world @ sheet.data.vertices[vertex].co for vertex in edge.vertices])


def test_marked_edges_are_drawn_and_no_others(blank):
    result, ends = grid(INNER)
    line, strokes = pixels(seen_at("wall", ends)), line_art(result, "edge_mark")
    assert off_lines(dense([line]), strokes).max() < 1.0 and off_lines(dense(strokes), [line]).max() < 1.0
    result, _ = grid(None)
    assert line_art(result, "edge_mark", "crease") == []


@pytest.mark.parametrize("chosen", [INNER, -1])
def test_marks_lie_on_the_marked_edge(blank, room, chosen):
    """Be it the last one, whose number stands for sides that are no edges too; and on the sheet's outline."""
    result, ends = grid(chosen)
    marks = room("addon.compat").freestyle_marks(result.data, "EDGE")
    vertices = np.array([edge.vertices[:] for edge in result.data.edges])
    points = parts.attribute(result, "reflected_position")
    share = ((points - ends[0]) @ (ends[1] - ends[0])) / ((ends[1] - ends[0]) @ (ends[1] - ends[0]))
    away = np.linalg.norm(points - ends[0] - np.clip(share, 0.0, 1.0)[:, None] * (ends[1] - ends[0]), axis=1)
    sheet = result.reflection_mesh.sources[0].object
    local = np.column_stack((points, np.ones(len(points)))) @ np.array(sheet.matrix_world.inverted()).T
    outer = [(np.abs(local[vertices][:, :, axis] - side) < 1e-5).all(axis=1) for axis in (0, 1) for side in (-0.8, 0.8)]
    expected = (away[vertices].max(axis=1) < 1e-5) | np.any(outer, axis=0)
    assert (marks == expected).all() and 0 < np.any(outer, axis=0).sum() < len(marks)


@pytest.mark.thorough
def test_line_art_takes_creases_from_sharp_edges(cube):
    """Edges of a cube on both sides of which its surface is seen; at the others there are contours."""
    parts.select(cube, add_mirror("ball"))
    result = parts.generate()
    strokes, contours = line_art(result, "crease"), line_art(result, "contour")
    expected, _ = cube_edges(cube, "ball")
    assert len(strokes) and off_lines(dense(strokes), expected).max() < 1.5
    inner = [edge for edge in expected if off_lines(edge, contours).max() > 1.5]
    assert inner and all(off_lines(edge, strokes).max() < 1.5 for edge in inner)
    assert off_lines(np.concatenate(expected), strokes + contours).max() < 1.5


@pytest.mark.parametrize("angle, sharp", [(30.0, False), (50.0, True)])
def test_an_edge_is_a_crease_from_forty_degrees_on(blank, angle, sharp):
    """Of a roof, also where a scale bends it; an edge marked as sharp always is."""
    rise = np.tan(np.radians(0.5 * angle))
    roof = bpy.data.meshes.new("Roof")
    roof.from_pydata([(-1, -1, 0), (0, -1, 1), (1, -1, 0), (-1, 1, 0), (0, 1, 1), (1, 1, 0)], [],
                     [(0, 1, 4, 3), (1, 2, 5, 4)])
    obj = bpy.data.objects.new("Roof", roof)
    obj.location, obj.scale, obj.rotation_euler = BESIDE, (0.6, 0.6, 0.6 * rise), (-1.2, 0.3, 0.4)
    blank.scene.collection.objects.link(obj)
    blank.view_layer.update()
    mirror = parts.add_wall_mirror()
    parts.select(obj, mirror)
    assert bool(line_art(parts.generate(), "crease")) == sharp
    edges = roof.attributes.new("sharp_edge", "BOOLEAN", "EDGE")
    edges.data.foreach_set("value", np.ones(len(roof.edges), dtype=bool))
    roof.update()
    parts.select(obj, mirror)
    assert line_art(parts.generate(), "crease")


def freestyle(result: bpy.types.Object, tmp_path) -> np.ndarray:
    """Where Freestyle draws marked edges of the result alone, in a render: places (n, 2) in pixels."""
    scene, layer = bpy.context.scene, bpy.context.view_layer
    for obj in scene.objects:
        obj.hide_render = obj.type == "MESH" and obj != result
    scene.render.engine, scene.cycles.samples, scene.render.film_transparent = "CYCLES", 1, True
    scene.render.use_freestyle = layer.use_freestyle = True
    lines = layer.freestyle_settings.linesets.new("Lines")
    for name in ("silhouette", "border", "crease"):
        setattr(lines, f"select_{name}", False)
    lines.select_edge_mark = True
    lines.linestyle = lines.linestyle or bpy.data.linestyles.new("Lines")
    lines.linestyle.color, lines.linestyle.thickness = (1.0, 0.0, 0.0), 2.0
    scene.view_settings.view_transform = "Standard"
    scene.render.filepath = str(tmp_path / "lines.png")
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(scene.render.filepath)
    shown = np.array(image.pixels[:]).reshape(image.size[1], image.size[0], 4)
    row, column = np.nonzero((shown[..., 0] > 0.6) & (shown[..., 1] < 0.4) & (shown[..., 3] > 0.6))
    return np.column_stack((column, row)) + 0.5


@pytest.mark.thorough
def test_freestyle_draws_the_edges_of_a_cube(cube, tmp_path):
    parts.select(cube, add_mirror("ball"))
    drawn = freestyle(parts.generate(), tmp_path)
    expected, _ = cube_edges(cube, "ball")
    assert off_lines(drawn, expected).max() < 3.0
    lit = np.linalg.norm(np.concatenate(expected)[:, None] - drawn, axis=2).min(axis=1)
    assert (lit < 3.0).mean() > 0.98


def two_sided() -> bpy.types.Material:
    """Red light from fronts, blue from backs."""
    made = parts.material("Sides")
    tree = made.node_tree
    emission = next(node for node in tree.nodes if node.type == "EMISSION")
    side, mixed = tree.nodes.new("ShaderNodeNewGeometry"), tree.nodes.new("ShaderNodeMix")
    mixed.data_type = "RGBA"
    mixed.inputs[6].default_value, mixed.inputs[7].default_value = (1.0, 0.0, 0.0, 1.0), (0.0, 0.0, 1.0, 1.0)
    tree.links.new(side.outputs["Backfacing"], mixed.inputs[0])
    tree.links.new(mixed.outputs[2], emission.inputs[0])
    return made


def rendered(tmp_path) -> np.ndarray:
    scene = bpy.context.scene
    scene.render.engine, scene.cycles.samples, scene.cycles.use_denoising = "CYCLES", 16, False
    scene.view_settings.view_transform = "Raw"
    scene.render.filepath = str(tmp_path / "picture.png")
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(scene.render.filepath)
    shown = np.array(image.pixels[:]).reshape(-1, 4)
    bpy.data.images.remove(image)
    return shown


@pytest.mark.thorough
@pytest.mark.parametrize("kind, depth, placement", [
    ("wall", 1, "LAYERED"), ("wall", 2, "VIRTUAL"), *(pytest.param(*case, marks=pytest.mark.slow) for case in (
        ("wall", 1, "VIRTUAL"), ("ball", 1, "LAYERED"), ("wall", 2, "LAYERED")))])
def test_fronts_and_backs_are_those_that_cycles_sees_in_the_mirror(blank, tmp_path, kind, depth, placement):
    """An open tube, turned inside out by a negative scale."""
    blank.scene.render.resolution_x, blank.scene.render.resolution_y = 512, 384
    tube = parts.add("cylinder", "Tube", radius=0.6, depth=1.0, end_fill_type="NOTHING", location=BESIDE,
                     rotation=(0.9, 0.4, 0.3), scale=(1.0, 1.0, -1.2))
    tube.data.materials.append(two_sided())
    mirrors = [add_mirror(kind)]
    if depth == 2:
        mirrors[0].scale.x = 2.0
        mirrors.append(parts.add("plane", "Side", size=4.0, location=(3.6, -1.0, 1.0), rotation=(np.pi / 2, 0.0, -1.4)))
        blank.scene.cycles.max_bounces = 8
    for mirror in mirrors:
        mirror.data.materials.append(parts.material("Silver", "GLOSSY"))
        next(node for node in mirror.data.materials[0].node_tree.nodes if node.type == "BSDF_GLOSSY").inputs[
            "Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    blank.view_layer.update()
    truth = rendered(tmp_path)
    parts.select(tube, *mirrors)
    parts.generate(depth=depth, placement=placement)
    tube.visible_glossy = False  # what is seen is the result
    shown = rendered(tmp_path)
    red, blue = (truth[:, channel] > 0.99 for channel in (0, 2))
    assert red.sum() > 50 and blue.sum() > 50
    wrong = (red & (shown[:, 2] > 0.5)) | (blue & (shown[:, 0] > 0.5))
    right = (red & (shown[:, 0] > 0.5)) | (blue & (shown[:, 2] > 0.5))
    assert wrong.sum() <= 0.005 * right.sum() and right.sum() > 0.98 * (red | blue).sum()


@pytest.mark.skipif(bpy.app.version < (4, 5, 0), reason="meshes know no free normals yet")
def test_normals_are_those_of_the_sources_mirrored(blank):
    ball = parts.add("uv_sphere", "Ball", radius=0.6, segments=24, ring_count=12, location=BESIDE,
                     scale=(1.0, 0.5, 1.0))
    smooth(ball)
    box = parts.add("cube", "Box", size=0.6, location=(1.6, -2.0, 1.4), rotation=(0.3, 0.2, 0.5))
    parts.select(ball, box, parts.add_wall_mirror())
    result = parts.generate()
    mesh = result.data
    shown = np.empty((len(mesh.loops), 3), dtype=np.float32)
    mesh.corner_normals.foreach_get("vector", shown.reshape(-1))
    points, owner = parts.attribute(result, "reflected_position")[parts.corners(result)], parts.attribute(
        result, "source_object")
    shown = shown.reshape(-1, 3, 3)
    # Blender's own vertex normals of the ball at its vertices, the box's flat ones everywhere
    for number, source in enumerate((ball, box)):
        matrix = np.array(source.matrix_world)
        turn = np.linalg.inv(matrix[:3, :3])
        positions = np.array([vertex.co[:] for vertex in source.data.vertices]) @ matrix[:3, :3].T + matrix[:3, 3]
        assert (owner == number).sum() > 12
        if source == ball:
            normals = np.array([vertex.normal[:] for vertex in source.data.vertices]) @ turn
            near = np.linalg.norm(points[owner == 0][:, :, None] - positions, axis=3)
            corner = near.min(axis=2) < 1e-5
            expected = normals[near.argmin(axis=2)][corner]
            given = shown[owner == 0][corner]
            assert corner.sum() > 100
        else:
            local = (points[owner == 1].mean(axis=1) - matrix[:3, 3]) @ turn.T
            axis = np.abs(local).argmax(axis=1)
            normals = np.zeros((len(axis), 3))
            normals[np.arange(len(axis)), axis] = np.sign(local[np.arange(len(axis)), axis])
            expected, given = np.repeat(normals @ turn, 3, axis=0), shown[owner == 1].reshape(-1, 3)
        expected = expected / np.linalg.norm(expected, axis=1, keepdims=True) * (1.0, -1.0, 1.0)
        assert np.abs(given - expected).max() < 1e-4


def test_smooth_and_sharp_faces_stay_so(blank):
    ball = parts.add("uv_sphere", "Ball", radius=0.6, segments=24, ring_count=12, location=BESIDE)
    smooth(ball)
    box = parts.add("cube", "Box", size=0.6, location=(1.6, -2.0, 1.4))
    parts.select(ball, box, parts.add_wall_mirror())
    result = parts.generate()
    shown = np.empty(len(result.data.polygons), dtype=bool)
    result.data.polygons.foreach_get("use_smooth", shown)
    assert (shown == (parts.attribute(result, "source_object") == 0)).all() and 0 < shown.sum() < len(shown)


def test_light_leaves_the_lines(cube):
    mirror = add_mirror("wall")
    mirror.data.materials.append(parts.material("Silver", "PRINCIPLED"))
    bpy.ops.object.light_add(type="POINT", location=(0.0, -3.0, 3.0))
    parts.select(cube, mirror)
    outline = line_art(mirror, "contour")
    result = parts.generate()
    before = line_art(result)
    parts.select(result)
    assert bpy.ops.reflection_mesh.light("EXEC_DEFAULT", samples=1) == {"FINISHED"}
    assert result.reflection_mesh.light_material is not None
    after = line_art(result)
    assert sum(map(len, before)) > 9
    assert apart(before, after) < 1e-3
    # faces that show the world add the outline of the mirror, and end a little outside the picture
    inside = [stroke[(stroke[:, 1] < 384.0)] for stroke in after]
    assert apart(inside, [*before, *outline]) < 1.0
    assert not result.data.validate()


def test_what_the_user_sets_for_line_art_is_kept(cube):
    parts.select(cube, add_mirror("wall"))
    result = parts.generate()
    result.lineart.usage = "EXCLUDE"
    assert parts.generate() == result and result.lineart.usage == "EXCLUDE"
