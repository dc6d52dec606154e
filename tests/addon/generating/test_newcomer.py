"""A newcomer's first minute: an own scene, lit, textured and animated, the mirror clicked, two buttons pressed."""
from __future__ import annotations

import time

import bpy
import parts
from lamp_scenes import picture, psnr
from newcomer import room_of


def test_the_mirror_clicked_and_two_buttons(blank, room):
    """All that is there is in it, as Cycles shows it, though there is much of it; and it is one render's work."""
    mirror = room_of(blank, 20)
    parts.select(mirror)
    reference, other = picture(room), picture(room, seed=7)
    started = time.process_time()
    assert bpy.ops.reflection_mesh.generate("INVOKE_DEFAULT") == {"FINISHED"}
    result = bpy.context.view_layer.objects.active
    assert result.name == "Metal Reflection" and len(result.reflection_mesh.sources) == 22
    seconds = time.process_time() - started
    before = psnr(picture(room), reference)
    started = time.process_time()
    assert bpy.ops.reflection_mesh.light("INVOKE_DEFAULT") == {"FINISHED"}
    # of all processors together, whatever else they do
    assert seconds + time.process_time() - started < 60.0
    # nothing was baked object by object
    lit, noise = psnr(picture(room), reference), psnr(other, reference)
    assert lit > min(38.0, noise - 2.0) and lit > before + 3.0


def test_with_nothing_selected_the_material_says_it(blank):
    """The button is not grey, and what it makes is what the mirror clicked would have made."""
    mirror = room_of(blank, 3)
    parts.select()
    bpy.context.view_layer.objects.active = None
    assert bpy.ops.reflection_mesh.generate.poll()
    assert bpy.ops.reflection_mesh.generate("INVOKE_DEFAULT") == {"FINISHED"}
    result = bpy.context.view_layer.objects.active
    assert result.reflection_mesh.mirror == mirror and len(result.reflection_mesh.sources) == 5
    bpy.ops.reflection_mesh.clear()
    mirror.active_material.node_tree.nodes["Principled BSDF"].inputs["Roughness"].default_value = 0.5
    parts.select()
    bpy.context.view_layer.objects.active = None
    assert not bpy.ops.reflection_mesh.generate.poll()
