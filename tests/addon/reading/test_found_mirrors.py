"""Every mirror is found, whatever is selected; what Cycles shows no reflection in takes no part."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest


@pytest.fixture
def scene(blank) -> dict[str, bpy.types.Object]:
    """A chrome kettle, a monkey and a floor, of which the monkey was added last."""
    kettle = parts.add("uv_sphere", "Kettle", location=(0.0, 1.0, 1.0))
    kettle.data.materials.append(parts.material("Chrome", "PRINCIPLED"))
    floor = parts.add("plane", "Floor", size=9.0)
    monkey = parts.add("monkey", "Monkey", location=(0.0, -2.0, 1.0))
    for obj in (floor, monkey):
        obj.data.materials.append(parts.material(f"{obj.name} paint", "DIFFUSE"))
    parts.select(monkey)
    return {"kettle": kettle, "monkey": monkey, "floor": floor}


def names(room, **options) -> tuple[list, list]:
    mirrors, diffuse = room("addon.reading").candidates(bpy.context, **options)
    return sorted(obj.name for obj in mirrors), sorted(obj.name for obj in diffuse)


def rough(obj: bpy.types.Object, roughness: float) -> None:
    obj.data.materials[0].node_tree.nodes["Principled BSDF"].inputs["Roughness"].default_value = roughness


def reports(monkeypatch, room) -> list[str]:
    told: list[str] = []
    place = room("addon.operators.generate")
    monkeypatch.setattr(place, "tell_done", lambda _, done, remarks: told.extend([*done, *remarks]))
    return told


def test_generate_and_caustics_work_with_the_monkey_selected(scene, room):
    """Check that the kettle is found as the mirror, and shows the selected monkey and all other objects."""
    bpy.ops.object.light_add(type="POINT", location=(2.0, -3.0, 4.0))
    parts.select(scene["monkey"])
    operators = bpy.ops.reflection_mesh
    assert all(getattr(operators, name).poll() for name in ("generate", "caustics", "bake", "compare", "mirror_uvs"))
    assert names(room) == (["Kettle"], ["Floor", "Monkey"])
    # a map is written on what is selected alone
    assert names(room, all_seen=False) == (["Kettle"], ["Monkey"])
    result = parts.generate()
    assert result.reflection_mesh.mirror == scene["kettle"]
    assert {source.object for source in result.reflection_mesh.sources} == {scene["monkey"], scene["floor"]}
    parts.select(scene["monkey"])
    assert operators.caustics(tolerance=8.0) == {"FINISHED"}
    assert [obj.reflection_mesh.mirror for obj in bpy.context.scene.objects
            if obj.reflection_mesh.role == "CAUSTICS"] == [scene["kettle"]]


def test_mirrors_that_show_what_is_selected_come_before_all_others(scene, room):
    """They are generated again, with all that they show."""
    vase = parts.add("cylinder", "Vase", location=(2.0, 1.0, 1.0))
    vase.data.materials.append(scene["kettle"].data.materials[0])
    parts.select(scene["monkey"])
    assert names(room) == (["Kettle", "Vase"], ["Floor", "Monkey"])
    parts.select(scene["monkey"], scene["floor"], vase)
    result = parts.generate()
    parts.select(scene["monkey"])
    assert names(room) == (["Vase"], ["Floor", "Monkey"]) and parts.generate() == result
    parts.select(scene["kettle"])
    assert names(room) == (["Kettle"], ["Floor", "Monkey", "Vase"])
    # of what nothing shows, all show it
    new = parts.add("cube", "New")
    parts.select(new)
    assert names(room) == (["Kettle", "Vase"], ["Floor", "Monkey", "New"])


def test_a_role_without_anything_that_is_said_to_be_reflected_shows_all(scene, room):
    scene["floor"].reflection_mesh.role = "MIRROR"
    for selected in ((), (scene["monkey"],)):
        parts.select(*selected)
        assert bpy.ops.reflection_mesh.generate.poll()
        assert names(room) == (["Floor"], ["Kettle", "Monkey"])


def test_rough_metal_is_a_mirror_where_it_is_asked_for(scene, room, monkeypatch):
    kettle, monkey, floor = scene["kettle"], scene["monkey"], scene["floor"]
    told = reports(monkeypatch, room)
    rough(kettle, 0.15)
    for selected in ((monkey,), ()):
        parts.select(*selected)
        assert "No mirror" in parts.refusal()
    parts.select(kettle)
    assert parts.generate().reflection_mesh.mirror == kettle
    assert told[-1] == "'Kettle' has a roughness of 0.15, and its reflection is sharp, where Cycles' is blurred."
    bpy.ops.reflection_mesh.clear()
    parts.select(kettle, floor, monkey)
    assert names(room) == (["Kettle"], ["Floor", "Monkey"])
    # glass that is made the active one is meant, and so is what is active beside metal that mirrors no shapes
    glass = bpy.data.materials.new("Glass")
    tree = room("addon.compat").use_nodes(glass)
    shader = next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED")
    shader.inputs["Transmission Weight"].default_value, shader.inputs["Roughness"].default_value = 1.0, 0.0
    monkey.data.materials[0] = glass
    assert names(room) == (["Monkey"], ["Floor", "Kettle"])
    monkey.data.materials.clear()
    rough(kettle, 0.6)
    assert names(room) == (["Monkey"], ["Floor", "Kettle"])
    parts.select(kettle)
    assert names(room) == (["Kettle"], ["Floor", "Monkey"])
    parts.select()
    kettle.reflection_mesh.role = "MIRROR"
    parts.generate()
    assert "has a roughness of 0.60" in told[-1]
    rough(kettle, 0.1)
    parts.generate()
    assert "roughness" not in told[-1]


def test_rough_metal_s_other_faces_do_not_reflect(scene):
    """Check a metal kettle with a wooden handle."""
    kettle = scene["kettle"]
    rough(kettle, 0.2)
    kettle.data.materials.append(parts.material("Wood", "DIFFUSE"))
    wooden = [face.index for face in kettle.data.polygons if face.center.z > 0.0]
    for index in wooden:
        kettle.data.polygons[index].material_index = 1
    parts.select(kettle)
    result = parts.generate()
    heights = parts.attribute(result, "mirror_position")[:, 2]
    assert heights.size and heights.max() < 1.0 + 1e-4


def instancer(material: bpy.types.Material, keep: bool) -> bpy.types.Object:
    """A cube on whose faces Geometry Nodes put squares of a material; what it is itself is kept where that is said."""
    tree = bpy.data.node_groups.new("Tiles", "GeometryNodeTree")
    for direction in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=direction, socket_type="NodeSocketGeometry")
    start, points, grid, paint, put, end = map(tree.nodes.new, (
        "NodeGroupInput", "GeometryNodeMeshToPoints", "GeometryNodeMeshGrid", "GeometryNodeSetMaterial",
        "GeometryNodeInstanceOnPoints", "NodeGroupOutput"))
    points.mode, paint.inputs["Material"].default_value = "FACES", material
    for name in ("Size X", "Size Y"):
        grid.inputs[name].default_value = 0.5
    for output, socket in ((start.outputs[0], points.inputs[0]), (grid.outputs[0], paint.inputs["Geometry"]),
                           (points.outputs[0], put.inputs["Points"]), (paint.outputs[0], put.inputs["Instance"])):
        tree.links.new(output, socket)
    shown = put.outputs[0]
    if keep:
        both = tree.nodes.new("GeometryNodeJoinGeometry")
        for output in (start.outputs[0], shown):
            tree.links.new(output, both.inputs[0])
        shown = both.outputs[0]
    tree.links.new(shown, end.inputs[0])
    made = parts.add("cube", "Tiles", size=1.0, location=(2.0, 0.0, 1.0))
    made.data.materials.append(parts.material("Plaster", "DIFFUSE"))
    made.modifiers.new("Tiles", "NODES").node_group = tree
    return made


@pytest.mark.parametrize("keep", [False, True])
def test_instances_of_geometry_nodes_are_mirrors_by_their_material(scene, room, keep):
    """Check instances such as the tiles of a disco ball. Only they reflect if the object itself is no mirror."""
    bpy.data.objects.remove(scene["kettle"])
    tiles = instancer(parts.material("Silver", "GLOSSY"), keep)
    bpy.context.view_layer.update()
    for selected in ((tiles,), (), (scene["monkey"],)):
        parts.select(*selected)
        assert bpy.ops.reflection_mesh.generate.poll()
        assert names(room) == (["Tiles"], ["Floor", "Monkey"])
    parts.add("plane", "Wall", size=20.0, location=(0.0, 8.0, 1.0), rotation=(np.pi / 2, 0.0, 0.0))
    parts.select(tiles)
    result = parts.generate()
    # the squares lie level in the faces' middles, and the cube's own faces reflect nothing
    places = parts.attribute(result, "mirror_position")
    assert len(places) and np.isclose(places[:, 2][:, None], [0.5, 1.0, 1.5], atol=1e-4).any(axis=1).all()


def test_what_nodes_instance_that_is_no_mirror_makes_none(scene, room):
    bpy.data.objects.remove(scene["kettle"])
    tiles = instancer(parts.material("Paper", "DIFFUSE"), False)
    bpy.context.view_layer.update()
    parts.select(tiles)
    assert "No mirror" in parts.refusal()


@pytest.mark.parametrize("linked", [False, True])
def test_the_mirror_of_a_collection_instance_reflects_and_its_frame_does_not(scene, room, linked, tmp_path):
    """Also where it is linked from an asset's file."""
    bpy.data.objects.remove(scene["kettle"])
    glass, frame = parts.add("plane", "Pane", size=2.0, rotation=(np.pi / 2, 0.0, 0.0)), parts.add("cube", "Frame")
    frame.location, frame.scale = (0.0, 0.2, 0.0), (1.3, 0.1, 1.3)
    glass.data.materials.append(parts.material("Silver", "GLOSSY"))
    frame.data.materials.append(parts.material("Wood", "DIFFUSE"))
    kit = bpy.data.collections.new("Kit")
    for obj in (glass, frame):
        kit.objects.link(obj)
        bpy.context.scene.collection.objects.unlink(obj)
    if linked:
        path = str(tmp_path / "kit.blend")
        bpy.data.libraries.write(path, {kit})
        bpy.data.collections.remove(kit)
        for obj in (glass, frame):
            bpy.data.objects.remove(obj)
        with bpy.data.libraries.load(path, link=True) as (_, wanted):
            wanted.collections = ["Kit"]
        kit = wanted.collections[0]
    holder = bpy.data.objects.new("Bathroom", None)
    holder.instance_type, holder.instance_collection, holder.location = "COLLECTION", kit, (0.0, 1.0, 1.0)
    bpy.context.scene.collection.objects.link(holder)
    bpy.context.view_layer.update()
    for selected in ((holder,), (), (scene["monkey"],)):
        parts.select(*selected)
        assert bpy.ops.reflection_mesh.generate.poll()
        assert names(room) == (["Bathroom"], ["Floor", "Monkey"])
    parts.select(holder)
    places = parts.attribute(parts.generate(), "mirror_position")
    assert len(places) and np.abs(places[:, 1] - 1.0).max() < 1e-4


CAUGHT = ("'Kettle' is a shadow catcher, in which Cycles shows no reflection: switch off Shadow Catcher in Object "
          "Properties > Visibility.")


def test_a_shadow_catcher_is_refused_alone_and_left_out_among_others(scene, room, monkeypatch, tmp_path):
    kettle = scene["kettle"]
    kettle.is_shadow_catcher = True
    for selected in ((kettle,), (kettle, scene["monkey"]), ()):
        parts.select(*selected)
        assert parts.refusal() == CAUGHT
        assert parts.refusal(bpy.ops.reflection_mesh.bake, filepath=str(tmp_path / "frames")) == CAUGHT
    vase = parts.add("cylinder", "Vase", location=(2.0, 1.0, 1.0))
    vase.data.materials.append(kettle.data.materials[0])
    parts.select()
    told = reports(monkeypatch, room)
    assert parts.generate().reflection_mesh.mirror == vase and CAUGHT in told
    assert not room("addon.reading.results").results_of(bpy.context, kettle)
    # lamps do not ask who is seen
    chosen = room("addon.reading").choose(bpy.context, unmirrored=True)
    assert not chosen.caught
    bpy.ops.reflection_mesh.clear()
    parts.select()
    kettle.is_shadow_catcher = False
    assert names(room)[0] == ["Kettle", "Vase"]


def rendered(room) -> np.ndarray:
    scene = bpy.context.scene
    scene.render.filepath = bpy.app.tempdir + "/caught.exr"
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(scene.render.filepath)
    pixels = np.array(image.pixels[:], dtype=np.float32).reshape(-1, 4)
    bpy.data.images.remove(image)
    return pixels


@pytest.mark.parametrize("transparent", [False, True])
def test_cycles_shows_no_reflection_in_a_shadow_catcher(scene, room, transparent):
    """Be the film transparent or not; what is left out may be no more than that."""
    scene["monkey"].data.materials[0] = parts.material("Glowing")
    scene["monkey"].data.materials[0].node_tree.nodes["Emission"].inputs["Color"].default_value = (1.0, 0.0, 0.0, 1.0)
    scene["monkey"].visible_camera = False
    bpy.data.objects.remove(scene["floor"])
    render = bpy.context.scene
    render.render.engine, render.cycles.samples, render.cycles.use_denoising = "CYCLES", 4, False
    render.render.resolution_x, render.render.resolution_y = 64, 48
    render.render.film_transparent = transparent
    render.render.image_settings.file_format, render.render.image_settings.color_mode = "OPEN_EXR", "RGBA"
    red = []
    for caught in (False, True):
        scene["kettle"].is_shadow_catcher = caught
        red.append(int((rendered(room)[:, 0] > 0.3).sum()))
    assert red[0] > 10 and red[1] == 0
    parts.select(scene["kettle"])
    assert parts.refusal() == CAUGHT
