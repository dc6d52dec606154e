"""The panel's one prompt: what it says first, that it fits, and that nothing moves when it says something else."""
from __future__ import annotations

from types import SimpleNamespace

import bpy
import blf
import parts
import pytest
from drawn_panels import pair

AT_FIRST = 292  # pixels, the sidebar's width before anybody has changed it
ICON_AND_MARGINS = 87   # of these, as measured in a window


class Stack:
    """A layout that knows how many rows high it is, and which labels and buttons it has."""

    def __init__(self, beside: bool = False):
        self.beside, self.parts, self.labels, self.buttons = beside, [], [], []

    @property
    def rows(self) -> int:
        heights = [part.rows if isinstance(part, Stack) else part for part in self.parts]
        return max(heights, default=1) if self.beside else sum(heights)

    def _inside(self, beside: bool) -> Stack:
        self.parts.append(Stack(beside))
        self.parts[-1].labels, self.parts[-1].buttons = self.labels, self.buttons
        return self.parts[-1]

    def column(self, align=False) -> Stack:
        return self._inside(False)

    box = column

    def row(self, align=False) -> Stack:
        return self._inside(True)

    def split(self, factor) -> Stack:
        return self._inside(True)

    def label(self, text="", icon="", translate=True) -> None:
        self.parts.append(1)
        self.labels.append(text)

    def operator(self, name, text="", icon="") -> SimpleNamespace:
        self.parts.append(1)
        self.buttons.append(SimpleNamespace(name=name))
        return self.buttons[-1]

    def prop(self, *_, **__) -> None:
        self.parts.append(1)

    menu = prop


class Seen:
    """The context of a panel in a region of some width, in a 3D viewport of some shading."""

    def __init__(self, width: int = AT_FIRST, shading: str = "MATERIAL"):
        kinds = bpy.types.View3DShading.bl_rna
        self.region = SimpleNamespace(width=width)
        self.space_data = SimpleNamespace(type="VIEW_3D", shading=SimpleNamespace(type=shading, bl_rna=kinds))

    def __getattr__(self, name):
        return getattr(bpy.context, name)


def drawn(room, context: Seen) -> Stack:
    layout = Stack()
    room("addon.interface.panels").REFLECTION_MESH_PT_main.draw(SimpleNamespace(layout=layout), context)
    return layout


def said(room, **options) -> str:
    obj = bpy.context.view_layer.objects.active
    return room("addon.interface.prompts").prompt(Seen(**options), obj).text


@pytest.fixture
def scene(blank):
    scene = pair(blank)
    bpy.data.objects["Box"].data.materials[0] = parts.material("Paint", "DIFFUSE")
    bpy.data.objects["Mirror"].data.materials.append(parts.material("Chrome", "GLOSSY"))
    bpy.ops.object.light_add(type="POINT", location=(0.0, -3.0, 3.0))
    parts.select(bpy.data.objects["Box"], bpy.data.objects["Mirror"])
    return scene


STEPS = (
    ("SOLID", "Select a mirror, then click Generate Reflection.", lambda: None),
    ("SOLID", "Solid shading shows reflections without light and textures.", lambda: parts.generate()),
    ("MATERIAL", "Not lit yet. Click Light Reflection.", lambda: None),
    ("MATERIAL", "Lit.", lambda: bpy.ops.reflection_mesh.light(samples=1)),
    # mirrors show the light of caustics
    ("WIREFRAME", "1 result is out of date: an object has changed. Click Update Reflections.",
     lambda: bpy.ops.reflection_mesh.caustics()),
    ("WIREFRAME", "Wireframe shading shows no caustics, and no light in reflections.",
     lambda: bpy.ops.reflection_mesh.light(samples=1)),
    ("WIREFRAME", "2 results are out of date: the mirror has changed. Click Update Reflections.", lambda: _move()),
    ("MATERIAL", "Select a mirror, then click Generate Reflection.", lambda: bpy.ops.reflection_mesh.clear()),
)


def _move() -> None:
    bpy.data.objects["Mirror"].location.y += 0.1
    bpy.context.view_layer.update()


def test_one_thing_at_a_time_is_told_and_nothing_moves(scene, room):
    """From the first click on: the panel's rows and buttons stay where they are, whatever is active."""
    shapes = set()
    for shading, wanted, act in STEPS:
        act()
        bpy.context.view_layer.update()
        assert said(room, shading=shading) == wanted
        for active in (bpy.context.view_layer.objects.active, bpy.data.objects["Mirror"], bpy.data.objects["Camera"],
                       None):
            bpy.context.view_layer.objects.active = active
            layout = drawn(room, Seen(shading=shading))
            buttons = [button.name for button in layout.buttons if button.name != "wm.context_set_enum"]
            shapes.add((layout.rows, *buttons))
        bpy.context.view_layer.objects.active = bpy.data.objects["Mirror"]
    assert len(shapes) == 1


@pytest.mark.parametrize("language", ["ENGLISH", "GERMAN"])
@pytest.mark.parametrize("width", [AT_FIRST, 200])
def test_every_prompt_is_read_to_its_end(scene, room, monkeypatch, width, language):
    prompts, german = room("addon.interface.prompts"), room("addon.interface.german").GERMAN
    if language == "GERMAN":
        monkeypatch.setattr(prompts, "pgettext_iface", lambda text: german.get(text, text))
    blf.size(0, bpy.context.preferences.ui_styles[0].widget.points)
    longest_word = max(blf.dimensions(0, word)[0] for text in german.values() for word in text.split())
    for shading, _, act in STEPS:
        act()
        bpy.context.view_layer.update()
        whole, layout = said(room, width=width, shading=shading), drawn(room, Seen(width, shading))
        lines = layout.labels[layout.labels.index("Seen From") + 1:] if "Seen From" in layout.labels else layout.labels
        assert whole in " ".join(lines)
        assert all(blf.dimensions(0, line)[0] <= max(width - ICON_AND_MARGINS, longest_word)
                   for line in lines if line in whole)
        bpy.context.view_layer.objects.active = bpy.data.objects["Mirror"]


@pytest.mark.parametrize(("shading", "engine", "shown"), [
    ("SOLID", "CYCLES", False), ("WIREFRAME", "CYCLES", False), ("MATERIAL", "CYCLES", True),
    ("RENDERED", "CYCLES", True), ("RENDERED", "BLENDER_WORKBENCH", False)])
def test_a_viewport_that_does_not_show_results_is_told_of_with_a_way_out(scene, room, shading, engine, shown):
    scene.render.engine = engine
    parts.generate()
    layout = drawn(room, Seen(shading=shading))
    buttons = [button for button in layout.buttons if button.name == "wm.context_set_enum"]
    assert ("without light" in said(room, shading=shading)) == (not shown) == bool(buttons)
    for button in buttons:
        assert (button.data_path, button.value) == ("space_data.shading.type", "MATERIAL")
        bpy.types.View3DShading.bl_rna.properties["type"].enum_items[button.value]
    # what is hidden is missed in no viewport
    bpy.context.view_layer.objects.active.hide_set(True)
    assert "shading shows" not in said(room, shading=shading)
    # the Properties editor has no shading
    bpy.context.view_layer.objects.active.hide_set(False)
    assert "shading" not in room("addon.interface.prompts").prompt(bpy.context, None).text


def test_previews_have_the_colours_of_what_they_show_in_solid_too(scene):
    """Viewports in Solid show no nodes: there all was grey."""
    paint = bpy.data.objects["Box"].data.materials[0]
    paint.node_tree.nodes["Diffuse BSDF"].inputs["Color"].default_value = (0.8, 0.1, 0.05, 1.0)
    result = parts.generate(preview=True)
    assert [tuple(slot.material.diffuse_color) for slot in result.material_slots] == [
        pytest.approx((0.8, 0.1, 0.05, 1.0))]


def test_caustics_are_seen_in_solid_where_they_fall(scene):
    bpy.ops.reflection_mesh.caustics()
    light, = (obj for obj in bpy.data.objects if obj.reflection_mesh.role == "CAUSTICS")
    assert all(0.0 < material.diffuse_color[3] < 0.5 for material in light.data.materials)


def test_the_info_editor_shows_no_records(room):
    """It lists every option of an operator that ran: what only the program knows must be none."""
    for name in dir(bpy.ops.reflection_mesh):
        properties = getattr(bpy.ops.reflection_mesh, name).get_rna_type().properties
        assert [known.identifier for known in properties if known.is_hidden and known.type == "STRING"] in (
            [], ["filter_glob"]), name
