"""Taking pictures of Blender's window: a sample that is opened, what is active in it, and parts of screenshots that are
joined."""
from __future__ import annotations

import subprocess

import bpy
import hands
from hands import ROOT

FOLDER = ROOT / "docs" / "pictures"
MIRROR = "Golden Ball"
PANELS = 694        # pixels of the sidebar, from its upper end
GAP, GROUND = 12, "#303030"


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
        bpy.ops.reflection_mesh.generate("EXEC_DEFAULT", select_alone=True, collect=True, preview=True,
                                         protect=True, **options)


def alone(name: str) -> bpy.types.Object:
    """The object of that name, active and selected alone."""
    obj = bpy.data.objects[name]
    for other in bpy.context.view_layer.objects:
        other.select_set(other == obj)
    bpy.context.view_layer.objects.active = obj
    return obj


def dragged(screen: hands.Screen, at_x: int, at_y: int, **by: int):
    """What lies at a place is pulled by so many pixels to the right (x) and up (y)."""
    screen.point(at_x, at_y)
    yield 0.5
    screen.window.event_simulate("LEFTMOUSE", "PRESS", **screen.at)
    yield 0.2
    # it begins to follow only once the mouse has moved a little
    for _ in range(10):
        screen.move(**{axis: pixels // 10 for axis, pixels in by.items()})
        yield 0.1
    screen.window.event_simulate("LEFTMOUSE", "RELEASE", **screen.at)
    yield 0.5


def sidebar(screen: hands.Screen, name: str, height: int = PANELS) -> list[str]:
    return part(name, *corner(screen), screen.region("UI").width, height)


def corner(screen: hands.Screen) -> tuple[int, int]:
    """The upper left one of the sidebar; y counts from above."""
    region = screen.region("UI")
    return region.x, screen.window.height - region.y - region.height


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
