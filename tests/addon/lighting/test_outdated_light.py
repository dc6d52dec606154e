"""Light is outdated where an input of it differs, and right again as soon as the input is back."""
from __future__ import annotations

import json
from types import SimpleNamespace

import bpy
import numpy as np
import parts
import pytest
from lamp_scenes import link, outdated, scene_of, shader_of

pytestmark = pytest.mark.thorough


@pytest.fixture
def lit(blank, room):
    """A lit result with a textured source, and whether its light is outdated or shown."""
    wall = scene_of(blank)
    image = bpy.data.images.new("Paint", 8, 8)
    tree = bpy.data.materials["Source"].node_tree
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image = image
    link(tree, node.outputs["Color"], shader_of(bpy.data.materials["Source"]).inputs["Base Color"])
    result = parts.generate(tolerance=8.0)
    bpy.ops.reflection_mesh.light(samples=1)
    material = result.reflection_mesh.light_material

    def generated() -> None:
        parts.select(result)
        parts.generate(tolerance=8.0)
    return SimpleNamespace(
        result=result, wall=wall, image=image, generated=generated, material=material, scene=blank.scene,
        box=bpy.data.objects["Box"], outdated=lambda: outdated(room, result),
        shown=lambda: {slot.material == material for slot in result.material_slots} == {True})


def place(obj):
    before = obj.location.x
    return (lambda: setattr(obj.location, "x", before + 0.25), lambda: setattr(obj.location, "x", before))


def switch(owner, name, value):
    before = getattr(owner, name)
    before = tuple(before) if hasattr(before, "__len__") else before
    return lambda: setattr(owner, name, value), lambda: setattr(owner, name, before)


def painted(image):
    def paint(value: float) -> None:
        image.pixels.foreach_set(np.full(len(image.pixels), value, dtype=np.float32))
        image.update()
        image.update_tag()
    # what is packed is an input as it is in the file
    return lambda: paint(0.7), lambda: paint(0.0)


CHANGES = {
    "place": lambda lit: place(lit.box), "camera": lambda lit: place(lit.scene.camera),
    "mirror": lambda lit: place(lit.wall), "lens": lambda lit: switch(lit.scene.camera.data, "lens", 44.0),
    "lamp": lambda lit: switch(bpy.data.lights[0], "energy", 10.0),
    "world": lambda lit: switch(lit.scene.world, "color", (0.0, 0.0, 0.1)),
    "rays": lambda lit: switch(lit.box, "visible_shadow", False),
    "hidden": lambda lit: switch(bpy.data.objects["Floor"], "hide_render", True),
    "material": lambda lit: switch(shader_of(bpy.data.materials["Source"]).inputs["Roughness"], "default_value", 0.1),
    "tint": lambda lit: switch(shader_of(lit.wall.data.materials[0]).inputs["Base Color"], "default_value",
                               (0.9, 0.5, 0.5, 1.0)),
    "bounces": lambda lit: switch(lit.scene.cycles, "max_bounces", 2),
    "size": lambda lit: switch(lit.scene.render, "resolution_x", 60),
    "pixels": lambda lit: painted(lit.image)}


@pytest.mark.parametrize("change", CHANGES)
def test_there_and_back(lit, change):
    """Check that light is current again after an undone change, as by G and ESC, and that Generate keeps it."""
    if change == "pixels":
        painted(lit.image)[1]()
        bpy.ops.reflection_mesh.light(samples=1)
        lit.material = lit.result.reflection_mesh.light_material
    there, back = CHANGES[change](lit)
    there()
    assert lit.outdated()
    back()
    assert not lit.outdated()
    lit.generated()
    assert {slot.material == lit.material for slot in lit.result.material_slots} == {True}


@pytest.mark.parametrize("change", ["place", "lamp"])
def test_light_is_found_again_after_it_was_dropped(lit, change, capfd):
    there, back = CHANGES[change](lit)
    there()
    lit.generated()
    said = "".join(capfd.readouterr())
    assert not lit.shown() and "The light of 'Mirror Reflection' no longer fits: " in said
    assert {"place": "an object has changed.", "lamp": "the lamps or the world have changed."}[change] in said
    back()
    lit.generated()
    assert lit.shown() and not lit.outdated() and "no longer fits" not in "".join(capfd.readouterr())


def test_undo_brings_the_light_back(lit):
    bpy.ops.ed.undo_push(message="Lit")
    bpy.data.objects["Camera"].location.x += 0.5
    bpy.ops.ed.undo_push(message="Dragged")
    assert lit.outdated()
    name = lit.material.name
    bpy.ops.ed.undo()
    result = bpy.data.objects["Mirror Reflection"]
    bpy.context.view_layer.update()
    parts.select(result)
    parts.generate(tolerance=8.0)
    assert {slot.material.name for slot in result.material_slots} == {name}


def test_what_no_picture_depends_on_does_not_count(lit):
    """Names, selections, what is not rendered, the cursor, and results of other mirrors."""
    for number, item in enumerate((lit.box, lit.box.data, lit.image, bpy.data.materials["Source"], lit.scene.camera)):
        item.name = f"Renamed {number}"
    lit.box.select_set(False)
    lit.scene.cursor.location = (1.0, 2.0, 3.0)
    lit.scene.cycles.seed, lit.scene.cycles.samples, lit.scene.render.engine = 5, 7, "BLENDER_WORKBENCH"
    empty = bpy.data.objects.new("Empty", None)
    lit.scene.collection.objects.link(empty)
    unseen = parts.add("cube", "Unseen")
    unseen.hide_render = True
    lit.box.display_type, lit.box.show_name = "WIRE", True
    assert not lit.outdated()
    unseen.location.x, empty.location.x = 3.0, 3.0
    assert not lit.outdated()
    lit.generated()
    assert lit.shown()


def test_it_knows_its_inputs_in_another_session(lit, room, tmp_path):
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "lit.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "lit.blend"))
    result = bpy.data.objects["Mirror Reflection"]
    assert result.reflection_mesh.lit_from and not outdated(room, result)
    bpy.data.objects["Box"].location.z += 0.1
    assert outdated(room, result)


def test_of_an_old_file_nothing_is_said(lit):
    """Whose results know nothing of what they were lit from; light of a view is made anew then."""
    lit.result.reflection_mesh.lit_from = ""
    lit.box.location.x += 0.1
    assert not lit.outdated()
    for broken in ("[]", "{", '{"view": 3}', '{"objects": 1, "lit_with": 3, "mirrors": 5}'):
        lit.result.reflection_mesh.lit_from = broken
        lit.outdated()
    lit.generated()
    assert not lit.shown()


@pytest.mark.parametrize("change", ["camera", "place", "lamp"])
def test_update_lights_again_as_it_was_lit(lit, change):
    bpy.ops.reflection_mesh.light(samples=3)
    lit.scene.reflection_mesh.light_samples = 5
    first = lit.result.reflection_mesh.light_material
    parts.select(lit.box)
    CHANGES[change](lit)[0]()
    assert lit.outdated()
    assert bpy.ops.reflection_mesh.update() == {"FINISHED"}
    record = lit.result.reflection_mesh
    assert {slot.material == record.light_material for slot in lit.result.material_slots} == {True}
    assert not lit.outdated() and record.light_material != first
    assert json.loads(record.lit_from)["lit_with"] == {"samples": 3}


def test_update_says_why_light_cannot_be_made(lit, monkeypatch, room, capfd):
    core, place = room("core"), room("addon.live.update")

    def refused(*_):
        raise core.ReflectionError("Cycles is not available.")
        yield
    monkeypatch.setattr(place, "lit_again", refused)
    lit.box.location.x += 0.2
    assert bpy.ops.reflection_mesh.update() == {"FINISHED"}
    assert "Cycles is not available." in "".join(capfd.readouterr()) and not lit.shown()


def test_from_elsewhere_light_stays_and_is_outdated(lit, capfd):
    """Its texels are found again by the points that they show."""
    place(lit.scene.camera)[0]()
    lit.generated()
    assert lit.shown() and lit.outdated() and "no longer fits" not in "".join(capfd.readouterr())


def test_what_collections_instance_counts(blank, room):
    scene_of(blank, "Instances")
    result = parts.generate(tolerance=8.0)
    bpy.ops.reflection_mesh.light(samples=1)
    inner = bpy.data.objects["Inner"]
    assert not outdated(room, result)
    for name, value in (("scale", (0.5, 0.6, 0.6)), ("visible_shadow", False)):
        there, back = switch(inner, name, value)
        there()
        assert outdated(room, result)
        back()
        assert not outdated(room, result)
