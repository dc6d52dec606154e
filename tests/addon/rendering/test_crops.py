"""Parts of pictures that are rendered alone are those parts, to the pixel."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest

SIZE = (224, 540)
# 7 and 448 of 540, and 31, 62 and 124 of 224: in single precision a row that is divided by the number of rows, and
# multiplied by it again, may lie below where it was, and Blender rounds down
LOW, HIGH = ((0, 0), (31, 7), (62, 100), (124, 448)), ((31, 100), (62, 448), (160, 448), (224, 540))


@pytest.mark.parametrize(("low", "high"), list(zip(LOW, HIGH)))
def test_a_part_of_the_picture_is_that_part(blank, room, low, high):
    """A plane before the camera shines as bright as its place in the picture says."""
    scene, rendering = bpy.context.scene, room("addon.rendering")
    scene.collection.objects.link(camera := bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera")))
    camera.location, scene.camera = (0.0, 0.0, 5.0), camera
    material = parts.material("Places")
    place = material.node_tree.nodes.new("ShaderNodeTexCoord")
    material.node_tree.links.new(place.outputs["Window"], material.node_tree.nodes["Emission"].inputs["Color"])
    parts.add("plane", "Places", size=40.0).data.materials.append(material)
    rendering.with_cycles(scene)
    scene.cycles.samples, scene.cycles.pixel_filter_type, scene.cycles.use_denoising = 1, "BOX", False
    scene.render.resolution_x, scene.render.resolution_y = SIZE
    scene.render.resolution_percentage = 100
    rendering.crop_to(scene.render, low, high, SIZE)
    found = rendering.rendered(scene)
    assert found.shape[:2] == (high[1] - low[1], high[0] - low[0])
    # a sample lies anywhere within its pixel
    for axis, places in ((0, np.arange(low[0], high[0])[None]), (1, np.arange(low[1], high[1])[:, None])):
        offset = found[..., axis] * SIZE[axis] - places
        assert -1e-3 < offset.min() and offset.max() < 1.0 + 1e-3
