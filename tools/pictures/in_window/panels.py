"""Pictures of what stands in the window: panels, menus of settings, tips."""
from __future__ import annotations

import tempfile

import bpy
import hands

from .taking import MIRROR, alone, corner, dragged, generate, joined, opened, part, sidebar

# in pixels, below the upper end of the sidebar: where pictures of it end
GERMAN = 680        # where another language has scrolled it
GREY = 226
# the same: a button, and the headers of panels: folded, and unfolded while Settings are folded
LIGHT, SETTINGS, TOOLS, FIGURES = 149, 412, 645, 671
UNFOLDED_TOOLS, UNFOLDED_FIGURES, UNFOLDED_END = 438, 660, 800
LIMITS = 596
# below the upper end of the Properties editor: a folded panel; its header and its list's grip once it alone is unfolded
ATTRIBUTES, ATTRIBUTES_HEADER, ATTRIBUTES_GRIP = 480, 216, 366
WIDER, LONGER = 160, 240    # what is added to the editor's width and to the list
ATTRIBUTES_END = ATTRIBUTES_GRIP + LONGER + 6


def whole_window():
    screen = yield from opened("sphere")
    generate(screen)
    editor = properties(screen)
    editor.spaces.active.context = "OBJECT"
    editor.spaces.active.search_filter = "Reflection Mesh"
    yield from hands.settled("window")
    joined("blender", [part("window", 0, 0, screen.window.width, screen.window.height)])


def properties(screen: hands.Screen) -> bpy.types.Area:
    return next(area for area in screen.window.screen.areas if area.type == "PROPERTIES")


def settings():
    screen = yield from opened("room")
    alone(MIRROR)
    yield from hands.settled("mirror")
    generate(screen)
    yield from hands.settled("result")
    bpy.ops.reflection_mesh.clear()
    own = alone(MIRROR).reflection_mesh
    own.own_settings, own.tolerance = True, 1.0
    language(True)
    yield 1.0
    yield from hands.settled("german")
    language(False)
    joined("settings", [sidebar(screen, "mirror"), sidebar(screen, "result"), sidebar(screen, "german", GERMAN)])


def language(german: bool) -> None:
    view = bpy.context.preferences.view
    view.language = "de_DE" if german else "en_US"
    view.use_translate_interface = view.use_translate_tooltips = german


def stale():
    screen = yield from opened("room")
    generate(screen)
    bpy.context.scene.camera.location.x += 0.3
    yield from hands.settled("stale")
    bpy.ops.reflection_mesh.live()
    yield 5.0
    yield from hands.settled("live")
    joined("stale", [sidebar(screen, name, 400) for name in ("stale", "live")])


def choices():
    screen = yield from opened("room")
    generate(screen)
    yield 1.0
    yield from pressed(screen, LIMITS)
    screen.point(**screen.centre)
    yield from hands.settled("unfolded")
    yield from pressed(screen, LIMITS)
    screen.point(screen.area.x + 120, screen.area.y + 420)
    yield 0.5
    for name, kind in (("roles", "MT_role"), ("presets", "PT_presets")):
        with screen.context():
            if kind.startswith("MT"):
                bpy.ops.wm.call_menu(name=f"REFLECTION_MESH_{kind}")
            else:
                bpy.ops.wm.call_panel(name=f"REFLECTION_MESH_{kind}")
        # before the tip comes that would cover it
        yield 0.5
        hands.shot(name)
        screen.press("ESC")
        yield 0.5
    side = screen.region("UI")
    joined("choices", [part("roles", 6, 345, 200, 130), part("presets", 6, 370, 236, 168),
                       part("unfolded", side.x, 480, side.width, 318)])


def attributes():
    screen = yield from opened("sphere")
    editor, settings = properties(screen), bpy.context.scene.reflection_mesh
    editor.spaces.active.search_filter, editor.spaces.active.context = "", "DATA"
    generate(screen)
    yield from dragged(screen, editor.x - 1, editor.y + 100, x=-WIDER)
    yield from hands.settled("widened")
    top = editor.y + editor.height
    # unfolds this panel, and folds the others
    screen.point(editor.x + 120, top - ATTRIBUTES)
    yield 0.5
    screen.press("LEFTMOUSE", ctrl=True)
    yield from hands.settled("unfolded")
    # until the list has room for all
    yield from dragged(screen, editor.x + 231, top - ATTRIBUTES_GRIP, y=-LONGER)
    screen.point(**screen.centre)
    for kept in ("ALL", "SHOWN"):
        settings.attributes = kept
        generate(screen)
        yield from hands.settled(kept)
    joined("attributes", [part(kept, editor.x + 38, screen.window.height - top + ATTRIBUTES_HEADER, editor.width - 42,
                               ATTRIBUTES_END - ATTRIBUTES_HEADER) for kept in ("ALL", "SHOWN")])
    yield from dragged(screen, editor.x - 1, editor.y + 100, x=WIDER)


def grey():
    screen = yield from opened("room")
    alone(MIRROR)
    yield 1.0
    region = screen.region("UI")
    screen.point(region.x + 130, region.y + region.height - LIGHT)
    yield 0.5
    # a tip comes once the mouse rests on the button
    screen.move(x=2)
    yield 2.0
    yield from hands.settled("grey")
    x, top = corner(screen)
    joined("grey", [part("grey", x, top, screen.window.width - x, GREY)])
    screen.point(**screen.centre)
    yield 1.0


def figures():
    screen = yield from opened("sphere")
    generate(screen)
    yield 1.0
    # the lowest first, since what is unfolded moves what is below it
    yield from pressed(screen, FIGURES, TOOLS, SETTINGS)
    with screen.context():
        bpy.ops.reflection_mesh.compare("EXEC_DEFAULT", filepath=tempfile.mkdtemp(), samples=16)
    screen.point(**screen.centre)
    yield from hands.settled("figures")
    x, top = corner(screen)
    joined("figures", [part("figures", x, top + UNFOLDED_TOOLS - 13, screen.region("UI").width,
                            UNFOLDED_END - UNFOLDED_TOOLS + 13)])
    yield from pressed(screen, UNFOLDED_FIGURES, UNFOLDED_TOOLS, SETTINGS)


def pressed(screen: hands.Screen, *below: int):
    """Clicks so many pixels below the upper end of the sidebar, one after another."""
    region = screen.region("UI")
    for pixels in below:
        yield from screen.click(region.x + 60, region.y + region.height - pixels)
        yield 1.0
