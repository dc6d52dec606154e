"""A lamp's own image in the mirrors that it does not light any more: a second lamp for these alone, in the same place.
Of a mesh that emits a shell round it.

Where light has met a diffuse surface on its way from the camera the second lamp is dark: mirrors show it, and throw no
light of it. Cycles asks a lamp's nodes about each path (Light Path > Diffuse Depth); other engines ask none.
"""
from __future__ import annotations

from collections.abc import Callable

import bpy

from ... import compat
from ...faults import AllOrNothing
from ...reading.materials import one_output
from ...writing import link_beside
from ..light_sources import GLINT, is_glint
from .shining_shell import follow_materials, forget_materials, has_shell, shell_of

RAYS = ("visible_camera", "visible_diffuse", "visible_glossy", "visible_transmission", "visible_volume_scatter",
        "visible_shadow")
VALUES = {"BOOLEAN", "INT", "FLOAT", "ENUM"}
FACTORS = ("diffuse_factor", "specular_factor", "transmission_factor", "volume_factor")  # factors that only EEVEE uses


def glint_of(lamp: bpy.types.Object) -> bpy.types.Object | None:
    """Return the second lamp of a lamp, if it has an editable one."""
    return next((obj for obj in lamp.children if is_glint(obj) and obj.library is None), None)


def show_in_mirror(scene: bpy.types.Scene, lamp: bpy.types.Object, mirror: bpy.types.Object,
                   whole: AllOrNothing) -> None:
    """Show a lamp in a mirror that it does not light."""
    glint = _of_light(scene, lamp, whole) if lamp.type == "LIGHT" else _of_mesh(scene, lamp, whole)
    if glint is None:
        return
    lit = glint.light_linking.receiver_collection
    if mirror.name not in lit.objects:
        lit.objects.link(mirror)
        whole.undo(lit.objects.unlink, mirror)


def _of_light(scene: bpy.types.Scene, lamp: bpy.types.Object, whole: AllOrNothing) -> bpy.types.Object:
    name, glint = _name(lamp), glint_of(lamp)
    data = lamp.data.copy()
    whole.undo(bpy.data.lights.remove, data)
    data.name, data[GLINT] = name, True
    _darken_behind_diffuse(data)
    if not compat.eevee_links_light():
        for factor in FACTORS:
            setattr(data, factor, 0.0)
    if glint is not None and glint.light_linking.receiver_collection is None:
        # by hand; without one it would light everything
        whole.after(_remove, glint)
        glint = None
    if glint is None:
        glint = bpy.data.objects.new(name, data)
        whole.undo(bpy.data.objects.remove, glint)
        for rays in RAYS:
            setattr(glint, rays, getattr(lamp, rays))
        glint.parent = lamp
        _link(scene, lamp, glint, whole)
    else:
        whole.undo(setattr, glint, "data", glint.data)
        whole.after(_replace, glint.data, glint)
        glint.data = data
    return glint


def _of_mesh(scene: bpy.types.Scene, lamp: bpy.types.Object, whole: AllOrNothing) -> bpy.types.Object | None:
    if not has_shell(lamp):
        return None
    # modifiers may be others than they were
    old = glint_of(lamp)
    glint = shell_of(lamp, _name(lamp), whole)
    _link(scene, lamp, glint, whole)
    if old is not None:
        for mirror in old.light_linking.receiver_collection.objects if old.light_linking.receiver_collection else ():
            glint.light_linking.receiver_collection.objects.link(mirror)
        del old[GLINT]
        whole.undo(old.__setitem__, GLINT, True)
        whole.after(_name_again, lamp)
        whole.after(_remove, old)
    return glint


def follow_lamp(lamp: bpy.types.Object) -> None:
    """Copy the brightness and the size of a lamp to its image, if there is one."""
    glint = glint_of(lamp)
    if glint is None:
        return
    if lamp.type != "LIGHT":
        follow_materials(lamp, glint)
        return
    for prop in lamp.data.bl_rna.properties:
        name = prop.identifier
        if prop.type in VALUES and not prop.is_readonly and name not in {"use_nodes", *FACTORS}:
            value = getattr(lamp.data, name)
            if getattr(glint.data, name) != value:
                setattr(glint.data, name, value)


def hide_from_mirror(lamp: bpy.types.Object, mirror: bpy.types.Object | None) -> None:
    """Hide the image of a lamp from a mirror; remove the image if no mirror is left."""
    glint = glint_of(lamp)
    if glint is None:
        return
    lit = glint.light_linking.receiver_collection
    if lit is not None and mirror is not None and mirror.name in lit.objects:
        lit.objects.unlink(mirror)
    if lit is None or not len(lit.objects):
        _remove(glint)


def forget_lost_glints(leaves_out: Callable[[bpy.types.Object], bool]) -> bool:
    """Remove images whose lamp is deleted, or lights all mirrors again (`leaves_out` is False), as copies of lamps may.
    Return True if there were any.
    """
    lost = [obj for obj in bpy.data.objects if is_glint(obj) and obj.library is None
            and (obj.parent is None or not leaves_out(obj.parent))]
    for glint in lost:
        _remove(glint)
    return bool(lost)


def _link(scene: bpy.types.Scene, lamp: bpy.types.Object, glint: bpy.types.Object, whole: AllOrNothing) -> None:
    """Link the image of a lamp into the file, without any mirror that it lights yet."""
    glint[GLINT] = True
    lit = bpy.data.collections.new(_name(lamp))
    whole.undo(bpy.data.collections.remove, lit)
    lit[GLINT] = True
    glint.light_linking.receiver_collection = lit
    glint.light_linking.blocker_collection = lamp.light_linking.blocker_collection
    glint.lightgroup = lamp.lightgroup
    glint.hide_select = True
    link_beside(scene, glint, lamp)


def _name(lamp: bpy.types.Object) -> str:
    return f"{lamp.name} Glint"


def _name_again(lamp: bpy.types.Object) -> None:
    glint = glint_of(lamp)
    if glint is not None:
        materials = (slot.material for slot in glint.material_slots)
        for one in (glint, glint.light_linking.receiver_collection, *materials):
            one.name = _name(lamp)


def _replace(old: bpy.types.Light, glint: bpy.types.Object) -> None:
    # each mirror replaces the result of the one before, so the last one stays
    name = old.name
    if old.users == 0:
        bpy.data.lights.remove(old)
    glint.data.name = name


def _darken_behind_diffuse(data: bpy.types.Light) -> None:
    tree = data.node_tree if compat.uses_nodes(data) else _plain_nodes(data)
    surface = one_output(tree).inputs["Surface"]
    shader = surface.links[0].from_socket
    path, mix = tree.nodes.new("ShaderNodeLightPath"), tree.nodes.new("ShaderNodeMixShader")
    tree.links.new(path.outputs["Diffuse Depth"], mix.inputs["Fac"])
    tree.links.new(shader, mix.inputs[1])
    tree.links.new(mix.outputs[0], surface)


def _plain_nodes(data: bpy.types.Light) -> bpy.types.NodeTree:
    """Return default nodes for a lamp that used none, whatever nodes it had stored."""
    tree = compat.use_nodes(data)
    tree.nodes.clear()
    output, shader = tree.nodes.new("ShaderNodeOutputLight"), tree.nodes.new("ShaderNodeEmission")
    tree.links.new(shader.outputs[0], output.inputs["Surface"])
    return tree


def _remove(glint: bpy.types.Object) -> None:
    data, lit = glint.data, glint.light_linking.receiver_collection
    materials = [slot.material for slot in glint.material_slots]
    bpy.data.objects.remove(glint)
    if GLINT in data and data.users == 0:
        bpy.data.lights.remove(data)
    forget_materials(materials)
    if lit is not None and lit.users == 0:
        bpy.data.collections.remove(lit)
