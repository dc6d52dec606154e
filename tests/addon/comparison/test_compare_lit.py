"""The comparison of a result that shows light: the file's own pictures, beside what Cycles differs from itself by."""
from __future__ import annotations

import json

import bpy
import parts
import pytest
from lamp_scenes import lit_state, picture, psnr, scene_of


@pytest.fixture
def lit(blank):
    """A wall mirror whose reflection has light; returns the result."""
    def lit(source: str, mirror: str) -> bpy.types.Object:
        scene_of(blank, source, mirror)
        result = parts.generate()
        bpy.ops.reflection_mesh.light()
        return result
    return lit


# what is random by an object goes by its name, that of an instance by what instances it
@pytest.mark.thorough
@pytest.mark.parametrize("source, mirror", [("UV", "Fresnel"), ("Random", "Tint"), ("Instances", "")])
def test_compare_tells_how_lit_pictures_differ(lit, tmp_path, source, mirror):
    """Against the mirror as it is, tint and all, and its objects as they are."""
    lit(source, mirror)
    assert bpy.ops.reflection_mesh.compare(filepath=str(tmp_path), samples=32) == {"FINISHED"}
    report = json.loads((tmp_path / "report.json").read_text())
    shown, noise = report["picture"]["mirror"], report["picture"]["noise"]["mirror"]
    # denoised, the light is nearer than another render
    assert shown["psnr_displayed"] > noise["psnr_displayed"] + 0.5
    assert "where Cycles equals itself to" in (tmp_path / "report.html").read_text()


@pytest.mark.slow
def test_the_pictures_are_those_that_the_file_shows(lit, room):
    """With the sampling of the scene, against renders of the file: what they differ by is noise."""
    result = lit("Random", "Tint")
    compared = room("addon.faults").finished(room("addon.comparison.pictures").render_lit(bpy.context, [result], 0))
    srgb = room("addon.metrics.picture_metrics").srgb
    assert psnr(srgb(compared.result), picture(room)) > 30.0
    result.hide_render = True
    assert psnr(srgb(compared.reference), picture(room)) > 30.0


def test_the_file_stays_as_it_was_wherever_it_is_stopped(lit, room):
    result = lit("", "Tint")
    result.reflection_mesh.mirror.visible_camera = False
    result.reflection_mesh.mirror.reflection_mesh.camera_hidden = True
    before, render = lit_state(), room("addon.comparison.pictures").render_lit
    for renders in range(4):
        job = render(bpy.context, [result], 1)
        told = [what for what, _ in zip(job, range(renders), strict=False)]
        job.close()
        assert len(told) == min(renders, 3) and lit_state() == before
