"""Light that mirrors throw, in the light that stays with the objects: mirrors show it as Cycles shows its meshes."""
from __future__ import annotations

import bpy
import lamp_scenes
import numpy as np
import parts
import pytest
from lamp_scenes import picture, psnr


def scene_of(context: bpy.types.Context, source: str = "", mirror: str = "") -> bpy.types.Object:
    """A box and a floor before a wall mirror, which throws light of two lamps on both; returns its reflection."""
    wall = lamp_scenes.scene_of(context, source, mirror)
    area = next(obj for obj in context.scene.objects if obj.type == "LIGHT")
    bpy.ops.object.light_add(type="SPOT", location=(0.5, -4.0, 3.0), rotation=(1.0, 0.0, 0.1))
    spot = context.object
    spot.data.energy, spot.data.color, spot.data.spot_size = 600.0, (1.0, 0.5, 0.2), 0.6
    shown = [bpy.data.objects[name] for name in ("Box", "Floor")]
    parts.select(*shown, area, spot, wall)
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    parts.select(*shown, wall)
    return parts.generate()


def thrown() -> list:
    return [obj for obj in bpy.data.objects if obj.reflection_mesh.role == "CAUSTICS"]


def hide(objects: list, hidden: bool = True) -> None:
    for obj in objects:
        obj.hide_render = hidden


def light(samples: int = 64) -> None:
    assert bpy.ops.reflection_mesh.light(samples=samples) == {"FINISHED"}


# a tube has two sides that are seen
@pytest.mark.slow
@pytest.mark.parametrize(("source", "mirror"), [("", "Tint"), ("Light path", ""), ("Backfacing", ""),
                                                ("UV", "Textured tint")])
def test_a_mirror_shows_it(blank, room, source, mirror):
    result = scene_of(blank, source, mirror)
    if source == "Backfacing":  # light knows colours by the front
        tree = bpy.data.objects["Box"].data.materials[0].node_tree
        tree.nodes.remove(next(node for node in tree.nodes if node.type == "MIX"))
    result.hide_render = True
    reference, other = picture(room), picture(room, seed=7)
    hide(thrown())
    without = psnr(picture(room), reference)
    hide(thrown(), False)
    result.hide_render = False
    assert len(thrown()) == 2 and without < 28.0
    light()
    assert psnr(picture(room), reference) > psnr(other, reference)


@pytest.mark.slow
def test_what_is_hidden_takes_no_part(blank, room):
    """Neither light nor what it falls on."""
    result = scene_of(blank)
    seen = []
    for hidden in (True, False):
        hide(thrown(), hidden)
        light(1)
        image = next(image for image in bpy.data.images if image.name.startswith("Reflection Light"))
        seen.append(np.array(image.pixels[:]).reshape(-1, 4)[:, :3].mean())
    assert seen[1] > 1.04 * seen[0]
    bpy.data.objects["Box"].hide_render = True
    # its light would hang in the air, where reflections show the world
    lamps = [obj for obj in blank.scene.objects if obj.type == "LIGHT"]
    parts.select(bpy.data.objects["Floor"], *lamps, bpy.data.objects["Mirror"])
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    parts.select(bpy.data.objects["Floor"], bpy.data.objects["Mirror"])
    parts.generate()
    result.hide_render = True
    reference, other = picture(room), picture(room, seed=7)
    result.hide_render = False
    light()
    assert psnr(picture(room), reference) > psnr(other, reference)
