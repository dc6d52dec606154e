"""Arrays -> mesh: meshes that Blender finds nothing to mend in, and layers within its limits."""
from pathlib import Path

import bpy
import numpy as np
import parts
import pytest

SAMPLES = Path(__file__).resolve().parents[3] / "sample_blends"


def test_more_uv_maps_than_a_mesh_holds(blank):
    """Two objects with eight maps each: the active one is among those that are kept, and nothing fails."""
    leaf = parts.add_triangle("Leaf", [(-0.5, -1.0, 0.6), (0.7, -1.5, 0.8), (0.1, -0.5, 1.7)])
    other = parts.add_triangle("Other", [(-1.5, -1.0, 0.6), (-0.7, -1.5, 0.8), (-1.1, -0.5, 1.7)])
    for obj in (leaf, other):
        for index in range(7):
            obj.data.uv_layers.new(name=f"{obj.name} {index}")
    leaf.data.uv_layers["Leaf 6"].active_render = True
    for obj in (leaf, other):
        obj.data.update()
    parts.select(leaf, other, parts.add_wall_mirror())
    result = parts.generate()
    assert len(result.data.uv_layers) == 8
    assert next(layer.name for layer in result.data.uv_layers if layer.active_render) == "Leaf 6"


@pytest.mark.parametrize("method", ["GENERAL", "POINTS"])
def test_a_uv_map_with_the_name_of_an_attribute_takes_no_place(blank, method):
    """It is left out, be it the active one, and eight others are kept; so with colours."""
    leaf = parts.add_triangle("Leaf", [(-0.5, -1.0, 0.6), (0.7, -1.5, 0.8), (0.1, -0.5, 1.7)])
    other = parts.add_triangle("Other", [(-1.5, -1.0, 0.6), (-0.7, -1.5, 0.8), (-1.1, -0.5, 1.7)])
    for obj in (leaf, other):
        for index in range(7):
            obj.data.uv_layers.new(name=f"{obj.name} {index}")
        obj.data.color_attributes.new("source_face", "FLOAT_COLOR", "CORNER")
        obj.data.color_attributes.new("Tint", "FLOAT_COLOR", "CORNER")
    leaf.data.uv_layers["Leaf 6"].name = "path_length"
    leaf.data.uv_layers["path_length"].active_render = True
    for obj in (leaf, other):
        obj.data.update()
    parts.select(leaf, other, parts.add_wall_mirror())
    mesh = parts.generate(method=method).data
    kept = [attribute.name for attribute in mesh.attributes if attribute.data_type == "FLOAT2"]
    assert len(kept) == 8 and "path_length" not in kept
    assert mesh.attributes["path_length"].data_type == "FLOAT" and mesh.attributes["source_face"].data_type == "INT"
    assert [attribute.name for attribute in mesh.color_attributes] == ["Tint"]
    if method == "GENERAL":
        assert len(mesh.uv_layers) == 8 and mesh.uv_layers[0].active_render and mesh.uv_layers.active_index == 0


@pytest.mark.thorough
@pytest.mark.parametrize("name", ["sphere", "flat_mirror", "cylinder", "water", "bowl", "suzanne"])
def test_samples_give_valid_meshes(name):
    bpy.ops.wm.open_mainfile(filepath=str(SAMPLES / f"{name}.blend"))
    result = parts.generate(tolerance=2.0)
    assert len(result.data.polygons) > 1000
    assert not result.data.validate(verbose=True)
    assert all(np.isfinite(parts.attribute(result, attribute)).all()
               for attribute in ("position", "reflected_position", "mirror_position", "path_length"))
