"""Light in scenes that differ from the others in one thing: linked lamps, displaced sources, mirrors behind the eye."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from lamp_scenes import link, mirror_material, picture, psnr, scene_of, shine


def lit_picture(room, **options) -> np.ndarray:
    parts.generate(**options)
    assert bpy.ops.reflection_mesh.light(samples=64) == {"FINISHED"}
    return picture(room)


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "measured"), [("PERSP", 53.1), ("ORTHO", 49.3)])
def test_a_mirror_that_reaches_beside_and_behind_the_view_is_lit(blank, room, kind, measured):
    """Places in the picture of light are linear on a face, but for faces that reach behind the eye: they are cut."""
    wall = scene_of(blank)
    floor = bpy.data.objects["Floor"]
    bpy.data.objects.remove(wall)
    floor.scale = (8.0, 8.0, 1.0)
    floor.data.materials[0] = mirror_material("")
    shine(blank.scene)
    camera = blank.scene.camera
    camera.rotation_euler.x, camera.data.type, camera.data.ortho_scale = 1.2, kind, 5.0
    if kind == "ORTHO":
        # the floor is seen as far as its plane
        camera.location = (0.0, -20.0, 7.2)
    parts.select(bpy.data.objects["Box"], floor)
    reference = picture(room)
    assert psnr(lit_picture(room), reference) > measured - 2.5


@pytest.mark.slow
@pytest.mark.parametrize(("name", "state", "measured"), [
    ("Floor", "INCLUDE", 49.4), ("Mirror", "EXCLUDE", 49.3), ("Mirror", "INCLUDE", 47.0)])
def test_a_mirror_shows_the_lamps_that_are_linked_to_it(blank, room, name, state, measured):
    """The lamp stands before the mirror, and shines at it."""
    scene_of(blank)
    lamp = bpy.data.objects["Area"]
    lamp.location, lamp.rotation_euler, lamp.data.energy = (-1.0, -2.5, 1.5), (np.pi / 2, 0.0, 0.0), 60.0
    lamp.light_linking.receiver_collection = linked = bpy.data.collections.new("Linked")
    linked.objects.link(bpy.data.objects[name])
    linked.collection_objects[0].light_linking.link_state = state
    blank.view_layer.update()
    reference = picture(room)
    assert (reference.min(axis=2) > 0.99).any() == (state == "INCLUDE" and name == "Mirror")
    assert psnr(lit_picture(room), reference) > measured - 2.5


@pytest.mark.slow
def test_a_displaced_source_is_lit_where_it_is_lifted_to(blank, room):
    """Before its mesh lies its surface: within its outline that is seen, and not its inside."""
    scene_of(blank)
    box = bpy.data.objects["Box"]
    material = box.data.materials[0]
    box.hide_render = True
    without = picture(room)
    box.hide_render = False
    plain = picture(room)
    there = np.abs(plain - without).max(axis=2) > 0.05
    there = np.lib.stride_tricks.sliding_window_view(np.pad(there, 1), (3, 3)).all(axis=(2, 3))
    tree = material.node_tree
    lift = tree.nodes.new("ShaderNodeDisplacement")
    lift.inputs["Midlevel"].default_value, lift.inputs["Scale"].default_value = 0.0, 0.4
    # Cycles takes a height that is the same everywhere for none
    link(tree, tree.nodes.new("ShaderNodeTexNoise").outputs[0], lift.inputs["Height"])
    link(tree, lift.outputs[0], tree.get_output_node("ALL").inputs["Displacement"])
    material.displacement_method = "DISPLACEMENT"
    reference = picture(room)
    assert np.abs(reference - plain).max(axis=2)[~there].max() > 0.2
    lit = -10.0 * np.log10(((lit_picture(room) - reference)[there]**2).mean())
    assert there.sum() > 100 and lit > 49.4 - 2.5
