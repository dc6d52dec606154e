"""Light of mirrors behind panes that are so close that layers have little room between."""
import bpy
import numpy as np
import parts
import pytest
from lamp_scenes import picture, psnr, scene_of, tinted


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["PERSP", "ORTHO"])
def test_behind_a_pane_the_sky_is_behind_what_the_mirror_shows(blank, room, kind):
    """A tinted pane 4 mm before a mirror that is seen from a distance of 7 m."""
    scene_of(blank)
    blank.scene.camera.data.type, blank.scene.camera.data.ortho_scale = kind, 4.0
    pane = parts.add("plane", "Pane", size=3.0, location=(0.0, 0.996, 1.0), rotation=(np.pi / 2, 0.0, 0.0))
    pane.data.materials.append(tinted("Tinted", (0.9, 0.6, 0.5)))
    parts.select(pane, *(bpy.data.objects[name] for name in ("Box", "Floor", "Mirror")))
    blank.view_layer.update()
    reference, other = picture(room), picture(room, seed=7)
    parts.generate()
    assert bpy.ops.reflection_mesh.light(samples=64) == {"FINISHED"}
    assert psnr(picture(room), reference) > psnr(other, reference) - 1.5
