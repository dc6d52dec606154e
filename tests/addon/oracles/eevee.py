"""What EEVEE renders of the file, where it can: it needs OpenGL, in software at least."""
from __future__ import annotations

import subprocess
import sys

import bpy
import numpy as np

TRIAL = """
import bpy
scene = bpy.context.scene
scene.render.engine, scene.render.resolution_x, scene.render.resolution_y = "BLENDER_WORKBENCH", 8, 8
bpy.ops.render.render()
print("RENDERED", flush=True)
"""
SAMPLES = 16


def engine() -> str:
    """What this Blender calls EEVEE."""
    return "BLENDER_EEVEE_NEXT" if (4, 2, 0) <= bpy.app.version < (5, 0, 0) else "BLENDER_EEVEE"


def is_there() -> bool:
    """Whether EEVEE can render: tried apart, since Blender ends where it has no OpenGL, and by Workbench, which needs
    the same and is there sooner."""
    try:
        tried = subprocess.run([sys.executable, "-c", TRIAL], capture_output=True, text=True, timeout=120)
    except subprocess.TimeoutExpired:
        return False
    return "RENDERED" in tried.stdout


def linear(room, eevee: bool) -> np.ndarray:
    """What a render of the file shows by EEVEE or by Cycles, (height, width, 4) in linear light."""
    rendering, scene = room("addon.rendering"), bpy.context.scene.copy()
    try:
        rendering.with_cycles(scene)
        scene.eevee.taa_render_samples = SAMPLES
        if eevee:
            scene.render.engine = engine()
        return rendering.rendered(scene)
    finally:
        bpy.data.scenes.remove(scene)
