"""Materials that objects have by Geometry Nodes alone."""
from __future__ import annotations

from types import SimpleNamespace

import bpy
import parts
import pytest


@pytest.fixture
def given(blank) -> SimpleNamespace:
    """A wall without a material of its own to which nodes give that of a white mirror, and a cube that emits."""
    wall, cube = parts.add_wall_mirror(), parts.add("cube", "Box", size=1.0, location=(0.0, -1.5, 1.0))
    cube.data.materials.append(parts.material("Plain"))
    tree = bpy.data.node_groups.new("Paint", "GeometryNodeTree")
    for direction in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=direction, socket_type="NodeSocketGeometry")
    start, paint, end = map(tree.nodes.new, ("NodeGroupInput", "GeometryNodeSetMaterial", "NodeGroupOutput"))
    glass = parts.material("Glass", "GLOSSY")
    next(node for node in glass.node_tree.nodes if "BSDF" in node.type).inputs["Color"].default_value = (1, 1, 1, 1)
    paint.inputs["Material"].default_value = glass
    tree.links.new(start.outputs[0], paint.inputs["Geometry"])
    tree.links.new(paint.outputs[0], end.inputs[0])
    wall.modifiers.new("Paint", "NODES").node_group = tree
    blank.view_layer.update()
    return SimpleNamespace(wall=wall, cube=cube, paint=paint, glass=glass)


def test_a_mirror_by_nodes_is_one_alone_and_among_all(given, room):
    for selected in ((given.wall,), (), (given.cube,)):
        parts.select(*selected)
        result = parts.generate()
        assert result.reflection_mesh.mirror == given.wall
        # what emits, in a white mirror, looks right as it is
        assert not room("addon.lighting.needs_light").needs_light(result)
        bpy.ops.reflection_mesh.clear()
    given.paint.mute = True
    parts.select(given.wall)
    assert "No mirror" in parts.refusal()


def test_what_nodes_paint_over_does_not_count(given, room):
    """A wall of glass that nodes paint grey is no mirror; one whose paint is hidden in the viewport is."""
    given.wall.data.materials.append(given.glass)
    given.paint.inputs["Material"].default_value = parts.material("Grey", "DIFFUSE")
    parts.select(given.wall)
    assert "No mirror" in parts.refusal()
    given.wall.modifiers["Paint"].show_viewport = False
    assert parts.generate().reflection_mesh.mirror == given.wall


def test_a_material_that_was_removed_just_now_is_none(given, room):
    materials_of = room("addon.reading.materials").materials_of
    assert materials_of(given.wall) == [given.glass]
    bpy.data.materials.remove(given.glass)
    assert materials_of(given.wall) == [None]


def test_redraws_evaluate_nothing(given, room, monkeypatch, blank):
    """The button is grey or not by what was evaluated last."""
    told = []
    bpy.app.handlers.depsgraph_update_post.append(lambda *_: told.append(1))
    try:
        parts.select(given.wall)
        blank.view_layer.update()
        told.clear()
        given.wall.location.x += 0.1
        assert bpy.ops.reflection_mesh.generate.poll()
        assert told == []
    finally:
        bpy.app.handlers.depsgraph_update_post.pop()
