"""Make It a Mirror: the active object becomes one, and nothing that it had is lost."""
from __future__ import annotations

import bpy
import parts
import pytest


@pytest.fixture
def box(blank) -> bpy.types.Object:
    made = parts.add("cube", "Box")
    parts.select(made)
    return made


def made() -> None:
    assert bpy.ops.reflection_mesh.make_mirror() == {"FINISHED"}


def test_what_has_no_material_gets_one(box, room):
    made()
    assert box.reflection_mesh.role == "MIRROR"
    assert room("addon.reading").is_mirror(box.material_slots[0].material)


def test_the_mesh_keeps_its_materials(box, room):
    """Also what the object had in slots of its own, which nothing else may use."""
    own, other = parts.material("Paint", "DIFFUSE"), parts.material("Coat", "DIFFUSE")
    box.data.materials.append(own)
    box.data.materials.append(own)
    box.material_slots[1].link = "OBJECT"
    box.material_slots[1].material = other
    copy = bpy.data.objects.new("Copy", box.data)
    made()
    assert all(map(room("addon.reading").is_mirror, (slot.material for slot in box.material_slots)))
    assert list(box.data.materials) == [own, own] and copy.material_slots[0].material == own
    assert other.use_fake_user
    for slot in box.material_slots:
        slot.link = "DATA"
    assert [slot.material for slot in box.material_slots] == [own, own]


@pytest.mark.parametrize(("kind", "roughness"), [("GLOSSY", 0.0), ("PRINCIPLED", 0.4), ("GLASS", 0.0)])
def test_what_mirrors_by_itself_keeps_its_look(box, kind, roughness):
    material = parts.material("Own", "GLOSSY" if kind == "GLASS" else kind, roughness)
    if kind == "GLASS":
        nodes, links = material.node_tree.nodes, material.node_tree.links
        output = next(node for node in nodes if node.type == "OUTPUT_MATERIAL")
        glass = nodes.new("ShaderNodeBsdfGlass")
        glass.inputs["Roughness"].default_value = 0.0
        links.new(glass.outputs[0], output.inputs["Surface"])
    box.data.materials.append(material)
    made()
    assert box.reflection_mesh.role == "MIRROR" and [slot.material for slot in box.material_slots] == [material]


def test_it_is_grey_where_nothing_can_be_one(box):
    bpy.context.view_layer.objects.active = None
    assert not bpy.ops.reflection_mesh.make_mirror.poll()
    bpy.context.view_layer.objects.active = bpy.context.scene.camera
    assert parts.refusal(bpy.ops.reflection_mesh.make_mirror) == (
        "No object to make a mirror of: make one with faces the active object.")
