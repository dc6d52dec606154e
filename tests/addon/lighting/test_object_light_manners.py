"""Light: objects that are hidden meanwhile, the mirror's own images, linked objects."""
from __future__ import annotations

import bpy
import parts
from lamp_scenes import outdated, scene_of


def light(samples: int = 64) -> None:
    assert bpy.ops.reflection_mesh.light(samples=samples) == {"FINISHED"}


def test_another_mesh_does_not_show_it(blank, room):
    scene_of(blank)
    result = parts.generate(tolerance=4.0)
    light(1)
    bpy.data.objects["Box"].modifiers.new("Finer", "SUBSURF").levels = 1
    parts.select(result)
    parts.generate(tolerance=4.0)
    assert outdated(room, result)
    assert all(slot.link == "DATA" for slot in result.material_slots)


def test_what_is_hidden_meanwhile_takes_no_part(blank, room):
    """A result remembers it for when it is shown again; its light stays what it is."""
    wall = scene_of(blank)
    other = parts.add("cube", "Other", size=0.5, location=(-1.0, -1.5, 1.0))
    other.hide_render = True
    parts.select(bpy.data.objects["Box"], other, wall)
    result = parts.generate(tolerance=4.0)
    assert [source.object.name for source in result.reflection_mesh.sources] == ["Box", "Other"]
    light(1)
    parts.select(result)
    parts.generate(tolerance=4.0)
    assert not outdated(room, result)
    assert {slot.material for slot in result.material_slots} == {result.reflection_mesh.light_material}
    other.hide_render = False
    parts.generate(tolerance=4.0)
    assert outdated(room, result) and len(set(parts.attribute(result, "source_object"))) == 2


def test_it_is_saved_with_the_file(blank, tmp_path):
    scene_of(blank)
    parts.generate(tolerance=4.0)
    light(1)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "lit.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "lit.blend"))
    result = bpy.data.objects["Mirror Reflection"]
    shown = result.reflection_mesh.light_material
    parts.select(result)
    parts.generate(tolerance=4.0)
    assert {slot.material for slot in result.material_slots} == {shown}


def test_images_of_the_mirror_s_own_are_the_user_s(blank):
    """Also where nothing but the material of the light still shows them."""
    wall = scene_of(blank, "", "Fresnel")
    own = bpy.data.images.new("Scratches", 4, 4)
    tree = wall.material_slots[0].material.node_tree
    tree.nodes.new("ShaderNodeTexImage").image = own
    parts.generate()
    light(1)
    bpy.data.materials.remove(wall.material_slots[0].material)
    bpy.ops.reflection_mesh.clear()
    assert "Scratches" in bpy.data.images and "Reflection Light" not in bpy.data.images


def test_linked_objects_are_lit_under_their_names(blank, tmp_path):
    scene_of(blank, "Random")
    bpy.data.libraries.write(str(tmp_path / "library.blend"), {bpy.data.objects["Box"]})
    bpy.data.objects.remove(bpy.data.objects["Box"])
    with bpy.data.libraries.load(str(tmp_path / "library.blend"), link=True) as (_, wanted):
        wanted.objects = ["Box"]
    box = wanted.objects[0]
    blank.scene.collection.objects.link(box)
    blank.view_layer.update()
    parts.select(box, bpy.data.objects["Floor"], bpy.data.objects["Mirror"])
    result = parts.generate()
    light(1)
    assert result.reflection_mesh.light_material is not None and not box.hide_render and box.name == "Box"
