"""What of a mirror its light does not follow, and Cycles does (docs/caustics.md), is told: normals that Cycles bends on
a coarse mirror that is shaded smooth, and those that its material bends."""
from __future__ import annotations

import bpy
import parts
import pytest
from caustic_scene import paint, scene_of


@pytest.mark.thorough
@pytest.mark.parametrize("faces, smooth, told", [((24, 8), True, True), ((24, 8), False, False),
                                                 ((48, 16), True, False)], ids=str)
def test_it_is_told_where_cycles_throws_much_more(blank, capfd, faces, smooth, told):
    floor, mirror, lamp = scene_of()
    bpy.data.objects.remove(mirror)
    ring = parts.add("torus", "Ring", major_segments=faces[0], minor_segments=faces[1], location=(0.0, 0.0, 0.4))
    ring.data.polygons.foreach_set("use_smooth", [smooth] * len(ring.data.polygons))
    ring.data.materials.append(paint("Metal", "GLOSSY", (1.0, 1.0, 1.0)))
    parts.select(floor, lamp, ring)
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    assert ("The mirror 'Ring' is coarse" in capfd.readouterr().out) == told


@pytest.mark.parametrize("bent", ["", "Normal", "Displacement", "grouped", "unused"])
def test_normals_that_the_material_bends_are_told(blank, capfd, bent):
    floor, mirror, lamp = scene_of()
    tree = mirror.active_material.node_tree
    end = tree.get_output_node("ALL").inputs
    if bent == "grouped":
        group = bpy.data.node_groups.new("Chrome", "ShaderNodeTree")
        group.interface.new_socket("Out", in_out="OUTPUT", socket_type="NodeSocketShader")
        node = tree.nodes.new("ShaderNodeGroup")
        node.node_tree = group
        tree.links.new(node.outputs[0], end["Surface"])
        tree, end = group, group.nodes.new("NodeGroupOutput").inputs
        tree.links.new(tree.nodes.new("ShaderNodeBsdfAnisotropic").outputs[0], end[0])
    kind = "ShaderNodeDisplacement" if bent == "Displacement" else "ShaderNodeBump"
    bump = tree.nodes.new(kind).outputs[0] if bent else None
    if bent == "Displacement":
        tree.links.new(bump, end["Displacement"])
    elif bent in {"Normal", "grouped"}:
        shader = next(node for node in tree.nodes if node.type == "BSDF_GLOSSY")
        tree.links.new(bump, shader.inputs["Normal"])
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    assert ("bends its normals or displaces it" in capfd.readouterr().out) == (bent not in {"", "unused"})
