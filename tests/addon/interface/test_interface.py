"""Panels, menu, grey buttons, presets, other languages: what the user sees, and that nothing of it stays behind."""
from __future__ import annotations

import string
from itertools import product
from pathlib import Path
from types import SimpleNamespace

import bpy
import interface_words
import numpy as np
import parts
import pytest

from tools.extension_zip import PACKAGE

OPERATORS = ("generate", "light", "caustics", "bake", "clear", "live", "update", "compare", "mirror_uvs", "print_sheet")


class Layout:
    """Takes what a panel draws: labels, properties with their holders, buttons."""

    def __init__(self):
        self.labels, self.properties, self.buttons, self.menus = [], {}, [], []

    box = column = row = lambda self, align=False: self
    separator = popover = lambda self, *_, **__: None

    def label(self, text="", icon="", translate=True):
        self.labels.append(text)

    def prop(self, holder, name, text=None, translate=True):
        assert name in holder.bl_rna.properties and (text is None or not translate)
        self.properties[name] = holder

    def operator(self, name, text="", icon=""):
        assert getattr(bpy.ops, name.split(".")[0]), name
        self.buttons.append(name)
        return SimpleNamespace()

    def menu(self, name, icon=""):
        self.menus.append(name)


def drawn(room, space: str) -> Layout:
    """All panels of a space, where they are to be seen."""
    layout = Layout()
    for panel in room("addon.interface.panels").CLASSES:
        if panel.bl_space_type == space and getattr(panel, "poll", lambda _: True)(bpy.context):
            panel.draw(SimpleNamespace(layout=layout), bpy.context)
    return layout


@pytest.fixture
def scene(blank) -> bpy.types.Scene:
    """A cube and a wall mirror, 64 x 48 pixels; both selected, the mirror active."""
    cube = parts.add("cube", "Box", size=1.0, location=(0.0, -1.5, 1.0))
    cube.data.materials.append(parts.material("Plain"))
    parts.select(cube, parts.add_wall_mirror())
    blank.scene.render.resolution_x, blank.scene.render.resolution_y = 64, 48
    return blank.scene


@pytest.mark.parametrize("space", ["VIEW_3D", "PROPERTIES"])
def test_a_mirror_shows_its_role_and_the_settings_that_hold(scene, room, space):
    mirror = bpy.data.objects["Mirror"]
    layout = drawn(room, space)
    assert layout.properties["role"] == mirror.reflection_mesh
    assert layout.properties["tolerance"] == scene.reflection_mesh
    settings = {*room("addon.settings").SETTINGS, *room("addon.settings").LIGHT_SETTINGS}
    assert settings | {"role", "own_settings", "eye"} == set(layout.properties)
    mirror.reflection_mesh.own_settings = True
    layout = drawn(room, space)
    assert {layout.properties[name] for name in settings} == {mirror.reflection_mesh}
    mirror.reflection_mesh.role = "DIFFUSE"
    assert "own_settings" not in drawn(room, space).properties


def told(room, obj) -> str:
    writing = room("addon.writing")
    return writing.size_text(writing.mesh_bytes(obj.data))


@pytest.mark.parametrize("space", ["VIEW_3D", "PROPERTIES"])
def test_a_result_tells_of_itself_in_plain_words(scene, room, space):
    result = parts.generate()
    mirror = bpy.data.objects["Mirror"].reflection_mesh
    mirror.own_settings = True
    layout = drawn(room, space)
    assert layout.labels[:3] == ["Mirror Reflection", "Reflection in 'Mirror'", "Shows 'Box'"]
    assert layout.labels[3] == f"{len(result.data.polygons)} faces, {told(room, result)}"
    # the settings are those of its mirror, figures come last
    assert layout.properties["tolerance"] == mirror
    assert layout.labels[-4:][0] == "Made for 64 x 48 px" and "filled by rays" in layout.labels[-1]
    assert not any("another size" in line for line in layout.labels)
    scene.render.resolution_x = 80
    assert "The render has another size now:" in drawn(room, space).labels
    for number in range(2):
        result.reflection_mesh.sources.add().object = parts.add("plane", f"More {number}")
    bpy.context.view_layer.objects.active = result
    assert "Shows 'Box' and 2 more" in drawn(room, space).labels
    bpy.data.objects.remove(bpy.data.objects["Mirror"])
    assert "Reflection in a mirror that is gone" in drawn(room, space).labels


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
    layout = drawn(room, "VIEW_3D")
    assert layout.labels == ["Select a mirror and what it shall show"]
    assert layout.properties["tolerance"] == blank.scene.reflection_mesh
    bpy.context.view_layer.objects.active = bpy.data.objects["Camera"]
    assert drawn(room, "VIEW_3D").properties["role"]
    assert not drawn(room, "PROPERTIES").properties
    bpy.context.view_layer.objects.active = None
    assert not drawn(room, "PROPERTIES").properties
    poll = room("addon.interface.panels").REFLECTION_MESH_PT_object.poll
    assert not poll(SimpleNamespace()) and not poll(SimpleNamespace(view_layer=None))


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


def in_edit_mode() -> None:
    bpy.ops.object.mode_set(mode="EDIT")


def without_camera() -> None:
    bpy.context.scene.camera = None


def with_nothing_selected() -> None:
    parts.select()


def options(name: str, folder: Path) -> dict:
    return {"filepath": str(folder / "out")} if name in {"bake", "compare", "print_sheet"} else {}


@pytest.mark.parametrize(("obstacle", "names"), [
    (in_edit_mode, ("generate", "light", "bake", "clear", "compare", "mirror_uvs")),
    (without_camera, ("generate", "light", "bake", "compare", "mirror_uvs")),
    (with_nothing_selected, ("generate", "bake", "compare", "mirror_uvs", "print_sheet")),
])
def test_a_grey_button_says_what_a_run_would(scene, room, tmp_path, monkeypatch, obstacle, names):
    if "light" in names:
        result = parts.generate()
        parts.select(bpy.data.objects["Box"], bpy.data.objects["Mirror"])
        assert result
    assert all(getattr(bpy.ops.reflection_mesh, name).poll() for name in names)
    obstacle()
    try:
        assert not any(getattr(bpy.ops.reflection_mesh, name).poll() for name in names)
        told = {name: parts.refusal(getattr(bpy.ops.reflection_mesh, name), **options(name, tmp_path))
                for name in names}
        monkeypatch.setattr(room("addon.operators.polls"), "passes", lambda *_: True)
        assert told == {name: parts.refusal(getattr(bpy.ops.reflection_mesh, name), **options(name, tmp_path))
                        for name in names}
        # Blender cuts off what is longer
        assert all(len(sentence.encode()) < 200 for sentence in told.values())
    finally:
        if bpy.context.mode != "OBJECT":
            bpy.ops.object.mode_set(mode="OBJECT")


def test_light_without_a_reflection_is_grey(scene, room):
    assert not bpy.ops.reflection_mesh.light.poll()
    assert "generate one first" in parts.refusal(bpy.ops.reflection_mesh.light)


def test_clear_is_grey_where_nothing_is_left_to_clear(scene, room, monkeypatch):
    """Not so while a window still has to be brought back; and scripts in the background may clear to be sure."""
    clear, mirror, polls = bpy.ops.reflection_mesh.clear, bpy.data.objects["Mirror"], room("addon.operators.polls")
    assert clear.poll() and clear() == {"CANCELLED"}
    monkeypatch.setattr(polls, "bpy", SimpleNamespace(app=SimpleNamespace(background=False)))
    assert not clear.poll() and parts.refusal(clear) == "The scene has no reflection to clear."
    parts.generate()
    assert clear.poll() and clear() == {"FINISHED"} and not clear.poll()
    mirror.reflection_mesh.camera_hidden = True
    assert clear.poll()
    mirror.reflection_mesh.camera_hidden = False
    # of crowds a run tells
    monkeypatch.setattr(polls, "LOOKED_THROUGH", 2)
    assert clear.poll() and clear() == {"CANCELLED"}


def test_roles_and_results_need_no_selection(scene):
    parts.generate()
    parts.select()
    bpy.context.view_layer.objects.active = bpy.data.objects["Mirror Reflection"]
    assert bpy.ops.reflection_mesh.generate.poll()
    bpy.context.view_layer.objects.active = None
    assert not bpy.ops.reflection_mesh.generate.poll()
    bpy.data.objects["Mirror"].reflection_mesh.role = "MIRROR"
    assert bpy.ops.reflection_mesh.generate.poll()


def test_a_button_that_is_grey_says_what_a_run_would(blank, room):
    """Whatever is selected, whatever its role and its material, in all combinations: with one object that is no mirror,
    as in a new file, the button is grey, and it is never grey where a run would find a mirror."""
    reading = room("addon.reading")
    ball, box, lamp = parts.add("uv_sphere", "Ball"), parts.add("cube", "Box"), None
    bpy.ops.object.light_add()
    lamp = blank.object
    ball.data.materials.append(parts.material("Chrome", "GLOSSY"))
    result = parts.add("plane", "Result")
    result.reflection_mesh.role = "REFLECTION"
    kinds: dict = {}
    for roles in product(("AUTO", "MIRROR", "DIFFUSE", "IGNORE"), repeat=2):
        ball.reflection_mesh.role, box.reflection_mesh.role = roles
        for mirror, chosen in product((None, ball, box), product((False, True), repeat=4)):
            result.reflection_mesh.mirror = mirror
            selected = [obj for obj, is_one in zip((ball, box, lamp, result), chosen) if is_one]
            for active in (None, box, lamp):
                parts.select(*selected)
                blank.view_layer.objects.active = active
                told = room("addon.operators.polls").has_mirror(blank)
                kinds[bool(told), len(selected)] = True
                if told:
                    with pytest.raises(room("core").ReflectionError) as refused:
                        reading.choose(blank)
                    assert str(refused.value) == told
    assert {(True, 0), (True, 1), (False, 1), (False, 2)} <= set(kinds)
    bpy.ops.wm.read_homefile(use_factory_startup=True)
    assert [obj.name for obj in bpy.context.selected_objects] == ["Cube"]
    assert not bpy.ops.reflection_mesh.generate.poll() and parts.refusal() == reading.NO_MIRROR
    bpy.ops.object.select_all(action="SELECT")
    assert not bpy.ops.reflection_mesh.generate.poll()


def test_polls_do_not_look_through_crowds(scene, room, monkeypatch):
    """Which would take longer than a redraw may; a run tells then."""
    parts.select()
    bpy.context.view_layer.objects.active = None
    assert not bpy.ops.reflection_mesh.generate.poll() and not bpy.ops.reflection_mesh.light.poll()
    monkeypatch.setattr(room("addon.operators.polls"), "LOOKED_THROUGH", 2)
    assert bpy.ops.reflection_mesh.generate.poll() and bpy.ops.reflection_mesh.light.poll()
    assert parts.refusal().startswith("No mirror")


@pytest.mark.parametrize("context", [SimpleNamespace(), SimpleNamespace(scene=None), SimpleNamespace(view_layer=None),
                                     SimpleNamespace(scene=None, view_layer=None, mode="EDIT_MESH")])
def test_polls_take_contexts_that_lack_everything(context):
    for cls in interface_words.classes():
        if issubclass(cls, bpy.types.Operator) and cls.bl_idname != "reflection_mesh.preset_add":
            assert cls.poll(context) is False


def fields(text: str) -> list:
    """What is put into a text, with its formats."""
    return sorted(entry[1:3] for entry in string.Formatter().parse(text) if entry[1])


def test_no_word_lacks_its_german(scene, room):
    german = room("addon.interface.german").GERMAN
    drawn_names = set(drawn(room, "VIEW_3D").properties)
    known = interface_words.words(drawn_names)
    assert len(known) > 100 and known == set(german)
    for word, translation in german.items():
        assert translation and fields(word) == fields(translation)


def test_blender_is_given_the_words_in_both_contexts(room, monkeypatch):
    translations, faults, told = room("addon.interface.translations"), room("addon.faults.told"), {}
    fake = SimpleNamespace(register=told.__setitem__, unregister=told.pop)
    monkeypatch.setattr(translations, "bpy", SimpleNamespace(app=SimpleNamespace(translations=fake)))
    for name in ("_known", "_stages"):
        # what is known while the extension is on is that of all tests
        monkeypatch.setattr(faults, name, [])
    translations.register()
    (words,) = told.values()
    assert {("*", "Tolerance"), ("Operator", "Generate Reflection"), ("*", "Sharpening the light")} <= set(words["de"])
    assert set(words["de"]) == set(words["de_DE"]) and faults._known and faults._stages
    translations.unregister()
    assert told == {} and not (faults._known or faults._stages)


def traces() -> list:
    """What of the extension Blender holds: types, manual, presets, menu entries."""
    names = [name for name in dir(bpy.types) if "reflection_mesh" in name.lower() or name.startswith("Reflection")]
    menu = [function for function in bpy.types.VIEW3D_MT_object.draw._draw_funcs
            if function.__module__.startswith(PACKAGE)]
    manual = [function for function in bpy.utils._manual_map if function.__module__.startswith(PACKAGE)]
    presets = [path for path in bpy.utils._preset_path_registry if "reflection_mesh" in path]
    return [names, menu, manual, presets]


def test_switching_off_leaves_nothing(blank):
    before = traces()
    assert all(before)
    bpy.ops.preferences.addon_disable(module=PACKAGE)
    try:
        gone = traces()
    finally:
        bpy.ops.preferences.addon_enable(module=PACKAGE)
    assert gone == [[], [], [], []]
    assert list(map(len, traces())) == list(map(len, before))


def test_presets_that_come_along_set_what_is_shown(scene, room):
    paths = {Path(path).stem: path for folder in bpy.utils.preset_paths("reflection_mesh")
             for path in map(str, Path(folder).glob("*.py"))}
    assert {"Draft", "Standard", "Final"} <= set(paths)
    mirror, menu = bpy.data.objects["Mirror"].reflection_mesh, "REFLECTION_MESH_PT_presets"
    mirror.own_settings = True
    for holder, other in ((mirror, scene.reflection_mesh), (scene.reflection_mesh, mirror)):
        other.tolerance = 7.0
        for path in paths.values():
            holder.tolerance = 9.0
            assert bpy.ops.script.execute_preset(filepath=path, menu_idname=menu) == {"FINISHED"}
            assert holder.tolerance < 9.0 and other.tolerance == 7.0
        mirror.own_settings = False
    bpy.ops.script.execute_preset(filepath=paths["Standard"], menu_idname=menu)
    standard = {name: getattr(scene.reflection_mesh, name) for name in room("addon.settings").SETTINGS}
    for name in standard:
        scene.reflection_mesh.property_unset(name)
    assert standard == {name: getattr(scene.reflection_mesh, name) for name in standard}


@pytest.mark.parametrize("role", ["REFLECTION", "CAUSTICS"])
def test_a_preset_sets_the_mirrors_settings_from_what_was_made_of_it(scene, role):
    made, mirror = parts.add("plane", "Made"), bpy.data.objects["Mirror"]
    made.reflection_mesh.role, made.reflection_mesh.mirror, mirror.reflection_mesh.own_settings = role, mirror, True
    parts.select(made)
    add = bpy.ops.reflection_mesh.preset_add
    mirror.reflection_mesh.tolerance = 3.0
    try:
        assert add(name="My Look") == {"FINISHED"}
        for path in (bpy.utils.preset_find(name, "reflection_mesh") for name in ("My_Look", "Draft")):
            mirror.reflection_mesh.tolerance = 9.0
            bpy.ops.script.execute_preset(filepath=path, menu_idname="REFLECTION_MESH_PT_presets")
            assert mirror.reflection_mesh.tolerance < 9.0 and scene.reflection_mesh.tolerance == 0.5
    finally:
        assert add(name="My Look", remove_name=True) == {"FINISHED"}


def test_a_preset_of_the_users_own_is_saved_applied_and_removed(scene):
    settings = scene.reflection_mesh
    settings.tolerance, settings.method, settings.light_samples, settings.memory = 3.0, "PARALLEL", 11, 1.5
    add = bpy.ops.reflection_mesh.preset_add
    assert add(name="My Look") == {"FINISHED"}
    path = bpy.utils.preset_find("My_Look", "reflection_mesh")
    assert path and PACKAGE.rpartition(".")[2] in path
    settings.tolerance, settings.method, settings.light_samples, settings.memory = 0.5, "GENERAL", 64, 2.0
    bpy.ops.script.execute_preset(filepath=path, menu_idname="REFLECTION_MESH_PT_presets")
    assert (settings.tolerance, settings.method, settings.light_samples) == (3.0, "PARALLEL", 11)
    # which is the machine's
    assert settings.memory == 2.0
    assert add(name="My Look", remove_name=True) == {"FINISHED"} and not Path(path).exists()


def test_the_manual_tells_of_operators_and_settings(room):
    root, pages = room("addon.interface.manual").pages()
    manifest = (Path(room("addon.interface.manual").__file__).parents[2] / "blender_manifest.toml").read_text()
    assert f'website = "{root}"' in manifest
    headings = (interface_words.ROOT / "docs" / "manual.md").read_text(encoding="utf-8").lower()
    assert pages and all(f"\n## {anchor.removeprefix('#')}\n" in headings for _, anchor in pages)
