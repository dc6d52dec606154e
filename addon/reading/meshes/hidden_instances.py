"""Decide which instances of objects that are disabled in renders are rendered nevertheless."""
from __future__ import annotations

import bpy

from ... import compat
from ..materials import all_nodes

NO_NUMBER = 2**31 - 1  # persistent_id of an unused level of instances; whole collections use one, objects two


def is_rendered(instance: bpy.types.DepsgraphObjectInstance, given: dict) -> bool:
    """Return True if renders show an instance. Renders show instances by Geometry Nodes or particles even if the
    instanced object is disabled in renders. They do not show such instances of collections, vertices and faces.

    `given` caches the objects that the nodes of each instancer instance one by one, within one depsgraph.
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
    # two levels are used by members of a whole collection and by objects that "Object Info" instances on points
    if parent not in given:
        given[parent] = _given_to_nodes(parent)
    return original in given[parent]


def _given_to_nodes(obj: bpy.types.Object) -> set:
    """Return the objects that Geometry Nodes of `obj` may instance as single objects, not within a whole collection.

    These are the objects that its nodes and modifiers refer to. If a *Collection Info* node separates children, the
    members of collections are among them. The nodes of all these objects are searched too. The result contains `obj`.
    """
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
