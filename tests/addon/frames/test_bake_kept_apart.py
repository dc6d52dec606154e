"""What plays in a scene with a time of its own, and beside what the scene had before."""
from __future__ import annotations

import bpy
from baked_frames import FRAMES, assert_same, bake, expected, lit_scene
from played import played


def test_stretched_time(moving, room, tmp_path):
    """Blender looks for keys at stretched places, and each frame still shows its own reflection and light."""
    lit_scene()
    bpy.context.scene.render.frame_map_new = 230
    bpy.ops.wm.save_mainfile()
    out = tmp_path / "out"
    assert bake(room, "--output", out, "--light", "1") == 0
    told = played(out / "scene reflections.blend", FRAMES, tmp_path / "played", ["Mirror Reflection"])
    for frame in FRAMES:
        bpy.ops.wm.open_mainfile(filepath=str(moving))
        wanted = expected(frame)
        assert_same(told, frame, "Mirror Reflection", {what: wanted[what] for what in ("places", "origin")})
    bpy.ops.wm.open_mainfile(filepath=str(out / "scene reflections.blend"))
    light = bpy.data.objects["Mirror Reflection"].material_slots[0].material
    users = [node.image_user for node in light.node_tree.nodes if node.type == "TEX_IMAGE"]
    assert users
    for frame in FRAMES:
        bpy.context.scene.frame_set(frame)
        assert {user.frame_start + user.frame_offset for user in users} == {frame}
