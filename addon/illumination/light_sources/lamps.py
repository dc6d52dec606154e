"""Blender's lamps as places that light comes from, each with its share of the lamp's power, in Cycles' units.

A point or spot lamp of P watts has the intensity P / (4 pi) in W/sr, within the cone and its blend; an area lamp the
radiance P / (pi A) in W/m2/sr on its front; a sun is given by its irradiance in W/m2. A lamp that is not normalised is
given by its radiance: of a lamp P / pi, of a sun the irradiance of a whole sky of it, unless it has no size.
"""
from __future__ import annotations

import bpy
import numpy as np

from ....core import Lamp, ReflectionError
from ... import compat
from ...reading import seen_in
from ...reading.materials import shown_output
from .area_lamps import across_area, disc, rays_meet, spread_of
from .constant_nodes import constant, plain
from .eye import Eye, facing
from .mesh_lamps import eyes_of_mesh, is_mesh_lamp
from .round_lamps import ball, falls_softly

NO_LAMP = "There is no lamp: add one (Add > Light) or show it in the viewport and in renders."
FLAT = 1e-9  # volume that unit axes span: with less they lie in a plane


GLINT = "reflection_mesh_glint"
"""Marks the image of a lamp in mirrors, and what is made for it."""


class NoLight(ReflectionError):
    """A lamp gives no light at the moment."""


def chosen_lamps(context: bpy.types.Context) -> list:
    """Return the lamps that are meant and that light renders of the view layer.

    Raises
    ------
    ReflectionError
        If there are none.
    """
    lamps = _meant(context, list(filter(seen_in(context), context.view_layer.objects)))
    if not lamps:
        raise ReflectionError(NO_LAMP)
    return lamps


def meant_lamps(context: bpy.types.Context) -> list:
    """Return the lamps that are meant, including those hidden at the moment, see `chosen_lamps`.

    Raises
    ------
    ReflectionError
        If there are none.
    """
    lamps = _meant(context, list(context.view_layer.objects))
    return lamps or chosen_lamps(context)


def is_glint(obj: bpy.types.Object) -> bool:
    """Return True for an object that is the image of a lamp in mirrors and not a lamp itself."""
    return GLINT in obj


def _meant(context: bpy.types.Context, objects: list) -> list:
    """Return the selected lamps and emitting meshes among `objects`. If none is selected, return the lamp of the active
    caustics, else all lamps except meshes. Portals and images of lamps are ignored.
    """
    objects = [obj for obj in objects if not (_is_portal(obj) or is_glint(obj))]
    active = context.view_layer.objects.active
    own = [obj for obj in objects if active is not None and active.reflection_mesh.role == "CAUSTICS"
           and obj == active.reflection_mesh.lamp]
    chosen = [obj for obj in objects if obj.select_get() and (obj.type == "LIGHT" or is_mesh_lamp(obj))]
    return chosen or own or [obj for obj in objects if obj.type == "LIGHT"]


def _is_portal(lamp: bpy.types.Object) -> bool:
    own = getattr(lamp.data, "cycles", None) if lamp.type == "LIGHT" and lamp.data.type == "AREA" else None
    return own is not None and own.is_portal


def is_met(lamp: bpy.types.Object) -> bool:
    """Return True if rays from mirrors can hit the lamp, so that Cycles shows it in mirrors and makes its own caustics.
    Then it has a size, and Cycles samples it by such rays. Other engines have no such switch.
    """
    data, own = lamp.data, getattr(lamp.data, "cycles", None)
    if not lamp.visible_glossy:
        return False
    if lamp.type != "LIGHT":
        return True
    if own is not None and (not own.use_multiple_importance_sampling or own.is_portal):
        return False
    return {"POINT": lambda: data.shadow_soft_size > 0.0, "SPOT": lambda: data.shadow_soft_size > 0.0,
            "SUN": lambda: data.angle > 0.0, "AREA": lambda: True}[data.type]()


def eyes_of(depsgraph: bpy.types.Depsgraph, lamp: bpy.types.Object, count: int, towards: np.ndarray) -> list[Eye]:
    """Return a lamp as `count` points of equal power, spread evenly over the part that lights `towards`, points (n, 3)
    or one point (3,). For count 1, return its middle.

    Raises
    ------
    ReflectionError
        If the lamp's position is not finite; `NoLight` if it emits no light.
    """
    evaluated, towards = lamp.evaluated_get(depsgraph), np.atleast_2d(towards)
    data, matrix = evaluated.data, np.array(evaluated.matrix_world, dtype=np.float64)
    length = np.linalg.norm(matrix[:3, :3], axis=0)
    # a mesh may be flat
    if not np.isfinite(matrix).all() or (lamp.type == "LIGHT" and not _has_volume(matrix[:3, :3] / np.where(
            length > 0.0, length, 1.0))):
        raise ReflectionError(f"The lamp '{lamp.name}' has a scale of zero or a position that is no number: clear its "
                              "transform.")
    if not lamp.visible_glossy:
        raise NoLight(f"The lamp '{lamp.name}' is hidden from glossy rays, and so from mirrors: switch its Ray "
                      "Visibility > Glossy on.")
    if lamp.type != "LIGHT":
        eyes = eyes_of_mesh(depsgraph, lamp, count, towards)
        if not eyes:
            raise NoLight(f"The lamp '{lamp.name}' gives no light to the mirror: raise the strength of its emission.")
        return eyes
    axes, place, cone, soft = matrix[:3, :3] / length, matrix[:3, 3], (0.0, 0.0), None
    power = _strength(data)
    if not (power > 0.0).any():
        raise NoLight(f"The lamp '{lamp.name}' gives no light: raise its power.")
    if data.type == "SUN":
        offsets = np.tan(0.5 * data.angle) * disc(count)
        ways = -axes[:, 2] + offsets @ axes[:, :2].T
        power = power * _of_size(data, np.pi * np.sin(min(0.5 * data.angle, 0.5 * np.pi))**2, 1.0)
        return [Eye(Lamp.shining(way), power / count, axes, "SUN", (0.0, 0.0)) for way in ways]
    if data.type == "AREA":
        offsets, area = across_area(data, axes, length, count)
        # rays meet more of a sheared lamp than the area by which Cycles divides
        power, cone = power / np.pi * _of_size(data, area, 1.0) * rays_meet(axes), spread_of(data.spread)
    else:
        radius = data.shadow_soft_size
        power = power / np.pi * _of_size(data, np.pi * radius**2, 0.25)
        way = towards.mean(axis=0) - place
        if falls_softly(data, place, towards):
            soft = place, radius
            # rays that just meet a disc that faces where they start pass its middle that near
            radius /= np.sqrt(1.0 + radius**2 / max(way @ way, 1e-300))
        offsets = radius * ball(count) @ facing(way).T
    if data.type == "SPOT":
        half = np.cos(0.5 * data.spot_size)
        cone = half, max((1.0 - half) * data.spot_blend, 1e-6)
        # the cone lies in the lamp's own space: scale draws it out
        axes = np.linalg.inv(matrix[:3, :3]).T
    return [Eye(Lamp(place + offset), power / count, axes, data.type, cone, soft=soft) for offset in offsets]


def _has_volume(axes: np.ndarray) -> bool:
    return bool(abs(np.linalg.det(axes)) > FLAT)


def _strength(data: bpy.types.Light) -> np.ndarray:
    """Return red, green and blue (3,) of a lamp's power, regardless of its size."""
    power = np.array(data.color, dtype=np.float64) * data.energy * 2.0**getattr(data, "exposure", 0.0)
    if getattr(data, "use_temperature", False):
        power = power * np.array(data.temperature_color, dtype=np.float64)
    return power * light_of_nodes(data)[0]


def _of_size(data: bpy.types.Light, size: float, normalised: float) -> float:
    """Return the factor of a lamp's power: its size if it is not normalised. Cycles uses 1 for lamps without size."""
    if getattr(data, "normalize", True):
        return normalised
    return float(size) if size > 0.0 else 1.0


def light_of_nodes(data: bpy.types.Light) -> tuple[np.ndarray, bool]:
    """Return the factors of red, green and blue by a lamp's nodes, and True if these are known completely. Variable
    inputs of an Emission count with their unlinked value.
    """
    if not compat.uses_nodes(data):
        return np.ones(3), True
    output = shown_output(data.node_tree)
    if output is None or not output.inputs["Surface"].is_linked:
        return np.zeros(3), True
    shader = output.inputs["Surface"].links[0].from_node
    if shader.type != "EMISSION":
        return np.ones(3), False
    light, known = np.ones(3), True
    for socket in (shader.inputs["Color"], shader.inputs["Strength"]):
        said = constant(socket)
        light, known = light * (plain(socket) if said is None else said), known and said is not None
    return np.maximum(light, 0.0), known
