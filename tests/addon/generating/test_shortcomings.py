"""What a result lacks is told, each cause in a sentence of its own that says what to do."""
import re
from types import SimpleNamespace

import bpy
import numpy as np
import parts
import pytest

PIXELS = {"filled_pixels": 500, "mirror_pixels": 4000}
COUNTS = ("crowded", "overlaid", "pierced", "many_outlines", "bounded", "coarse")


@pytest.fixture(scope="module")
def told(room):
    def told(**counts):
        result = SimpleNamespace(counts=counts, missing_share=12.3, positions=range(50))
        return room("addon.operators.shortcomings").shortcomings("Lake", result)
    return told


@pytest.mark.parametrize("count", COUNTS)
def test_each_count_has_a_sentence(told, count):
    (sentence,) = told(**{count: 7}, **PIXELS)
    # what happened and why, and what to do
    assert re.fullmatch(r"Lake: [A-Z0-9].+\. [A-Z][^.]+\.", sentence)
    shares = {"crowded": "12.5 %", "coarse": "14.0 %"}
    assert (count in shares) == ("%" in sentence) and shares.get(count, "") in sentence


def test_what_is_too_small_to_be_seen_is_not_told(told):
    assert told(crowded=3, filled_pixels=1, mirror_pixels=4000) == []


def test_sentences_differ_and_a_good_result_has_none(told):
    assert len({one for count in COUNTS for one in told(**{count: 1}, **PIXELS)}) == len(COUNTS)
    assert told(**dict.fromkeys(COUNTS, 0), missed=0) == []
    assert told(missed=2) == [] and "About 12 %" in told(missed=3)[0]


def test_scenes_finer_than_pixels_get_a_hint_at_points(room):
    def hint(faces, bounces=1):
        result = SimpleNamespace(triangles=range(faces), counts={"mirror_pixels": 250_000}, bounces=np.array([bounces]))
        return room("addon.operators.shortcomings").better_of_points("Lake", result)
    assert ["Made Of > Points" in sentence for sentence in hint(300_000)] == [True]
    # points, which have no faces, show one bounce
    assert not hint(240_000) and not hint(300_000, bounces=2) and not hint(0)


@pytest.mark.parametrize("placement", ["LAYERED", "VIRTUAL"])
def test_what_a_render_blurs_otherwise_is_told(blank, capfd, placement):
    parts.select(parts.add("cube", "Box", size=1.0, location=(0.0, -1.5, 1.0)), parts.add_wall_mirror())

    def told() -> str:
        parts.generate(placement=placement)
        return "".join(capfd.readouterr())
    assert "blur" not in told()
    blank.scene.camera.data.dof.use_dof = blank.scene.render.use_motion_blur = True
    sentences = told()
    assert ("Depth of field: the camera focuses on the mirror" in sentences) == (placement == "LAYERED")
    assert "Motion blur: the reflection is that of one moment" in sentences
    assert "Stereoscopy" not in sentences
    blank.scene.render.use_multiview = True
    assert ("Stereoscopy: a reflection is right for one eye" in told()) == (placement == "LAYERED")


def test_what_is_gone_is_not_called_hidden(blank, capfd):
    box, other = (parts.add("cube", name, location=(x, -1.5, 1.0)) for name, x in (("Box", 0.0), ("Old", 1.5)))
    parts.select(box, other, parts.add_wall_mirror())
    result = parts.generate()
    parts.select(other)
    bpy.ops.object.delete()
    parts.select(result)
    for sentences in (["Warning: Left out because it is not in this scene: 'Old'."], []):
        capfd.readouterr()
        parts.generate()
        # once: it is forgotten
        assert [line for line in capfd.readouterr().out.splitlines() if "Left out" in line] == sentences


def test_what_is_to_be_said_against_a_result_is_told_last(blank, capfd):
    """The status bar shows the last report alone; the first sentence on a result is the most important one."""
    box, mirror = parts.add("cube", "Box", size=1.0, location=(0.0, -1.5, 1.0)), parts.add_wall_mirror()
    subdivided(box)
    blank.scene.render.use_motion_blur = True
    parts.select(box, mirror)
    parts.generate()
    told = [line for line in capfd.readouterr().out.splitlines() if line.startswith(("Info: ", "Warning: "))]
    assert [line.split(":")[0] for line in told] == ["Info", "Warning", "Warning"]
    assert "Motion blur" in told[1] and "another mesh of 'Box'" in told[2]


def subdivided(box, levels: int = 1, render: int = 2, name: str = "Rounder", **more):
    modifier = box.modifiers.new(name, "SUBSURF")
    modifier.levels, modifier.render_levels = levels, render
    for key, value in more.items():
        setattr(modifier, key, value)


def simplified(box) -> None:
    subdivided(box)
    bpy.context.scene.render.use_simplify = True
    bpy.context.scene.render.simplify_subdivision = bpy.context.scene.render.simplify_subdivision_render = 1


@pytest.mark.parametrize(("change", "told"), [
    (subdivided, True), (lambda box: subdivided(box, 2), False), (simplified, False),
    (lambda box: subdivided(box, 2, show_render=False), True),
    (lambda box: subdivided(box, 2, show_viewport=False), True),
    (lambda box: subdivided(box, show_render=False, show_viewport=False), False)])
def test_another_mesh_in_renders_is_told(blank, capfd, change, told):
    """Of that a reflection has the viewport's."""
    box, mirror = parts.add("cube", "Box", size=1.0, location=(0.0, -1.5, 1.0)), parts.add_wall_mirror()
    change(box)
    parts.select(box, mirror)
    parts.generate()
    assert ("another mesh of 'Box' than viewports do, by 'Rounder'" in "".join(capfd.readouterr())) == told
    other = parts.add("cube", "Other", size=1.0, location=(0.5, -2.5, 1.0))
    subdivided(other)
    parts.select(box, other, mirror)
    parts.generate()
    assert ("other meshes of 2 objects than viewports do, of 'Box'" in "".join(capfd.readouterr())) == told


def test_curves_and_metaballs_that_renders_make_finer_are_told(blank, room):
    otherwise = room("addon.reading").rendered_otherwise
    bpy.ops.object.metaball_add()
    ball = bpy.context.object
    bpy.ops.curve.primitive_bezier_circle_add()
    ring = bpy.context.object
    assert otherwise(blank.scene, ball) == ball.data.name and not otherwise(blank.scene, ring)
    ball.data.render_resolution, ring.data.render_resolution_u = ball.data.resolution, 40
    assert otherwise(blank.scene, ring) == ring.data.name and not otherwise(blank.scene, ball)


@pytest.mark.parametrize("engine", ["CYCLES", "BLENDER_WORKBENCH"])
def test_a_mesh_that_cycles_dices_is_told(blank, room, engine):
    """Cycles alone subdivides it as finely as the picture asks for."""
    scene, box = blank.scene, parts.add("cube", "Box")
    scene.render.engine = engine
    subdivided(box, 1, 1)
    assert not room("addon.reading").rendered_otherwise(scene, box)
    if bpy.app.version >= (5, 0, 0):
        box.modifiers[0].use_adaptive_subdivision = True
    else:
        scene.cycles.feature_set, box.cycles.use_adaptive_subdivision = "EXPERIMENTAL", True
    assert room("addon.reading").rendered_otherwise(scene, box) == ("Rounder" if engine == "CYCLES" else "")


@pytest.mark.parametrize("chosen", [False, True])
def test_what_stands_in_the_background_set_is_told(blank, capfd, chosen):
    """Renders show it, and a mirror that shows all that is there lacks it; where the user chose, it is meant."""
    cube, mirror = parts.add("cube", "Box", location=(1.5, -1.5, 1.0)), parts.add_wall_mirror()
    parts.add("cube", "Left", location=(-1.5, -1.5, 1.0))
    mirror.data.materials.append(parts.material("Chrome", "GLOSSY"))
    scene = bpy.data.scenes.new("Set")
    behind = parts.add("cone", "Cone", location=(0.0, -1.5, 1.0))
    blank.scene.collection.objects.unlink(behind)
    scene.collection.objects.link(behind)
    for hidden in (False, True):
        blank.scene.background_set, behind.hide_render = scene, hidden
        parts.select(*([cube] if chosen else []), mirror)
        parts.generate()
        told = "Renders show 'Cone' of the background set too" in "".join(capfd.readouterr())
        assert told == (not hidden and not chosen)
        bpy.ops.reflection_mesh.clear()


@pytest.mark.parametrize("hide", ["eye", "collection", "everywhere", "chosen"])
def test_what_the_viewport_alone_hides_is_told(blank, capfd, hide):
    """A mirror that shows all that is there lacks what renders show of it; where the user chose, it is meant."""
    box, kept, mirror = parts.add("cube", "Box"), parts.add("cube", "Kept", location=(1.5, -1.5, 1.0)), None
    mirror = parts.add_wall_mirror()
    mirror.data.materials.append(parts.material("Chrome", "GLOSSY"))
    if hide == "collection":
        cellar = bpy.data.collections.new("Cellar")
        blank.scene.collection.children.link(cellar)
        cellar.objects.link(box)
        blank.scene.collection.objects.unlink(box)
        blank.view_layer.layer_collection.children["Cellar"].hide_viewport = True
    else:
        box.hide_set(True)
    box.hide_render = hide == "everywhere"
    if hide == "chosen":
        parts.add("cube", "Left", location=(-1.5, -1.5, 1.0))
    parts.select(*([kept] if hide == "chosen" else []), mirror)
    parts.generate()
    told = "Renders show 'Box', which is hidden in the viewport" in "".join(capfd.readouterr())
    assert told == (hide in {"eye", "collection"})


def hairy(box):
    box.modifiers.new("Fur", "PARTICLE_SYSTEM")
    box.particle_systems[0].settings.type = "HAIR"


def made_by_nodes(obj, kind: str, beside: bool = True) -> None:
    """Let a node make something of an object's mesh, shown beside it; or, of nothing, instead."""
    tree = bpy.data.node_groups.new("Nodes", "GeometryNodeTree")
    for in_out in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=in_out, socket_type="NodeSocketGeometry")
    given, shown, made = (tree.nodes.new(name) for name in ("NodeGroupInput", "NodeGroupOutput", kind))
    join = tree.nodes.new("GeometryNodeJoinGeometry")
    if beside:
        tree.links.new(given.outputs[0], made.inputs[0])
        tree.links.new(given.outputs[0], join.inputs[0])
    tree.links.new(made.outputs[0], join.inputs[0])
    tree.links.new(join.outputs[0], shown.inputs[0])
    obj.modifiers.new("Nodes", "NODES").node_group = tree


def curves(empty: bool):
    """Adds an object of hair that has none of its own, or some; nodes make a cube of it."""
    def change(_) -> None:
        hair = bpy.data.hair_curves.new("Hair")
        obj = bpy.data.objects.new("Hair", hair)
        bpy.context.scene.collection.objects.link(obj)
        if not empty:
            hair.add_curves([3, 4])
            return
        made_by_nodes(obj, "GeometryNodeMeshCube", beside=False)
    return change


def test_what_nodes_make_of_hair_is_reflected(blank, capfd):
    """A cube that they make of curves is one as any other, and there is no hair to miss."""
    parts.add("cube", "Box", location=(2.0, -1.5, 1.0))
    mirror = parts.add_wall_mirror()
    mirror.data.materials.append(parts.material("Chrome", "GLOSSY"))
    places = []
    for kind in ("hair", "mesh"):
        if kind == "hair":
            curves(empty=True)(None)
            cube = bpy.data.objects["Hair"]
        else:
            bpy.data.objects.remove(cube)
            cube = parts.add("cube", "Hair", size=1.0)
        cube.location = (0.0, -1.5, 1.0)
        parts.select(mirror)
        result = parts.generate()
        assert "Hair" in [source.object.name for source in result.reflection_mesh.sources]
        where = parts.attribute(result, "reflected_position")
        where = where[where[:, 0] < 0.6]
        places.append((where.min(axis=0).tolist(), where.max(axis=0).tolist()))
        bpy.ops.reflection_mesh.clear()
    # triangles of the two cubes have other diagonals
    assert places[0] == places[1]
    assert "No reflection has hair" not in "".join(capfd.readouterr())


@pytest.mark.parametrize(("change", "told"), [
    (hairy, "Box"), (lambda box: made_by_nodes(box, "GeometryNodeMeshToPoints"), "Box"),
    (lambda box: made_by_nodes(box, "GeometryNodeMeshToVolume"), "Box"), (curves(False), "Hair"), (curves(True), ""),
    (lambda box: bpy.ops.object.volume_add(), "Volume"), (lambda box: bpy.ops.object.empty_add(), "")])
def test_what_has_no_mesh_is_told(blank, capfd, change, told):
    """Renders show it in the mirror, and the reflection does not; where the user chose other things, it is meant."""
    box, other = parts.add("cube", "Box"), parts.add("cube", "Other", location=(1.5, -1.5, 1.0))
    mirror = parts.add_wall_mirror()
    mirror.data.materials.append(parts.material("Chrome", "GLOSSY"))
    change(box)
    parts.select(mirror)
    parts.generate()
    sentence = f"No reflection has hair, point clouds or volumes, as '{told}' has"
    assert (sentence in "".join(capfd.readouterr())) == bool(told)
    bpy.ops.reflection_mesh.clear()
    parts.select(other, mirror)
    parts.generate()
    assert "No reflection has hair" not in "".join(capfd.readouterr())
