"""Which instances of what is hidden in renders by itself are rendered all the same."""
from __future__ import annotations

import bpy

from ... import compat
from ..materials import all_nodes

NO_NUMBER = 2**31 - 1  # of a level of instances that there is not: a whole collection has one, and one of each object


def is_rendered(instance: bpy.types.DepsgraphObjectInstance, given: dict) -> bool:
    """Whether renders show something at a place. What Geometry Nodes or particles instance they show though it is
    hidden there itself, as what is instanced mostly is; of collections, vertices and faces they do not.

    `given` keeps which objects nodes instance one by one, from one instance of a depsgraph to the next.
    """
    original = instance.object.original
    if not original.hide_render:
        return True
    if not instance.is_instance:
        return False
    if instance.particle_system is not None:
        return True
    parent = instance.parent.original
    if parent.instance_type != "NONE":
        return False
    if instance.persistent_id[1] == NO_NUMBER:
        return True
    # one level deeper are members of a whole collection as well as what "Object Info" puts on points
    if parent not in given:
        given[parent] = _given_to_nodes(parent)
    return original in given[parent]


def _given_to_nodes(obj: bpy.types.Object) -> set:
    """The objects that the Geometry Nodes of an object, and of those, can instance one by one."""
    found: dict = {obj: None}
    left = [obj]
    while left:
        trees, values, apart = [], [], False
        for modifier in left.pop().modifiers:
            if modifier.type == "NODES" and modifier.node_group is not None:
                trees.append(modifier.node_group)
                values += compat.inputs_of_nodes(modifier)
        for node in (node for tree in trees for node in all_nodes(tree)):
            values += [socket.default_value for socket in node.inputs if socket.type in {"OBJECT", "COLLECTION"}]
            values += [getattr(node, name, None) for name in ("object", "collection")]
            if node.type == "COLLECTION_INFO":
                separate = node.inputs["Separate Children"]
                apart = apart or separate.is_linked or separate.default_value
        objects = [value for value in values if isinstance(value, bpy.types.Object)]
        if apart:
            objects += [member for value in values if isinstance(value, bpy.types.Collection)
                        for member in value.objects]
        left += [other for other in dict.fromkeys(objects) if other not in found]
        found.update(dict.fromkeys(objects))
    return set(found)
