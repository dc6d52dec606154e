"""Panels and the menu: what the user sees of roles, settings and results."""
from __future__ import annotations

from types import SimpleNamespace

import bpy
import interface_words
import numpy as np
import parts
import pytest
from drawn_panels import Layout, drawn, pair

OPERATORS = ("generate", "light", "caustics", "bake", "clear", "make_mirror", "live", "update", "compare", "mirror_uvs",
             "print_sheet", "select")


@pytest.fixture
def scene(blank) -> bpy.types.Scene:
    return pair(blank)


@pytest.mark.parametrize("space", ["VIEW_3D", "PROPERTIES"])
def test_a_mirror_shows_its_role_and_the_settings_that_hold(scene, room, space):
    mirror = bpy.data.objects["Mirror"]
    layout = drawn(room, space)
    assert layout.menus == ["REFLECTION_MESH_MT_role"]
    assert layout.properties["tolerance"] == scene.reflection_mesh
    settings = set(room("addon.settings.holders").ALL)
    assert settings | {"own_settings", "eye"} == set(layout.properties)
    mirror.reflection_mesh.own_settings = True
    layout = drawn(room, space)
    assert {layout.properties[name] for name in settings} == {mirror.reflection_mesh}
    mirror.reflection_mesh.role = "DIFFUSE"
    assert "own_settings" not in drawn(room, space).properties


def test_users_give_no_role_that_only_results_have(scene, room):
    """An object that somebody calls a reflection would be cleared as one."""
    layout, mirror = Layout(), bpy.data.objects["Mirror"].reflection_mesh
    room("addon.interface.menus").REFLECTION_MESH_MT_role.draw(SimpleNamespace(layout=layout), bpy.context)
    assert layout.values == [(mirror, role) for role in ("AUTO", "MIRROR", "DIFFUSE", "IGNORE")]


def told(room, obj) -> str:
    writing = room("addon.writing")
    return writing.size_text(writing.mesh_bytes(obj.data))


@pytest.mark.parametrize("space", ["VIEW_3D", "PROPERTIES"])
def test_a_result_tells_of_itself_in_plain_words(scene, room, space):
    result = parts.generate()
    mirror = bpy.data.objects["Mirror"].reflection_mesh
    mirror.own_settings = True
    layout = drawn(room, space)
    assert layout.labels[:3] == ["Mirror Reflection", "Reflected By", "Mirror"]
    assert [line for line in layout.labels if line.startswith("Shows")] == ["Shows 'Box'"]
    assert f"{len(result.data.polygons)} faces, {told(room, result)}" in layout.labels
    # the settings are those of its mirror, figures come last
    assert layout.properties["tolerance"] == mirror
    assert layout.labels[-4:][0] == "Made for 64 x 48 px" and "filled by rays" in layout.labels[-1]
    assert not any("out of date" in line for line in layout.labels)
    scene.render.resolution_x = 80
    bpy.context.view_layer.update()
    assert "1 result is out of date: the picture's size has changed. Click Update Reflections." in drawn(
        room, space).labels
    for number in range(2):
        result.reflection_mesh.sources.add().object = parts.add("plane", f"More {number}")
    bpy.context.view_layer.objects.active = result
    assert "Shows 'Box' and 2 more" in drawn(room, space).labels
    bpy.data.objects.remove(bpy.data.objects["Mirror"])
    assert {"Gone", "Its mirror or its lamp is gone. Click Clear Reflections."} <= set(drawn(room, space).labels)


@pytest.mark.parametrize("space", ["VIEW_3D", "PROPERTIES"])
def test_an_active_mirror_offers_all_that_its_result_does(scene, room, space):
    """Clicks in the viewport give the mirror."""
    result = parts.generate()
    seen = []
    for obj in (result, bpy.data.objects["Mirror"]):
        bpy.context.view_layer.objects.active = obj
        layout = drawn(room, space)
        seen.append((layout.buttons, layout.properties, set(layout.labels)))
    assert seen[0][:2] == seen[1][:2] and seen[0][2] - seen[1][2] == {"Mirror Reflection", "Reflected By"}
    assert "hide_select" in seen[1][1] and seen[1][1]["hide_select"] == result


def test_the_size_is_that_in_a_file(blank, room, tmp_path):
    grid = parts.add("grid", "Grid", x_subdivisions=150, y_subdivisions=150).data
    rng = np.random.default_rng(3)
    for kind, field, width in (("FLOAT_VECTOR", "vector", 3), ("FLOAT", "value", 1), ("FLOAT_COLOR", "color", 4)):
        entry = grid.attributes.new(kind, kind, "POINT")
        entry.data.foreach_set(field, rng.uniform(size=width * len(entry.data)).astype(np.float32))
    sizes = []
    for mesh in (grid, bpy.data.meshes.new("Empty")):
        path = tmp_path / f"{mesh.name}.blend"
        bpy.data.libraries.write(str(path), {mesh}, compress=False)
        sizes.append(path.stat().st_size)
    assert room("addon.writing").mesh_bytes(grid) == pytest.approx(sizes[0] - sizes[1], rel=0.01)


def test_nothing_and_other_things_are_drawn_too(blank, room):
    bpy.context.view_layer.objects.active = None
    parts.add_wall_mirror().data.materials.append(parts.material("Glass", "GLOSSY"))
    bpy.context.view_layer.objects.active = None
    layout = drawn(room, "VIEW_3D")
    assert layout.labels[0] == "No Active Object"
    assert "Select a mirror, then click Generate Reflection." in layout.labels
    assert layout.properties["tolerance"] == blank.scene.reflection_mesh
    bpy.context.view_layer.objects.active = bpy.data.objects["Camera"]
    assert drawn(room, "VIEW_3D").menus == ["REFLECTION_MESH_MT_role"]
    assert not drawn(room, "PROPERTIES").properties
    bpy.context.view_layer.objects.active = None
    assert not drawn(room, "PROPERTIES").properties
    poll = room("addon.interface.panels").REFLECTION_MESH_PT_object.poll
    assert not poll(SimpleNamespace()) and not poll(SimpleNamespace(view_layer=None))


@pytest.mark.parametrize("space", ["VIEW_3D", "PROPERTIES"])
def test_a_scene_without_a_mirror_says_what_makes_one(blank, room, space):
    """In the panel itself, with a button that makes the active object one; a mirror anywhere ends that."""
    box = parts.add("cube", "Box", size=1.0, location=(0.0, -1.5, 1.0))
    box.data.materials.append(parts.material("Paint"))
    parts.select(box)
    layout = drawn(room, space)
    assert [text for text in layout.labels if text.startswith("The scene has no mirror.")]
    assert "reflection_mesh.make_mirror" in layout.buttons and not bpy.ops.reflection_mesh.generate.poll()
    wall = parts.add_wall_mirror()
    parts.select(wall)
    assert bpy.ops.reflection_mesh.make_mirror() == {"FINISHED"}
    for chosen in ((wall,), (box,), ()):
        parts.select(*chosen)
        assert bpy.ops.reflection_mesh.generate.poll() and bpy.ops.reflection_mesh.bake.poll()
        layout = drawn(room, space)
        assert not [text for text in layout.labels if "no mirror" in text]
        assert "reflection_mesh.make_mirror" not in layout.buttons
    parts.select(box)
    assert parts.generate().reflection_mesh.mirror == wall


def test_every_operator_is_in_the_menu(room):
    """By which F3 finds it."""
    layout, entry = Layout(), Layout()
    menus = room("addon.interface.menus")
    menus._draw_entry(SimpleNamespace(layout=entry), bpy.context)
    assert entry.menus == ["VIEW3D_MT_reflection_mesh"]
    menus.VIEW3D_MT_reflection_mesh.draw(SimpleNamespace(layout=layout), bpy.context)
    assert layout.operator_context == "INVOKE_REGION_WIN"
    own = {cls.bl_idname for cls in interface_words.classes() if issubclass(cls, bpy.types.Operator)}
    assert set(layout.buttons) == {f"reflection_mesh.{one}" for one in OPERATORS}
    assert set(layout.buttons) == own - {"reflection_mesh.preset_add"}


def test_all_that_can_be_pressed_or_set_says_what_it_does(scene):
    assert interface_words.without_a_tip() == []


def test_numbers_have_their_units(scene, room):
    """Where Blender has the unit it writes it; where it has none, the name does."""
    for holder in (scene.reflection_mesh, bpy.data.objects["Mirror"].reflection_mesh,
                   bpy.ops.reflection_mesh.generate.get_rna_type()):
        known = getattr(holder, "bl_rna", holder).properties
        assert known["tolerance"].subtype == "PIXEL" and known["memory"].name.endswith("(GB)")
