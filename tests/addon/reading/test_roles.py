"""Who takes part: every rule of the roles, and which materials are mirrors."""
from types import SimpleNamespace

import bpy
import parts
import pytest


def names(room) -> tuple[list, list]:
    mirrors, diffuse = room("addon.reading.roles").participants(bpy.context)
    return sorted(obj.name for obj in mirrors), sorted(obj.name for obj in diffuse)


@pytest.fixture
def four(blank):
    return [parts.add("cube", name, location=(3.0 * index, 0.0, 0.0)) for index, name in enumerate("ABCD")]


def test_active_is_the_mirror(four, room):
    parts.select(four[0], four[2], four[1])
    assert names(room) == (["B"], ["A", "C"])


def test_mirror_material_beats_active(four, room):
    four[2].data.materials.append(parts.material("Chrome", "GLOSSY"))
    parts.select(*four)
    assert names(room) == (["C"], ["A", "B", "D"])


def test_explicit_roles_beat_materials(four, room):
    for obj in four[:2]:
        obj.data.materials.append(parts.material("Chrome", "GLOSSY"))
    four[0].reflection_mesh.role = "DIFFUSE"
    four[3].reflection_mesh.role = "MIRROR"
    four[2].reflection_mesh.role = "IGNORE"
    parts.select(*four)
    assert names(room) == (["B", "D"], ["A"])


def test_roles_without_a_selection(four, room):
    four[1].reflection_mesh.role = "MIRROR"
    four[3].reflection_mesh.role = "DIFFUSE"
    four[0].data.materials.append(parts.material("Chrome", "GLOSSY"))
    parts.select()
    assert names(room) == (["B"], ["D"])


def test_selection_without_a_diffuse_object_falls_back_to_roles(four, room):
    four[1].reflection_mesh.role = "MIRROR"
    four[3].reflection_mesh.role = "DIFFUSE"
    parts.select(four[0])
    assert names(room) == (["B"], ["D"])


def test_active_diffuse_object_is_no_mirror(four, room):
    four[1].reflection_mesh.role = "DIFFUSE"
    parts.select(four[0], four[1])
    with pytest.raises(room("core").ReflectionError, match="mirror"):
        room("addon.reading.roles").participants(bpy.context)


def test_materials_without_a_selection(four, room):
    """Whatever is a mirror by its material shows the rest, and what is hidden takes no part; also where something is
    selected that is none, as what was added last is."""
    for obj in four[:3]:
        obj.data.materials.append(parts.material("Chrome", "GLOSSY"))
    four[2].hide_render = True
    parts.select()
    assert names(room) == (["A", "B"], ["D"])
    assert names_without_all(room) == (["A", "B"], [])
    four[3].reflection_mesh.role = "DIFFUSE"
    parts.add("cube", "E")
    parts.select()
    assert names(room) == (["A", "B"], ["D"])
    four[3].reflection_mesh.role = "AUTO"
    parts.select(four[3])
    assert names(room) == (["A", "B"], ["D", "E"])
    assert names_without_all(room) == (["A", "B"], ["D"])
    # of several that are none, the active one is to be the mirror
    parts.select(bpy.data.objects["E"], four[3])
    assert names(room) == (["D"], ["E"])


def names_without_all(room) -> tuple[list, list]:
    mirrors, diffuse = room("addon.reading.roles").candidates(bpy.context, all_seen=False)
    return sorted(obj.name for obj in mirrors), sorted(obj.name for obj in diffuse)


def test_the_command_line_forgets_a_selection_by_chance(four, room):
    """One that chooses no mirror; one that does is kept, though it leaves out a mirror."""
    place, options = room("addon.command_line.place"), SimpleNamespace(scene=None, view_layer=None)
    for obj in four[:2]:
        obj.data.materials.append(parts.material("Chrome", "GLOSSY"))
    parts.select(four[3])
    with place.placed(bpy.context, options):
        assert names(room) == (["A", "B"], ["C", "D"])
    parts.select(four[0], four[3])
    with place.placed(bpy.context, options):
        assert names(room) == (["A"], ["D"])


def test_a_result_knows_its_own(four, room):
    four[2].reflection_mesh.role = "MIRROR"
    four[3].reflection_mesh.role = "DIFFUSE"
    result = parts.add("plane", "Result")
    result.reflection_mesh.role = "REFLECTION"
    result.reflection_mesh.mirror = four[0]
    result.reflection_mesh.sources.add().object = four[1]
    parts.select(result)
    assert names(room) == (["A"], ["B"])
    result.select_set(False)
    assert names(room) == (["A"], ["B"])


def test_lights_and_cameras_take_no_part(four, room):
    bpy.ops.object.light_add()
    light = bpy.context.object
    parts.select(light, bpy.context.scene.camera, four[0], four[1])
    assert names(room) == (["B"], ["A"])


def test_hidden_objects_are_left_out_and_named(four, room):
    parts.select(*four)
    four[0].hide_render = True
    chosen = room("addon.reading.roles").choose(bpy.context)
    assert [obj.name for obj in chosen.hidden] == ["A"]
    assert names(room) == (["D"], ["B", "C"])


def test_objects_in_a_hidden_collection_are_left_out(four, room):
    for obj in four:
        obj.reflection_mesh.role = "MIRROR" if obj.name == "A" else "DIFFUSE"
    cellar, chest = bpy.data.collections.new("Cellar"), bpy.data.collections.new("Chest")
    bpy.context.scene.collection.children.link(cellar)
    cellar.children.link(chest)
    chest.objects.link(four[1])
    bpy.context.scene.collection.objects.unlink(four[1])
    cellar.hide_render = True
    parts.select()
    assert names(room) == (["A"], ["C", "D"])


@pytest.mark.parametrize(("kind", "roughness", "metallic", "expected"), [
    ("GLOSSY", 0.0, 1.0, True), ("GLOSSY", 0.05, 1.0, True), ("GLOSSY", 0.4, 1.0, False),
    ("GLOSSY", 0.1, 1.0, True), ("PRINCIPLED", 0.1, 0.9, True), ("GLOSSY", 0.101, 1.0, False),
    ("PRINCIPLED", 0.0, 1.0, True), ("PRINCIPLED", 0.0, 0.0, False), ("PRINCIPLED", 0.5, 1.0, False),
    ("DIFFUSE", 0.0, 0.0, False), ("EMISSION", 0.0, 0.0, False)])
def test_mirror_materials(blank, room, kind, roughness, metallic, expected):
    is_mirror = room("addon.reading.materials.mirror_materials").is_mirror
    assert is_mirror(parts.material("M", kind, roughness, metallic)) is expected


def test_a_textured_roughness_makes_no_mirror(blank, room):
    made = parts.material("M", "GLOSSY")
    tree = made.node_tree
    shader = next(node for node in tree.nodes if node.type == "BSDF_GLOSSY")
    tree.links.new(tree.nodes.new("ShaderNodeTexNoise").outputs[0], shader.inputs["Roughness"])
    assert not room("addon.reading.materials.mirror_materials").is_mirror(made)


def test_reroutes_and_empty_materials(blank, room):
    is_mirror = room("addon.reading.materials.mirror_materials").is_mirror
    made = parts.material("M", "GLOSSY")
    tree = made.node_tree
    output = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
    shader = next(node for node in tree.nodes if node.type == "BSDF_GLOSSY")
    reroute = tree.nodes.new("NodeReroute")
    tree.links.new(shader.outputs[0], reroute.inputs[0])
    tree.links.new(reroute.outputs[0], output.inputs["Surface"])
    assert is_mirror(made)
    tree.nodes.remove(shader)
    assert not is_mirror(made)
    tree.nodes.clear()
    assert not is_mirror(made) and not is_mirror(None)


@pytest.mark.parametrize("more", [(), ("box",)])
def test_an_instance_with_a_mirror_in_it_is_one(four, room, more):
    """Check instances as assets have them. If there are other mirrors, these show a room with a mirror in it."""
    kit = bpy.data.collections.new("Kit")
    glass = parts.add("plane", "Glass")
    glass.data.materials.append(parts.material("Chrome", "GLOSSY"))
    made = [glass, *(parts.add("cube", name) for name in more)]
    for obj in made:
        kit.objects.link(obj)
        bpy.context.scene.collection.objects.unlink(obj)
    bpy.ops.object.collection_instance_add(collection="Kit")
    instance = bpy.context.object
    parts.select(instance, *four[:2])
    assert names(room) == (["Kit"], ["A", "B"])
    parts.select(instance)
    assert names(room) == (["Kit"], ["A", "B", "C", "D"])
    four[0].data.materials.append(parts.material("Chrome", "GLOSSY"))
    parts.select(instance, *four[:2])
    assert names(room) == ((["A"], ["B", "Kit"]) if more else (["A", "Kit"], ["B"]))


def test_what_is_not_in_the_scene_is_called_neither_hidden_nor_missing(four, room):
    """As of a result that was appended alone."""
    result = parts.add("plane", "Result")
    result.reflection_mesh.role, result.reflection_mesh.mirror = "REFLECTION", four[0]
    result.reflection_mesh.sources.add().object = four[1]
    for obj in four[:2]:
        bpy.context.scene.collection.objects.unlink(obj)
    parts.select(result)
    with pytest.raises(room("core").ReflectionError, match="^'A' is not in this scene"):
        names(room)
    bpy.context.scene.collection.objects.link(four[0])
    with pytest.raises(room("core").ReflectionError, match="^'B' is not in this scene"):
        names(room)


def test_a_mirror_s_material_on_no_face_makes_no_mirror(four, room):
    """As slots that imports leave; modifiers may give faces another slot."""
    for obj in four[:2]:
        for kind in ("EMISSION", "GLOSSY"):
            obj.data.materials.append(parts.material(kind, kind))
    four[1].data.polygons[2].material_index = 1
    parts.select()
    assert names(room) == (["B"], ["A", "C", "D"])
    parts.select(*four[:3])
    assert names(room) == (["B"], ["A", "C"])
    four[1].data.polygons[2].material_index = 0
    four[0].modifiers.new("Rim", "SOLIDIFY").material_offset = 1
    assert names(room) == (["A"], ["B", "C"])
    # what has fewer slots than its faces ask for shows the last
    four[0].modifiers.clear()
    four[0].data.polygons[0].material_index = 7
    assert names(room) == (["A"], ["B", "C"])
