"""Evaluate attributes of objects, instances and instancers that materials read, as numbers."""
from __future__ import annotations

import bpy

from ... import compat
from ..materials import all_nodes
from .hidden_instances import NO_NUMBER

MASK = 2**32 - 1
Question = tuple[str, str]
"""Of whom: OBJECT, INSTANCER, PARTICLE or DUPLI; and what."""
PARTICLE = {"Age": "birth_time", "Lifetime": "lifetime", "Location": "location", "Size": "size", "Velocity": "velocity",
            "Angular Velocity": "angular_velocity"}


def questions(node: bpy.types.Node) -> list[Question]:
    """Return the attributes that a node reads through its linked outputs."""
    if node.type == "ATTRIBUTE":
        return [(node.attribute_type, node.attribute_name)] if node.attribute_type in {"OBJECT", "INSTANCER"} else []
    if node.type == "PARTICLE_INFO":
        return [("PARTICLE", output.name) for output in node.outputs if output.is_linked]
    if node.type in {"TEX_COORD", "UVMAP"} and node.from_instancer:
        return [("DUPLI", output.name) for output in node.outputs
                if output.is_linked and output.name in {"Generated", "UV"}]
    return []


class InstanceAnswers:
    """Evaluate the attributes that materials read at each instance of a depsgraph, at one frame."""

    def __init__(self, frame: float) -> None:
        self.frame = frame
        self.asked: dict[tuple, set[Question]] = {}
        self.instances: dict = {}

    def of(self, instance: bpy.types.DepsgraphObjectInstance, materials: tuple) -> dict[Question, tuple]:
        """Return four numbers for each attribute that the materials read and that the instance has, as in Cycles."""
        if materials not in self.asked:
            self.asked[materials] = {question for material in materials
                                     if material is not None and compat.uses_nodes(material)
                                     for node in all_nodes(material.node_tree) for question in questions(node)}
        found = {}
        for whom, what in self.asked[materials]:
            if whom == "PARTICLE":
                value = _of_particle(instance, what, self.frame)
            elif whom == "DUPLI":
                value = _of_dupli(instance, what)
            else:
                value = self._of_instancer(instance, what) if whom == "INSTANCER" and instance.is_instance else None
                value = value or _of_object(instance.object, what)
            if value is not None:
                found[whom, what] = value
        return found

    def _of_instancer(self, instance: bpy.types.DepsgraphObjectInstance, name: str) -> tuple | None:
        """Return an attribute from the nodes that made the instance, from its particle settings, or from the instancer.
        """
        found = self._by_nodes(instance, name)
        if found is None and instance.particle_system is not None:
            found = _property(instance.particle_system.settings, name)
        return found or _property(instance.parent, name)

    def _by_nodes(self, instance: bpy.types.DepsgraphObjectInstance, name: str) -> tuple | None:
        """Return the value of an instance attribute from Geometry Nodes, from the innermost level that has it. Return
        None before Blender 4.5, which does not offer it.
        """
        parent, found = instance.parent, None
        if not hasattr(parent, "evaluated_geometry"):
            return None
        if parent not in self.instances:
            self.instances[parent] = _Instances(parent.evaluated_geometry())
        made = self.instances[parent]
        for number in reversed([number for number in instance.persistent_id if number != NO_NUMBER]):
            row = None if made is None else made.row(number)
            if row is None:
                break
            found = made.value(name, row) or found
            made = made.within(row)
        return found


def _of_object(obj: bpy.types.Object, name: str) -> tuple | None:
    return _property(obj, name) or (None if obj.data is None else _property(obj.data, name))


def _property(owner: bpy.types.ID, name: str) -> tuple | None:
    """Return a custom property, or a built-in property, as red, green, blue and alpha; None if there is none."""
    value = owner.get(name)
    if value is None:
        try:
            value = owner.path_resolve(name)
        except ValueError:
            return None
    return _four(value)


def _four(value) -> tuple | None:
    if isinstance(value, bool | int | float):
        return (*(3 * (float(value),)), 1.0)
    try:
        numbers = [float(one) for one in value]
    except (TypeError, ValueError):
        return None
    return tuple((numbers + [0.0] * (3 - len(numbers)) + [1.0])[:4]) if 0 < len(numbers) <= 4 else None


class _Instances:
    """The instances in a geometry, looked up by their id."""

    def __init__(self, geometry) -> None:
        self.geometry, self.points = geometry, geometry.instances_pointcloud()
        self.parts: dict = {}
        ids = None if self.points is None else self.points.attributes.get("id")
        self.rows = None if ids is None else {entry.value: row for row, entry in reversed(list(enumerate(ids.data)))}

    def row(self, number: int) -> int | None:
        """Return the index of the instance with an id, None if there is none."""
        if self.points is None:
            return None
        row = number if self.rows is None else self.rows.get(number)
        return row if row is not None and 0 <= row < len(self.points.points) else None

    def value(self, name: str, row: int) -> tuple | None:
        attribute = self.points.attributes.get(name)
        if attribute is None or attribute.domain != "POINT":
            return None
        entry = attribute.data[row]
        return _four(next((getattr(entry, field) for field in ("value", "vector", "color") if hasattr(entry, field)),
                          None))

    def within(self, row: int) -> _Instances | None:
        """Return the instances that the instance at index `row` consists of, None if it has none."""
        index = self.points.attributes[".reference_index"].data[row].value
        if index not in self.parts:
            part = self.geometry.instance_references()[index]
            self.parts[index] = _Instances(part) if hasattr(part, "instances_pointcloud") else None
        return self.parts[index]


def _of_dupli(instance: bpy.types.DepsgraphObjectInstance, what: str) -> tuple:
    """Return the Generated or UV coordinates of the instancer's surface where the instance was made."""
    if what == "UV":
        return (*instance.uv, 0.0, 1.0)
    return (*(0.5 * number - 0.5 for number in instance.orco), 1.0)


def _of_particle(instance: bpy.types.DepsgraphObjectInstance, what: str, frame: float) -> tuple:
    """Return an output of Particle Info. Instances that are no particles, and child particles, get zeros."""
    system, index = instance.particle_system, instance.persistent_id[0]
    there = instance.is_instance and system is not None and index < len(system.particles)
    if what == "Index":
        return _four(index if there else 0)
    if what == "Random":
        return _four(_random(index if there else 0))
    if not there:
        return _four(0.0)
    value = getattr(system.particles[index], PARTICLE[what])
    return _four(frame - value if what == "Age" else value)


def _random(number: int) -> float:
    """Return Cycles' random number from 0 to 1 for an integer (B. Jenkins, "lookup3.c", 2006, of two words)."""
    a = b = c = (0xdeadbeef + (2 << 2) + 13) & MASK
    a = (a + number) & MASK
    for turn in (14, 11, 25, 16, 4, 14, 24):
        c = ((c ^ b) - ((b << turn | b >> 32 - turn) & MASK)) & MASK
        a, b, c = b, c, a
    return b / MASK
