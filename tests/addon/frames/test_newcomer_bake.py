"""A newcomer's animation: an own scene, lit and textured, nothing of it prepared; one command makes 24 frames."""
from __future__ import annotations

import bpy
import parts
import pytest
from baked_frames import names
from lamp_scenes import psnr
from newcomer import room_of
from played import played

COUNT, SOME = 24, (1, 13, 24)


@pytest.mark.slow
def test_one_command_and_the_animation_is_cycles(blank, room, tmp_path, capsys):
    """By the extension as its zip installs it; what plays, and is rendered, without it is nearer to what Cycles traces
    than two of Cycles' own renders of as many samples are to each other."""
    room_of(blank, 8)
    # what was clicked last
    parts.select(bpy.data.objects["Ball 0"])
    file, out = tmp_path / "work" / "mine.blend", tmp_path / "frames"
    file.parent.mkdir()
    bpy.ops.wm.save_as_mainfile(filepath=str(file))
    done = room("addon.command_line").run(["bake", "--frames", f"1-{COUNT}", "--output", str(out)], str(file))
    assert done == 0, capsys.readouterr().err
    numbers = range(1, COUNT + 1)
    assert names(out) == {"mine reflections.blend", *(
        name for frame in numbers for name in (f"Frame.{frame:04d}.json", f"Light.{frame:04d}.exr",
                                               f"Metal_Reflection.{frame:04d}.usdc"))}
    seen = played(out / "mine reflections.blend", SOME, tmp_path / "seen", picture=64)
    traced = played(file, SOME, tmp_path / "traced", picture=64)
    bpy.ops.wm.open_mainfile(filepath=str(file))
    bpy.context.scene.cycles.seed = 7
    bpy.ops.wm.save_as_mainfile(filepath=str(file))
    other = played(file, SOME, tmp_path / "other", picture=64)
    for frame in SOME:
        shown, right, again = (every[f"{frame} picture"] for every in (seen, traced, other))
        assert psnr(shown, right) > psnr(again, right)
        # and it is no other frame
        assert all(psnr(shown, right) > psnr(shown, traced[f"{which} picture"]) + 6.0
                   for which in SOME if which != frame)
