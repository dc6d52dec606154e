"""The documents' pictures of Blender's window: buttons, panels, menu, search and status bar as they are today.

    blender --enable-event-simulate --python tools/window_pictures.py [-- picture ...]

from the folder of this repository, on an X screen of 1600 x 900 with ImageMagick (`make window-pictures` has one). It
installs the extension as a zip, into preferences that are thrown away (BLENDER_USER_RESOURCES), opens samples, and
leaves in docs/pictures

- `blender.jpg`: the sphere, its reflection active, in the sidebar and in Object properties;
- `settings.jpg`: the sidebar with a mirror, with its reflection, and in German, with settings of the mirror's own;
- `ways_in.jpg`: the menu, F3, and progress in the status bar;
- `stale.jpg`: what the sidebar says of a reflection that is stale, and while Live is on;
- `choices.jpg`: the roles, the presets, and the settings with *Limits* unfolded;
- `after_run.jpg`: the panels that F9 opens after Generate and after Light.
"""
import importlib
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests" / "window"))

import bpy
import hands
from hands import ROOT

FOLDER = ROOT / "docs" / "pictures"
MIRROR = "Golden Ball"
STATUS = 24         # pixels, the height of the status bar
PANELS = 648        # of the sidebar, from its upper end
GERMAN = 590        # of the same where another language has scrolled it
WAYS = 280          # the height of the pictures of the menu and of F3
GAP, GROUND = 12, "#303030"


def steps():
    hands.SHOTS = Path(tempfile.mkdtemp())
    screen = hands.Screen()
    screen.point(**screen.centre)
    yield 1.0
    screen.press("ESC")
    bpy.ops.extensions.package_install_files(filepath=str(hands.built_zip()), repo="user_default",
                                             enable_on_install=True)
    yield 1.0
    bake = importlib.import_module("bl_ext.user_default.reflection_mesh.addon.operators.bake_frames.bake")
    # those that Linux distributions build have none, and a grey button
    bake.writes_usd = lambda: True
    asked = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
    for name, take in PICTURES.items():
        if not asked or name in asked:
            yield from take()


def opened(sample: str):
    """A sample, seen through its camera, with the extension's tab in the sidebar; returns the screen."""
    bpy.ops.wm.open_mainfile(filepath=str(ROOT / "sample_blends" / f"{sample}.blend"), load_ui=False)
    yield 2.0
    screen = hands.Screen()
    space = screen.area.spaces.active
    space.region_3d.view_perspective, space.shading.type = "CAMERA", "MATERIAL"
    space.shading.use_scene_world = space.shading.use_scene_lights = space.show_region_ui = True
    space.region_3d.view_camera_zoom = 12.0
    yield from hands.waiting(lambda: hands.turned_to_tab(screen), "the tab Reflection", 20.0)
    screen.point(**screen.centre)
    return screen


def generate(screen: hands.Screen, **options) -> None:
    with screen.context():
        bpy.ops.reflection_mesh.generate("EXEC_DEFAULT", select_alone=True, collect=True, preview=True, **options)


def alone(name: str) -> bpy.types.Object:
    """The object of that name, active and selected alone."""
    obj = bpy.data.objects[name]
    for other in bpy.context.view_layer.objects:
        other.select_set(other == obj)
    bpy.context.view_layer.objects.active = obj
    return obj


def whole_window():
    screen = yield from opened("sphere")
    generate(screen)
    editor = next(area for area in screen.window.screen.areas if area.type == "PROPERTIES")
    editor.spaces.active.context = "OBJECT"
    editor.spaces.active.search_filter = "Reflection Mesh"
    yield from hands.settled("window")
    joined("blender", [part("window", 0, 0, screen.window.width, screen.window.height)])


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


def ways_in():
    screen = yield from opened("room")
    alone(MIRROR)
    area = screen.area
    screen.point(area.x + 120, area.y + 420)
    yield 0.5
    with screen.context():
        bpy.ops.wm.call_menu(name="VIEW3D_MT_reflection_mesh")
    yield from hands.settled("menu")
    screen.press("ESC")
    yield 0.5
    yield from screen.search("reflection")
    yield from hands.settled("search")
    screen.press("ESC")
    yield 0.5
    bpy.context.scene.reflection_mesh.tolerance = 0.003
    screen.point(**screen.centre)
    with screen.context():
        bpy.ops.reflection_mesh.generate("INVOKE_DEFAULT")
    yield 7.0
    hands.shot("progress")
    screen.press("ESC")
    yield from hands.waiting(lambda: not screen.window.modal_operators, "the end after ESC")
    joined("ways_in", [part("menu", 0, screen.window.height - WAYS - 280, 460, WAYS),
                       part("search", 640, 405, 540, WAYS)],
           below=part("progress", 0, screen.window.height - STATUS, 460 + GAP + 540, STATUS))


def stale():
    screen = yield from opened("room")
    generate(screen)
    bpy.context.scene.camera.location.x += 0.3
    yield from hands.settled("stale")
    bpy.ops.reflection_mesh.live()
    yield 5.0
    yield from hands.settled("live")
    joined("stale", [sidebar(screen, name, 420) for name in ("stale", "live")])


def choices():
    panel = bpy.types.REFLECTION_MESH_PT_limits
    bpy.utils.unregister_class(panel)
    panel.bl_options = set()
    bpy.utils.register_class(panel)
    screen = yield from opened("room")
    generate(screen)
    yield from hands.settled("unfolded")
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
                       part("unfolded", side.x, 430, side.width, 328)])


def after_run():
    screen = yield from opened("room")
    alone(MIRROR)
    screen.point(**screen.centre)
    for name, words, made in (("generated", "generate reflection", bpy.data.objects),
                              ("lit", "light reflection", bpy.data.images)):
        yield from screen.search(words)
        screen.press("RET")
        yield from hands.waiting(lambda made=made: not screen.window.modal_operators and any(
            "Reflection" in one.name for one in made), name, 180.0)
        screen.point(**screen.centre)
        yield 0.5
        screen.press("F9")
        yield 1.0
        screen.move(x=5, y=-5)
        yield from hands.settled(name)
        screen.press("ESC")
        yield 0.5
    joined("after_run", [part("generated", 646, 410, 338, 290), part("lit", 646, 410, 338, 126)])


def sidebar(screen: hands.Screen, name: str, height: int = PANELS) -> list[str]:
    region = screen.region("UI")
    return part(name, region.x, screen.window.height - region.y - region.height, region.width, height)


def part(name: str, x: int, y: int, width: int, height: int) -> list[str]:
    """What ImageMagick is told to take this part of a screenshot; y counts from above."""
    return ["(", str(hands.SHOTS / f"{name}.png"), "+gravity", "-crop", f"{width}x{height}+{x}+{y}", "+repage", ")"]


def joined(name: str, parts: list[list[str]], below: list[str] | None = None) -> None:
    """Parts side by side as a picture of the documents, and one below them."""
    frame = ["-background", GROUND]
    spaced = [word for number, words in enumerate(parts)
              for word in (words if not number else ["(", *words, "-gravity", "West", "-splice", f"{GAP}x0", ")"])]
    command = ["convert", *frame, "(", *spaced, "-gravity", "North", "+append", ")"]
    if below is not None:
        command += ["(", *below, "-gravity", "North", "-splice", f"0x{GAP}", ")", "-append"]
    subprocess.run([*command, "-quality", "90", str(FOLDER / f"{name}.jpg")], check=True)


PICTURES = {"blender": whole_window, "settings": settings, "ways_in": ways_in, "stale": stale,
            "choices": choices, "after_run": after_run}
hands.run(steps)
