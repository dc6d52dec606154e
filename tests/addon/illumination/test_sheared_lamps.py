"""Area lamps whose axes are not at right angles: mirrors throw what Cycles' rays meet of them."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from caustic_scene import SIZE, add_lamp, paint, rendered, scene_of
from mathutils import Matrix, Vector

SHEARED = ((1.0, 0.6, 0.3, 0.0), (0.2, 1.1, 0.5, 0.0), (-0.2, 0.1, 0.9, 1.0), (0.0, 0.0, 0.0, 1.0))
KINDS = {"SQUARE": {}, "RECTANGLE": {"size_y": 0.3}, "DISK": {}, "ELLIPSE": {"size_y": 0.3}, "SPREAD": {"spread": 1.5}}
WAY = Vector((0.3, -0.2, -1.0)).normalized()  # from the lamp to the mirror


def seen_in_a_mirror(kind: str) -> bpy.types.Object:
    """A lamp that a camera sees by a mirror on the ground, in parallel projection; a camera alone sees none."""
    scene = bpy.context.scene
    scene.render.engine, scene.world, scene.view_settings.view_transform = "CYCLES", None, "Raw"
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    scene.cycles.use_denoising, scene.cycles.blur_glossy = False, 0.0
    parts.add("plane", "Ground", size=20.0).data.materials.append(paint("Metal", "GLOSSY", (1.0, 1.0, 1.0)))
    lamp = add_lamp("Lamp", "AREA", (0.0, 0.0, 1.0), **{"shape": kind if kind != "SPREAD" else "SQUARE", "size": 0.2},
                    **KINDS[kind])
    lamp.matrix_basis.identity()
    lamp.parent = bpy.data.objects.new("Parent", None)
    lamp.matrix_parent_inverse = Matrix(SHEARED)
    camera, back = scene.camera, Vector((WAY.x, WAY.y, -WAY.z))
    camera.data.type, camera.data.ortho_scale = "ORTHO", 1.0
    camera.location = Vector((0.0, 0.0, 1.0)) - WAY / WAY.z + 3.0 * back
    camera.rotation_euler = (-back).to_track_quat("-Z", "Y").to_euler()
    bpy.context.view_layer.update()
    return lamp


@pytest.mark.thorough
@pytest.mark.parametrize("kind", KINDS)
def test_it_is_as_large_and_as_bright_as_mirrors_show_it(blank, room, tmp_path, kind):
    lamp = seen_in_a_mirror(kind)
    pixels = rendered(tmp_path, 64)
    eyes = room("addon.illumination").eyes_of(blank.evaluated_depsgraph_get(), lamp, 4096, np.array((0.0, 0.0, -9.0)))
    far = np.array(WAY) * 1e6
    sent = np.sum([eye.power * eye.share(eye.lamp.place + far) for eye in eyes], axis=0)
    assert np.allclose(pixels.sum(axis=(0, 1)) / SIZE**2, sent, rtol=3e-3)
    # where its places are in the picture, by the camera's axes, behind the mirror
    axes = np.array(blank.scene.camera.matrix_world)[:3]
    places = (np.array([eye.lamp.place for eye in eyes]) * (1.0, 1.0, -1.0) - axes[:, 3]) @ axes[:, :2]
    lit = pixels[..., 0] / pixels[..., 0].sum()
    middles = (np.stack(np.meshgrid(*2 * [np.arange(SIZE) + 0.5])) / SIZE - 0.5).reshape(2, -1)
    seen = middles - (middles @ lit.ravel())[:, None]
    assert np.allclose(middles @ lit.ravel(), places.mean(axis=0), atol=2e-3)
    spread = np.cov(places.T, bias=True)
    assert np.allclose((seen * lit.ravel()) @ seen.T, spread, rtol=0.03, atol=0.02 * spread.max())


def test_it_is_told(blank, capfd):
    floor, mirror, lamp = scene_of("AREA")
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    assert "is sheared" not in capfd.readouterr().out
    parent = bpy.data.objects.new("Parent", None)
    blank.scene.collection.objects.link(parent)
    lamp.parent, parent.scale = parent, (1.0, 1.0, 1.5)
    blank.view_layer.update()
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    assert "The lamp 'Lamp' is sheared" in capfd.readouterr().out
