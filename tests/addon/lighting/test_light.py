"""Light: a render of the file with its lit reflection equals one without, whatever the scene has."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from lamp_scenes import picture, principled, psnr, scene_of, tinted

SOURCES = ("Generated", "Object", "Normal", "UV", "Reflection", "Bump", "Normal map", "Random", "Instances",
           "Attribute", "Gloss", "Glass", "Alpha", "Backfacing", "Light path")
MIRRORS = ("Tint", "Textured tint", "Fresnel", "Layer weight", "Half open", "Pane")
# gloss, and a texture in a mirror that has a part of its own; of others one Blender tells as much as three
QUICK = {("Gloss", ""), ("Alpha", ""), ("UV", "Fresnel")}
KINDS = [*((kind, "") for kind in SOURCES), *(("UV", kind) for kind in MIRRORS)]


@pytest.mark.feature("light")
@pytest.mark.parametrize(("source", "mirror"), [
    kinds if kinds in QUICK else pytest.param(*kinds, marks=pytest.mark.slow) for kinds in KINDS])
def test_a_lit_reflection_is_what_the_mirror_shows(blank, room, source, mirror):
    scene_of(blank, source, mirror).reflection_mesh.role = "MIRROR"
    reference, other = picture(room), picture(room, seed=7)
    parts.generate()
    before = psnr(picture(room), reference)
    assert bpy.ops.reflection_mesh.light(samples=64) == {"FINISHED"}
    lit, noise = psnr(picture(room), reference), psnr(other, reference)
    # denoised, it is nearer than another render with as many samples; what a pane lets through is not denoised
    # (measured: 0.5 dB farther; with 4096 samples 56.5 dB, where Cycles equals itself to 57.1)
    assert lit > noise + (-1.5 if mirror == "Pane" else 0.5)
    # without its light it is another picture
    assert lit > before + 6.0


@pytest.mark.slow
def test_a_mirror_that_is_an_instance_of_a_collection_is_lit_too(blank, room):
    wall = scene_of(blank, "UV", "Tint")
    library = bpy.data.collections.new("Library")
    library.objects.link(wall)
    blank.scene.collection.objects.unlink(wall)
    placed = bpy.data.objects.new("Placed", None)
    placed.instance_type, placed.instance_collection = "COLLECTION", library
    blank.scene.collection.objects.link(placed)
    placed.reflection_mesh.role = "MIRROR"
    blank.view_layer.update()
    parts.select(bpy.data.objects["Box"], bpy.data.objects["Floor"], placed)
    reference = picture(room)
    parts.generate()
    assert bpy.ops.reflection_mesh.light(samples=64) == {"FINISHED"}
    # measured: 47.1 dB
    assert psnr(picture(room), reference) > 44.5
    assert wall.visible_camera


def test_lamps_in_the_mirror_are_not_larger_than_they_are(blank, room):
    """A small lamp far brighter than white, before what is reflected: no ring around it, no halo."""
    scene_of(blank)
    lamp = next(obj for obj in blank.scene.objects if obj.type == "LIGHT")
    lamp.location, lamp.rotation_euler = (-1.3, -1.5, 1.4), (np.pi / 2, 0.0, 0.0)
    lamp.data.size, lamp.data.energy = 0.2, 60.0
    back = parts.add("plane", "Back", size=16.0, location=(0.0, -7.0, 1.0), rotation=(-np.pi / 2, 0.0, 0.0))
    back.data.materials.append(principled("Paint", (0.2, 0.3, 0.2)))
    parts.select(back, *(bpy.data.objects[name] for name in ("Box", "Floor", "Mirror")))
    reference = picture(room)
    parts.generate()
    bpy.ops.reflection_mesh.light()
    lit, white = picture(room), reference.min(axis=2) > 0.99
    assert white.sum() > 10
    # four hundred times brighter than white, its border is a step that texels cannot show without being negative;
    # measured: 42.8 dB
    # measured: 42 dB on Blender 4.5, 38.7 on 5.2
    assert psnr(lit, reference) > 37.5 and (lit.min(axis=2) > 0.99).sum() <= white.sum()
    rows, columns = np.nonzero(white)
    around = slice(rows.min() - 8, rows.max() + 9), slice(columns.min() - 8, columns.max() + 9)
    assert np.median((reference - lit)[around][~white[around]]) < 0.02
    assert (np.abs(lit - reference)[around].max(axis=2) > 0.08).sum() < 2 * white.sum()


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["Alpha", "Tint"])
def test_what_is_transparent_before_the_mirror_is_seen_once(blank, room, kind):
    """A pane between the eye and one half of the mirror is one of the sources too."""
    scene_of(blank)
    pane = parts.add("plane", "Pane", size=3.0, location=(-1.2, -2.5, 1.0), rotation=(np.pi / 2, 0.0, 0.0))
    pane.data.materials.append(principled("Film", (0.2, 0.7, 0.3), Alpha=0.4) if kind == "Alpha"
                               else tinted("Film", (0.3, 0.6, 0.5)))
    parts.select(pane, *(bpy.data.objects[name] for name in ("Box", "Floor", "Mirror")))
    blank.view_layer.update()
    reference, other = picture(room), picture(room, seed=7)
    parts.generate()
    bpy.ops.reflection_mesh.light(samples=64)
    # measured: 3.8 and 2.9 dB nearer than another render, since it is denoised
    assert psnr(picture(room), reference) > psnr(other, reference) + 1.5
    assert pane.visible_camera


@pytest.mark.slow
def test_what_stands_behind_a_mirror_that_is_half_open_is_seen_through_it(blank, room):
    scene_of(blank, "UV", "Half open")
    behind = parts.add("cube", "Behind", size=1.2, location=(-0.6, 2.0, 1.0))
    behind.data.materials.append(principled("Red", (0.9, 0.1, 0.05), **{
        "Emission Color": (1.0, 0.2, 0.1, 1.0), "Emission Strength": 2.0}))
    parts.select(*(bpy.data.objects[name] for name in ("Box", "Floor", "Mirror")))
    reference, other = picture(room), picture(room, seed=7)
    behind.hide_render = True
    assert psnr(picture(room), reference) < 30.0
    behind.hide_render = False
    parts.generate()
    assert bpy.ops.reflection_mesh.light(samples=64) == {"FINISHED"}
    # measured: 39.6 dB, where Cycles equals itself to 39.0: what is seen through the mirror is not denoised
    assert psnr(picture(room), reference) > psnr(other, reference) - 1.0


@pytest.mark.slow
def test_a_floor_that_lets_light_through_goes_on_behind_a_mirror_that_is_half_open(blank, room):
    """It is seen through the mirror, in its own reflection, as what the mirror itself is seen through must not be."""
    scene_of(blank, "UV", "Half open")
    bpy.data.objects["Floor"].data.materials[0] = principled("Film", (0.2, 0.7, 0.3), Alpha=0.5)
    pane = parts.add("plane", "Pane", size=1.0, location=(0.8, -2.5, 1.0), rotation=(np.pi / 2, 0.0, 0.0))
    pane.data.materials.append(principled("Pane", (0.7, 0.3, 0.2), Alpha=0.4))
    parts.select(*(bpy.data.objects[name] for name in ("Box", "Floor", "Mirror")))
    blank.view_layer.update()
    reference, other = picture(room), picture(room, seed=7)
    parts.generate()
    bpy.ops.reflection_mesh.light(samples=64)
    assert psnr(picture(room), reference) > psnr(other, reference) - 1.0


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["", "Tint"])
def test_light_lies_behind_what_stands_before_the_mirror_too(blank, room, kind):
    """A post before the mirror is taken away after lighting: what it hid is lit as all else."""
    scene_of(blank, "UV", kind)
    post = parts.add("cube", "Post", size=1.0, location=(0.8, -0.5, 1.0))
    post.scale = (0.3, 0.02, 3.0)
    post.visible_glossy = post.visible_diffuse = post.visible_shadow = False
    post.data.materials.append(principled("Red", (0.9, 0.1, 0.05)))
    parts.select(*(bpy.data.objects[name] for name in ("Box", "Floor", "Mirror")))
    parts.generate()
    bpy.ops.reflection_mesh.light(samples=64)
    assert post.visible_camera
    post.hide_render = True
    lit = picture(room)
    bpy.data.objects["Mirror Reflection"].hide_render = True
    reference = picture(room)
    # measured: 44.8 and 47.1 dB
    assert psnr(lit, reference) > 42.3


@pytest.mark.slow
def test_points_are_lit_too(blank, room):
    scene_of(blank)
    box = bpy.data.objects["Box"]
    box.modifiers.new("Finer", "SUBSURF").levels = 5
    box.modifiers[0].subdivision_type = "SIMPLE"
    bpy.data.objects["Floor"].select_set(False)
    reference = picture(room)
    parts.generate(method="POINTS")
    before = psnr(picture(room), reference)
    assert bpy.ops.reflection_mesh.light() == {"FINISHED"}
    # measured: 39.1 dB, and 30.9 before
    assert psnr(picture(room), reference) > before + 7.5


def test_a_mirror_is_right_beside_what_cuts_through_it(blank, room):
    """A frame that the mirror is sunk in: within the frame it shows the dark inside of that, which no result has."""
    scene_of(blank)
    bars = [parts.add("cube", f"Bar {number}", size=1.0, location=(x, 1.0, 1.0 + z), scale=(width, 0.2, height))
            for number, (x, z, width, height) in enumerate(((-1.1, 0.0, 0.2, 2.4), (1.1, 0.0, 0.2, 2.4),
                                                            (0.0, -1.1, 2.4, 0.2), (0.0, 1.1, 2.4, 0.2)))]
    for bar in bars:
        bar.data.materials.append(principled("Wood", (0.3, 0.12, 0.04)))
    blank.scene.world.color = (1.2, 1.35, 1.5)
    parts.select(*(bpy.data.objects[name] for name in ("Box", "Floor")), *bars, bpy.data.objects["Mirror"])
    reference = picture(room)
    parts.generate()
    assert bpy.ops.reflection_mesh.light() == {"FINISHED"}
    # measured: 43.9 dB
    assert psnr(picture(room), reference) > 42.0
    assert not any(bar.is_holdout for bar in bars) and all(bar.visible_camera for bar in bars)


@pytest.mark.parametrize("placement", ["VIRTUAL", "SURFACE"])
def test_results_that_lie_in_their_mirror_or_behind_it_are_lit_in_collections_too(blank, room, placement):
    """As files have them from the start; before a white mirror under a world of one colour it is seen alike."""
    wall = scene_of(blank)
    objects = [bpy.data.objects[name] for name in ("Box", "Floor")] + [wall]
    objects[1].location.y = -4.0
    inner = bpy.data.collections.new("Collection")
    blank.scene.collection.children.link(inner)
    for obj in objects:
        inner.objects.link(obj)
        blank.scene.collection.objects.unlink(obj)
    parts.select(*objects)
    reference = picture(room)
    parts.generate(placement=placement)
    seen = wall.visible_camera
    assert bpy.ops.reflection_mesh.light() == {"FINISHED"}
    # measured: 47.3 and 46.8 dB; 45.4 in Blender 5.2, which packs normals
    assert psnr(picture(room), reference) > 44.0
    assert wall.visible_camera == seen


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["Emission", "Principled"])
def test_what_shines_is_as_bright_up_to_its_outline_and_what_is_beside_as_dark(blank, room, kind):
    """Bulbs of a few pixels, up to thirty times as bright as white, before a wall and the sky: no texel between
    them and what lies beside could be both."""
    scene_of(blank)
    bpy.data.objects["Floor"].location.z = -1.5
    bulbs = []
    for number, (x, z) in enumerate(((-0.9, 0.4), (0.0, 0.5), (0.9, 0.3), (-0.8, 1.5), (0.1, 1.6), (0.8, 1.4))):
        bulbs.append(parts.add("uv_sphere", f"Bulb {number}", segments=16, ring_count=8, radius=0.1 + 0.02 * number,
                               location=(x, -1.0, z)))
        bulbs[-1].visible_camera = bulbs[-1].visible_diffuse = False
        bulbs[-1].data.materials.append(fire(f"Fire {number}", kind, (1.0, 0.6, 0.2), (4.0, 12.0, 30.0)[number % 3]))
    back = parts.add("plane", "Back", size=2.0, location=(-1.0, -3.0, 1.0), rotation=(-np.pi / 2, 0.0, 0.0))
    back.visible_camera = False
    back.data.materials.append(principled("Paint", (0.2, 0.3, 0.2)))
    parts.select(*(bpy.data.objects[name] for name in ("Box", "Floor")), back, *bulbs, bpy.data.objects["Mirror"])
    blank.scene.cycles.samples = 256
    reference = picture(room)
    parts.generate()
    assert bpy.ops.reflection_mesh.light(samples=128) == {"FINISHED"}
    # measured: 42.0 and 41.9 dB, in both
    assert psnr(picture(room), reference) > 39.4
    # what shows it knows it again where the result is made anew
    parts.generate()
    assert psnr(picture(room), reference) > 39.4
    bpy.ops.reflection_mesh.clear()
    assert not [image for image in bpy.data.images if image.name.startswith("Reflection Light")]


def fire(name: str, kind: str, colour: tuple, strength: float):
    """What shines, by a shader that does nothing else or as a part of a matte one."""
    if kind == "Principled":
        return principled(name, (0.3, 0.3, 0.3), **{"Emission Color": (*colour, 1.0), "Emission Strength": strength})
    made = parts.material(name)
    shader = made.node_tree.nodes[0]
    shader.inputs["Color"].default_value, shader.inputs["Strength"].default_value = (*colour, 1.0), strength
    return made


@pytest.mark.slow
@pytest.mark.parametrize("view", ["Standard", "AgX"])
def test_lamps_thinner_than_a_pixel_have_their_own_colours(blank, room, view):
    """Tubes of a quarter of a pixel beside one of two pixels, in another colour; what rolls highlights off shows
    how far above white they are."""
    scene_of(blank)
    bpy.data.objects.remove(bpy.data.objects["Box"])
    tubes = []
    for number, (width, colour) in enumerate(((0.03, (0.1, 0.3, 1.0)), (0.004, (1.0, 0.2, 0.1)),
                                              (0.004, (0.2, 1.0, 0.3)))):
        tubes.append(parts.add("cylinder", f"Tube {number}", radius=width, depth=1.4, rotation=(0.0, 1.4, 0.0),
                               location=(0.0, -1.0, 1.5 - 0.35 * number)))
        tubes[-1].visible_camera = False
        tubes[-1].data.materials.append(fire(f"Fire {number}", "Emission", colour, 14.0))
    parts.select(bpy.data.objects["Floor"], *tubes, bpy.data.objects["Mirror"])
    blank.scene.view_settings.view_transform = view
    blank.scene.cycles.samples = 256
    reference = picture(room)
    parts.generate()
    assert bpy.ops.reflection_mesh.light() == {"FINISHED"}
    # measured: 46.7 dB
    assert psnr(picture(room), reference) > 45.0
