"""Light that stays with the objects is baked where mirrors can show it, and as finely as they do; gloss too, as it is
seen in curved mirrors."""
from __future__ import annotations

import tracemalloc

import bpy
import numpy as np
import parts
import pytest
from lamp_scenes import SIZE, picture, principled, psnr, scene_of


def light(samples: int = 64) -> None:
    assert bpy.ops.reflection_mesh.light(samples=samples, kind="OBJECTS") == {"FINISHED"}


def ball_scene(context: bpy.types.Context, **floor) -> bpy.types.Object:
    """A ball that mirrors a wide floor and a lamp; returns the floor."""
    wall = scene_of(context)
    for obj in (wall, bpy.data.objects["Box"]):
        bpy.data.objects.remove(obj)
    ball = parts.add("uv_sphere", "Ball", radius=1.4, segments=48, ring_count=24, location=(0.0, 0.0, 0.9))
    ball.data.shade_smooth()
    ball.data.materials.append(principled("Silver", (1.0, 1.0, 1.0), Metallic=1.0, Roughness=0.0))
    ground = bpy.data.objects["Floor"]
    ground.data.materials[0] = principled("Ground", (0.5, 0.5, 0.6), **floor)
    ground.scale = (3.0, 3.0, 1.0)
    context.view_layer.update()
    parts.select(ground, ball)
    return ground


def baked_texels(monkeypatch, room) -> list:
    """How many texels each bake writes, from now on."""
    counted, scene = [], room("addon.baking.stage.bakes")
    bake = scene.BakeScene.bake

    def counts(self, *arguments, **named):
        values = yield from bake(self, *arguments, **named)
        counted.append(int((values[..., 3] != scene.UNTOUCHED).sum()))
        return values
    monkeypatch.setattr(scene.BakeScene, "bake", counts)
    return counted


@pytest.mark.slow
def test_what_is_seen_from_afar_is_baked_coarsely(blank, room, monkeypatch):
    """Of a floor under a ball, most of which the ball shows small."""
    ball_scene(blank)
    blank.scene.render.resolution_x = blank.scene.render.resolution_y = 2 * SIZE
    result = parts.generate()
    counted = baked_texels(monkeypatch, room)
    light(1)
    points = np.array([point.co[:2] for point in result.reflection_mesh.light_map.vertices])
    finest = points[-6:].reshape(2, 3, 2) * bpy.data.images["Reflection Light"].size
    (along, up), size = np.moveaxis(finest[:, 1:] - finest[:, :1], 1, 0), np.ptp(points, axis=0)
    whole = 0.5 * np.abs(along[:, 0] * up[:, 1] - along[:, 1] * up[:, 0]).sum()
    assert len(counted) == 3 and sum(counted) < 0.35 * whole
    # and most of the floor has no room where it is fine
    assert np.array(bpy.data.images["Reflection Light"].size).prod() < 0.6 * whole and size.max() > 1.0


@pytest.mark.slow
def test_of_small_triangles_those_are_baked_finely_that_are_seen_so(blank, room, monkeypatch):
    """Of a head before a hollow mirror, which shows a part of it, and that large: all of it was, for nine minutes."""
    wall = scene_of(blank)
    bpy.data.objects.remove(bpy.data.objects["Box"])
    ball = parts.add("ico_sphere", "Other", subdivisions=6, radius=0.8, location=(0.0, -3.0, 1.0))
    ball.data.materials.append(principled("Matte"))
    ball.visible_camera = False
    hollow = parts.add("grid", "Hollow", x_subdivisions=48, y_subdivisions=48, size=1.8)
    places = np.array([vertex.co for vertex in hollow.data.vertices])
    depth = (places[:, 0]**2 + places[:, 1]**2) / 10.0
    places = np.column_stack((places[:, 0], 1.0 - depth, 1.0 + places[:, 1]))
    hollow.data.vertices.foreach_set("co", places.astype(np.float32).ravel())
    hollow.data.shade_smooth()
    hollow.data.materials.append(wall.data.materials[0])
    bpy.data.objects.remove(wall)
    parts.select(ball, hollow)
    reference = picture(room)
    parts.generate()
    counted = baked_texels(monkeypatch, room)
    light(16)
    # measured: 40.5 dB
    assert psnr(picture(room), reference) > 38.2
    # 66,000, of which the ball's triangles take 40,000 at the least; 285,000 were all as fine as where it is largest
    assert sum(counted) < 100_000


def test_what_looks_away_from_all_mirrors_is_not_baked(blank, room, monkeypatch):
    """Of a ball before a flat mirror; one that is animated may see all of it."""
    wall = scene_of(blank)
    bpy.data.objects.remove(bpy.data.objects["Box"])
    ball = parts.add("ico_sphere", "Other", subdivisions=3, radius=0.5, location=(0.0, -4.0, 1.0))
    ball.data.materials.append(principled("Matte"))
    parts.select(ball, wall)
    parts.generate()
    counted = baked_texels(monkeypatch, room)
    light(1)
    wall.keyframe_insert("location", frame=1)
    light(1)
    still, moving = counted
    # the half of a ball that looks away, but for a margin: seen from 5 m a mirror 4 m wide takes its share too
    assert 0.5 * moving < still < 0.9 * moving


@pytest.mark.slow
def test_gloss_is_seen_as_a_ball_shows_it(blank, room):
    ball_scene(blank, Roughness=0.3)
    reference = picture(room)
    parts.generate()
    light(64)
    # measured: 41.0 dB
    assert psnr(picture(room), reference) > 38.5


@pytest.mark.thorough
@pytest.mark.parametrize(("floor", "told"), [({"Roughness": 0.2}, ["Floor"]), ({"Roughness": 0.8}, []),
                                             ({"Roughness": 0.8, "Metallic": 1.0}, ["Floor"])])
def test_where_gloss_is_as_from_elsewhere_that_is_said(blank, room, monkeypatch, capsys, floor, told):
    """As if the ball were so close to it that no one place sees it as the ball does."""
    ball_scene(blank, **floor)
    monkeypatch.setattr(room("addon.baking.seen_sources"), "ONE_EYE", 0.0)
    result = parts.generate()
    light(1)
    lighting = room("addon.lighting")
    assert lighting.dull_objects(result) == told
    assert lighting.light_sentence(result, False).startswith("Lit, with gloss" if told else "Lit.")
    assert ("The gloss of 'Floor' is not what so close a curved mirror shows" in capsys.readouterr().out) == bool(told)
    bpy.ops.reflection_mesh.light(samples=1, kind="PICTURE")
    assert lighting.light_sentence(result, False) == "Lit."


@pytest.mark.slow
def test_metal_close_to_a_curved_mirror_is_not_black(blank, room, monkeypatch):
    """Not even where no one place sees it as the mirror does."""
    ball_scene(blank, Metallic=1.0, Roughness=0.4)
    reference = picture(room)
    parts.generate()
    monkeypatch.setattr(room("addon.baking.seen_sources"), "ONE_EYE", 0.0)
    light(16)
    # measured: 35.0 dB
    assert psnr(picture(room), reference) > 32.5


def test_what_two_mirrors_show_is_seen_from_where_the_one_sees_it_that_shows_most_of_it(blank, room):
    """In closed form: the mirror image of the eye in that mirror, and no place between both."""
    wall = scene_of(blank)
    other = parts.add("plane", "Other Mirror", size=3.0, location=(-2.4, -1.5, 1.0), rotation=(np.pi / 2, 0.0, 1.2))
    other.data.materials.append(wall.data.materials[0])
    sources = [bpy.data.objects[name] for name in ("Box", "Floor")]
    parts.select(*sources, wall, other)
    parts.generate(tolerance=4.0)
    results = [obj for obj in blank.scene.objects if obj.reflection_mesh.role == "REFLECTION"]
    assert len(results) == 2
    reading = room("addon.reading")
    view = reading.read_view(blank)
    scene = reading.read_scene(blank.evaluated_depsgraph_get(), sources)
    seen = room("addon.baking.seen_sources").seen_sources(results, view, scene)
    # the wall mirror stands at y = 1
    assert np.allclose(seen.seen_from, np.array(view.eye) * (1.0, -1.0, 1.0) + (0.0, 2.0, 0.0), atol=0.3)
    assert seen.one_eye.all()


@pytest.mark.slow
def test_light_takes_the_bounces_that_are_left(blank, room):
    """The mirror is one of them: where no more are followed, what it shows has no light of its surroundings."""
    scene_of(blank)
    blank.scene.cycles.max_bounces = 1
    reference = picture(room)
    parts.generate()
    light(64)
    # measured: 54.3 dB
    assert psnr(picture(room), reference) > 51.0


def test_lines_of_sight_meet_where_they_come_from(room):
    """Those of one source through a place, exactly; of the other, all parallel, nowhere: where it was is kept."""
    rng = np.random.default_rng(2)
    places = np.array([[0.4, -1.0, 2.0], [50.0, 3.0, 1.0]])
    points = rng.normal(size=(200, 3))
    owner = np.arange(200) % 2
    towards = np.where(owner[:, None] == 0, points + 0.3 * (places[0] - points), points + (1.0, 0.0, 0.0))
    start = places + ((1.0, 1.0, 1.0), (0.0, 0.0, 0.0))
    found, angles = room("addon.baking.sight").places_of_sight(owner, rng.random(200), points, towards, start)
    assert np.abs(found[0] - places[0]).max() < 1e-3 and angles[0] < 1e-3
    assert np.isfinite(found[1]).all() and angles[1] < 0.1


def test_lines_of_sight_that_are_parallel_come_from_far_away(room):
    """Though they were looked for close by: a camera without perspective has no place."""
    rng = np.random.default_rng(6)
    points, way = rng.normal(size=(200, 3)), np.array([0.48, -0.64, 0.6])
    start = points[:1] + 0.1
    found, angles = room("addon.baking.sight").places_of_sight(np.zeros(200, int), np.ones(200), points, points + way,
                                                               start)
    aim = found[0] - points
    off = np.arccos(np.minimum(aim @ way / np.linalg.norm(aim, axis=1), 1.0))
    assert off.max() < 0.01 and abs(angles[0] - np.sqrt((off**2).mean())) < 1e-6


def test_parts_tile_their_triangles(room):
    """Against areas, and against every part of a brute force search."""
    division = room("addon.baking.texels.division").divided(np.array([1, 4, 2, 8]))
    sides = division.weights[:, 1:] - division.weights[:, :1]
    area = np.abs(np.linalg.det(sides[:, :, 1:]))
    assert np.allclose(np.bincount(division.owner, area), 1.0)
    assert np.allclose(area, 1.0 / division.count[division.owner]**2) and (np.diff(division.owner) >= 0).all()
    rng = np.random.default_rng(4)
    triangle, middle = rng.integers(0, 4, 60), rng.dirichlet((1.0, 1.0, 1.0), 60)
    small = middle[:, None] + 1e-6 * (np.eye(3) - 1.0 / 3.0)
    found = division.greatest(triangle, small, np.arange(1.0, 61.0))
    inverse = np.linalg.inv(np.swapaxes(division.weights, 1, 2))
    for number, (own, spot) in enumerate(zip(triangle, middle)):
        inside = (division.owner == own) & (inverse @ spot > 0.0).all(axis=1)
        assert inside.sum() == 1 and (found[inside] >= number + 1.0).all()
    # and neighbours, but nothing that lies farther off
    alone = division.greatest(np.array([3]), np.full((1, 3, 3), 1.0 / 3.0) + 1e-6 * np.eye(3), np.array([5.0])) > 0.0
    near = division.weights.mean(axis=1)[alone] - 1.0 / 3.0
    assert 4 < alone.sum() < 16 and np.abs(near).max() < 2.0 / 8.0 and (division.owner[alone] == 3).all()


def test_a_large_face_asks_for_all_that_it_shows(room):
    division = room("addon.baking.texels.division").divided(np.array([32]))
    whole = division.greatest(np.array([0]), np.eye(3)[None], np.array([2.0]))
    assert (whole == 2.0).all()


def test_a_finer_picture_takes_what_it_lacks_from_the_coarser(room):
    """Exactly, where light is linear on a triangle."""
    module = room("addon.baking.texels.division")
    small, large = np.full((16, 16, 4), np.nan, np.float32), np.zeros((48, 48, 4), np.float32)
    rows, columns = np.mgrid[:16, :16] + 0.5
    small[...] = (0.2 + 0.03 * columns - 0.01 * rows)[..., None]
    start = np.array([[[2.0, 2.0], [13.0, 2.0], [2.0, 11.0]]])
    end = np.array([[[44.0, 40.0], [11.0, 40.0], [44.0, 13.0]]])
    known = np.zeros((48, 48), bool)
    known[39, 40], large[39, 40] = True, 7.0
    module.enlarged(small, large, known, start, end)
    assert (large[39, 40] == 7.0).all() and known.sum() == pytest.approx(0.5 * 33 * 27, rel=0.06)
    row, column = np.nonzero(known)
    expected = 0.2 + 0.03 * (2.0 + (44.0 - column - 0.5) / 3.0) - 0.01 * (2.0 + (40.0 - row - 0.5) / 3.0)
    other = (row != 39) | (column != 40)
    assert np.abs(large[row, column, 0] - expected)[other].max() < 1e-5


def test_long_strips_take_the_room_that_they_have(room):
    """Kerbs and rails are thousands of texels long and a few wide: squares around them filled 20 GB."""
    module, size = room("addon.baking.texels.division"), 2048
    small, large = np.ones((64, 64, 1), np.float32), np.zeros((size, size, 1), np.float32)
    known = np.zeros((size, size), bool)
    first = np.arange(12)[:, None] * (0.0, 8.0)
    end = first[:, None] + [(4.0, 4.0), (2004.0, 4.0), (4.0, 7.0)]
    start = np.broadcast_to([(2.0, 2.0), (60.0, 2.0), (2.0, 3.0)], end.shape)
    tracemalloc.start()
    try:
        module.enlarged(small, large, known, start, end)
        assert tracemalloc.get_traced_memory()[1] < 100e6
    finally:
        tracemalloc.stop()
    assert known.sum() == pytest.approx(12 * 0.5 * 2000 * 3, rel=0.02) and (large[known] == 1.0).all()


@pytest.mark.thorough
@pytest.mark.parametrize(("output", "kind", "told"), [("Random Per Island", "OBJECTS", True),
                                                      ("Random Per Island", "PICTURE", False),
                                                      ("Pointiness", "OBJECTS", False)])
def test_where_islands_have_other_colours_that_is_said(blank, capsys, output, kind, told):
    """Islands are random by how a mesh is numbered, and what is baked is numbered otherwise."""
    ball_scene(blank)
    tree = bpy.data.objects["Floor"].active_material.node_tree
    shader = next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED")
    tree.links.new(tree.nodes.new("ShaderNodeNewGeometry").outputs[output], shader.inputs["Base Color"])
    parts.generate()
    assert bpy.ops.reflection_mesh.light("EXEC_DEFAULT", samples=1, kind=kind) == {"FINISHED"}
    assert ("What is random by island on 'Floor' is so in other colours" in capsys.readouterr().out) == told


@pytest.mark.thorough
@pytest.mark.parametrize(("kind", "bumped", "told"), [("OBJECTS", True, True), ("PICTURE", True, False),
                                                      ("OBJECTS", False, False)])
def test_that_a_mirrors_bumps_are_not_followed_is_said(blank, capsys, kind, bumped, told):
    """The picture shows them, since Cycles renders the mirror itself."""
    ball_scene(blank)
    tree = bpy.data.objects["Ball"].active_material.node_tree
    shader = next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED")
    if bumped:
        tree.links.new(tree.nodes.new("ShaderNodeBump").outputs["Normal"], shader.inputs["Normal"])
    parts.generate()
    assert bpy.ops.reflection_mesh.light("EXEC_DEFAULT", samples=1, kind=kind) == {"FINISHED"}
    assert ("The material of 'Ball' bends its normals" in capsys.readouterr().out) == told
