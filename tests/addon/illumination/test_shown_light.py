"""Light that mirrors throw, seen in other mirrors, through glass and from behind."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from caustic_scene import inner, paint, rendered, scene_of


@pytest.fixture
def scene(blank, tmp_path):
    """One with light from a mirror; and what that light is, as the camera sees it."""
    scene_of()
    blank.scene.cycles.max_bounces, blank.scene.cycles.diffuse_bounces = 4, 0
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    return lambda: _light(tmp_path)


def _light(tmp_path) -> np.ndarray:
    """What a picture has more of with the mesh than without."""
    result = bpy.data.objects["Mirror Caustics"]
    pictures = []
    for hidden in (False, True):
        result.hide_render = hidden
        pictures.append(rendered(tmp_path))
    result.hide_render = False
    return pictures[0] - pictures[1]


def _apart(shown: np.ndarray, plainly: np.ndarray) -> float:
    """How far apart the same light is, in most pixels that are not at its border."""
    seen = inner(plainly)
    assert seen.sum() > 100
    return float(np.percentile(np.abs(shown[seen] / plainly[seen] - 1.0), 90))


def test_a_mirror_shows_the_light_as_the_eye_sees_it(blank, scene):
    plainly = scene()
    above = parts.add("plane", "Above", size=20.0, location=(0.0, 0.0, 4.0))
    above.data.materials.append(paint("Silver", "GLOSSY", (1.0, 1.0, 1.0)))
    # from below the lamp up to the mirror and down again
    camera = blank.scene.camera
    camera.location, camera.rotation_euler = (0.0, 0.0, 3.0), (np.pi, 0.0, 0.0)
    assert _apart(scene()[::-1], plainly) < 0.01


def test_glass_shows_the_light_behind_it(blank, scene):
    plainly = scene()
    pane = parts.add("plane", "Pane", size=20.0, location=(0.0, 0.0, 4.0))
    pane.data.materials.append(paint("Glass", "PRINCIPLED", (1.0, 1.0, 1.0), "Base Color"))
    glass = pane.active_material.node_tree.nodes[0]
    for name, value in (("Metallic", 0.0), ("Transmission Weight", 1.0), ("IOR", 1.0001)):
        glass.inputs[name].default_value = value
    pane.visible_shadow = False
    assert _apart(scene(), plainly) < 0.01


def test_the_side_that_is_not_lit_is_dark(blank, scene):
    """What leaves the receiver meets the mesh from behind, and would be lit by it."""
    assert scene().max() > 0.1
    bpy.data.objects["Floor"].hide_render = True
    camera = blank.scene.camera
    camera.location, camera.rotation_euler = (0.0, 0.0, -3.0), (np.pi, 0.0, 0.0)
    assert np.abs(scene()).max() < 1e-6
