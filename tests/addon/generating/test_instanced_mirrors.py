"""Mirrors that Geometry Nodes make of instances show what the instanced mirror would; those too small say so."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest


def instance_of(source: bpy.types.Object) -> bpy.types.Object:
    """An object without faces of its own whose modifier puts an instance of `source` where it stands itself."""
    tree = bpy.data.node_groups.new("Instance", "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    info, end = tree.nodes.new("GeometryNodeObjectInfo"), tree.nodes.new("NodeGroupOutput")
    info.inputs["Object"].default_value, info.inputs["As Instance"].default_value = source, True
    tree.links.new(info.outputs["Geometry"], end.inputs[0])
    holder = bpy.data.objects.new("Holder", bpy.data.meshes.new("Holder"))
    bpy.context.scene.collection.objects.link(holder)
    holder.modifiers.new("Instance", "NODES").node_group = tree
    holder.matrix_world = source.matrix_world.copy()
    return holder


@pytest.fixture
def box(blank) -> bpy.types.Object:
    return parts.add("cube", "Box", size=1.0, location=(0.0, -1.5, 1.0))


@pytest.mark.parametrize("hidden", [False, True])
def test_an_instance_of_a_mirror_is_a_mirror(box, hidden):
    source = parts.add_wall_mirror()
    source.data.materials.append(parts.material("Glass", "GLOSSY"))
    bpy.context.view_layer.update()
    parts.select(box, source)
    plain = parts.generate()
    truth, faces = parts.attribute(plain, "position"), len(plain.data.polygons)
    bpy.ops.reflection_mesh.clear()
    holder = instance_of(source)
    source.location.z += 50.0
    source.hide_set(hidden)
    bpy.context.view_layer.update()
    parts.select(box, holder)
    result = parts.generate()
    assert result.name == "Holder Reflection"
    # in another order, which goes by the last digits of where the mirror is
    apart = np.linalg.norm(parts.attribute(result, "position")[:, None] - truth, axis=2)
    assert apart.shape[0] == apart.shape[1] and len(result.data.polygons) == faces
    assert apart.min(axis=0).max() < 1e-5 and apart.min(axis=1).max() < 1e-5


@pytest.mark.parametrize("small", [1e-20, 1e-30])
def test_what_has_no_area_says_so_and_small_meshes_scaled_up_are_as_large_ones(box, small):
    mirror = parts.add_wall_mirror()
    mirror.reflection_mesh.role = "MIRROR"
    bpy.context.view_layer.update()
    parts.select(box, mirror)
    faces = len(parts.generate().data.polygons)
    bpy.ops.reflection_mesh.clear()
    mirror.scale = (small,) * 3
    parts.select(box, mirror)
    assert parts.refusal() == "Mirror: The mirror has no face with an area; give it faces or choose another mirror."
    for vertex in mirror.data.vertices:
        vertex.co *= small
    mirror.scale = (1.0 / small,) * 3
    assert len(parts.generate().data.polygons) == faces
