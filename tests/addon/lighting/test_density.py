"""Light that is brighter than white and finer than a pixel has texels that are finer, of as many samples."""
from __future__ import annotations

from types import SimpleNamespace

import bpy
import bmesh
import numpy as np
import parts
import pytest
from lamp_scenes import SIZE, link, picture, psnr, scene_of


def checked_card(strength: float, checks: int) -> bpy.types.Object:
    """A card in place of the scene's things, out of the camera's sight, with checks that shine beside dark ones."""
    for name in ("Box", "Floor"):
        bpy.data.objects.remove(bpy.data.objects[name])
    card = parts.add("plane", "Card", size=3.0, location=(0.3, -1.5, 1.0), rotation=(-np.pi / 2, 0.0, 0.4))
    made = parts.material("Checks")
    tree, shader = made.node_tree, made.node_tree.nodes["Emission"]
    pattern, where = tree.nodes.new("ShaderNodeTexChecker"), tree.nodes.new("ShaderNodeTexCoord")
    pattern.inputs["Scale"].default_value = checks
    pattern.inputs["Color1"].default_value = (1.0, 0.8, 0.4, 1.0)
    pattern.inputs["Color2"].default_value = (0.01, 0.005, 0.002, 1.0)
    shader.inputs["Strength"].default_value = strength
    link(tree, where.outputs["UV"], pattern.inputs["Vector"])
    link(tree, pattern.outputs["Color"], shader.inputs["Color"])
    card.data.materials.append(made)
    card.visible_camera = False
    parts.select(card, bpy.data.objects["Mirror"])
    return card


@pytest.mark.thorough
def test_checks_that_shine_look_as_in_the_mirror(blank, room):
    """Two and a half pixels wide, against Cycles and its own noise."""
    scene_of(blank)
    checked_card(6.0, 30)
    blank.scene.cycles.samples = 512
    reference = picture(room)
    parts.generate()
    bpy.ops.reflection_mesh.light(samples=128, kind="PICTURE", every=True)
    # measured: 41.3 dB, by Blender 5.2 38.9
    assert psnr(picture(room, 2), reference) > 37.0


@pytest.mark.thorough
def test_checks_that_a_concave_mirror_shows_look_as_in_it(blank, room):
    """With 256 samples, against Cycles and its own noise."""
    mirror = scene_of(blank)
    checked_card(6.0, 20)
    dish = parts.add("uv_sphere", "Dish", segments=64, ring_count=32, radius=6.0, location=(0.0, -4.2, 1.0))
    dish.data.shade_smooth()
    shape = bmesh.new()
    shape.from_mesh(dish.data)
    bmesh.ops.delete(shape, geom=[corner for corner in shape.verts if corner.co.y < 5.0], context="VERTS")
    bmesh.ops.reverse_faces(shape, faces=shape.faces[:])
    shape.to_mesh(dish.data)
    shape.free()
    dish.data.materials.append(mirror.data.materials[0])
    bpy.data.objects.remove(mirror)
    parts.select(bpy.data.objects["Card"], dish)
    blank.scene.cycles.samples = 256
    reference = picture(room)
    parts.generate()
    bpy.ops.reflection_mesh.light(samples=256, kind="PICTURE", every=True)
    # measured: 37.8 dB
    assert psnr(picture(room, 2), reference) > 36.0


@pytest.mark.thorough
def test_on_the_objects_they_have_more_texels_in_their_places(blank, room):
    """Against Cycles: between texels a bright check's half would still be white, and between corners its place would be
    wrong by a part of a pixel, as the tolerance allows. Matte ones have as many texels as ever."""
    scene_of(blank)
    checked_card(6.0, 30)
    blank.scene.cycles.samples = 512
    reference = picture(room)
    parts.generate()
    bpy.ops.reflection_mesh.light(samples=64, kind="OBJECTS", every=True)
    # measured: 42.4 dB
    assert psnr(picture(room, 2), reference) > 40.0
    fine, shader = room("addon.baking.fineness"), bpy.data.materials["Checks"].node_tree.nodes["Emission"]

    def fineness() -> list:
        return fine.fineness(SimpleNamespace(sources=[bpy.data.objects["Card"]])).tolist()
    assert fineness() == [fine.FINER_LAMPS]
    shader.inputs["Strength"].default_value = 0.9
    assert fineness() == [fine.FINER]


@pytest.mark.thorough
@pytest.mark.parametrize(("strength", "samples", "most", "expected"), [
    (6.0, 64, 1 << 21, [(2, 1), (16, 2), (64, 2)]), (0.9, 64, 1 << 21, [(2, 1), (64, 1), (64, 1)]),
    (6.0, 8, 1 << 21, [(8, 1), (64, 1)]), (6.0, 64, 1000, [(64, 1), (64, 1)]),
    (6.0, 256, 1 << 21, [(8, 1), (28, 3), (64, 3)]), (6.0, 256, 20_000, [(8, 1), (64, 2), (64, 2)])])
def test_only_what_is_brighter_than_white_is_rendered_densely(request, strength, samples, most, expected):
    """With no more rays, where the picture is not too large; the last render tells what results cover."""
    blank, room, patched = (request.getfixturevalue(name) for name in ("blank", "room", "monkeypatch"))
    scene_of(blank)
    checked_card(strength, 30)
    parts.generate()
    asked, density = [], room("addon.lighting.density")
    patched.setattr(density, "MOST_TEXELS", most)
    for module in (room("addon.lighting.light_scene"), density):
        def told(scene, work=module.rendering):
            found = yield from work(scene)
            asked.append((scene.cycles.samples, scene.render.resolution_x // SIZE))
            return found
        patched.setattr(module, "rendering", told)
    bpy.ops.reflection_mesh.light(samples=samples, kind="PICTURE", every=True)
    assert asked == expected
    assert (blank.scene.render.resolution_x, blank.scene.render.resolution_percentage) == (SIZE, 100)


def test_beside_what_shines_a_little_it_is_as_it_is(room):
    """Matte faces one pixel wide between ones three times white, which tell all pixels' light, keep their own; beside
    ones a thousand times white they go on as it is around."""
    texels = room("addon.lighting.picture.texels")
    shining = np.tile(np.array((1.0, 0.0), dtype=np.float32), (12, 6))
    coverage = np.ones_like(shining)
    for strength, most in ((3.0, 1.0), (1000.0, 0.25)):
        light = shining[..., None] * strength * np.ones(3, dtype=np.float32) + 0.1
        left = texels.beside_lamps(coverage, shining, light, 1.0)
        assert np.allclose(left, (1.0 - shining) * most)
