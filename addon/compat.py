"""The differences between Blender 4.2, 4.5 and 5.2, in one place."""
from __future__ import annotations

import atexit
import gc

import bpy
import numpy as np

# what paths that may begin with "//" say of themselves from 4.5 on
RELATIVE_PATH = {"PATH_SUPPORTS_BLEND_RELATIVE"} if bpy.app.version >= (4, 5, 0) else set()


def uses_nodes(material: bpy.types.Material | bpy.types.Light) -> bool:
    """Return True if a material or a lamp is defined by a node tree. From Blender 5.0 on every node tree is used, and
    `use_nodes` is deprecated.
    """
    if bpy.app.version >= (5, 0, 0):
        return material.node_tree is not None
    return material.use_nodes and material.node_tree is not None


def use_nodes(material: bpy.types.Material | bpy.types.Light) -> bpy.types.NodeTree:
    """The node tree of a material or lamp that was made just now, which uses it from now on."""
    if bpy.app.version < (5, 0, 0):
        material.use_nodes = True
    return material.node_tree


def eevee_links_light() -> bool:
    """Return True if EEVEE supports light linking (from Blender 4.3 on)."""
    return bpy.app.version >= (4, 3, 0)


def packs_normals() -> bool:
    """Return True if Cycles rounds shading normals to 2 x 16 bits (from Blender 5.0 on). Rounding shifts reflections in
    curved mirrors.
    """
    return bpy.app.version >= (5, 0, 0)


def smooth_faces_take_vertex_normals(mesh: bpy.types.Mesh) -> bool:
    """Return True if Cycles shades the smooth faces of a mesh with vertex normals, which average over flat faces too.

    Before Blender 5.0 this happens if the normals of a mesh are split only because some of its faces are flat. With
    sharp edges or custom normals, and always from 5.0 on, Cycles uses corner normals, as the viewport does.
    """
    if bpy.app.version >= (5, 0, 0) or mesh.has_custom_normals or mesh.normals_domain != "CORNER":
        return False
    edges = mesh.attributes.get("sharp_edge")
    if edges is None:
        return True
    sharp = np.empty(len(edges.data), dtype=bool)
    edges.data.foreach_get("value", sharp)
    return not sharp.any()


def normals_attribute() -> str:
    """The name by which a mesh keeps any vectors as its corners' normals: from 4.5 on it takes them for its own.
    Before, normals of its own make edges of a mesh sharp, and no more than nodes can ask for them."""
    return "custom_normal" if bpy.app.version >= (4, 5, 0) else "image_normal"


def set_corner_normals(mesh: bpy.types.Mesh, normals: np.ndarray) -> None:
    """Give the corners of a mesh normals (..., 3) of any length; what has none keeps the mesh's own.

    From 4.5 on an attribute holds them as they are: Blender's call takes a hundred times as long and rounds them to
    2 x 16 bits.
    """
    normals = np.array(normals, dtype=np.float32).reshape(-1, 3)
    length = np.linalg.norm(normals, axis=1)
    normals /= np.where(length > 0.0, length, 1.0)[:, None]
    if bpy.app.version < (4, 5, 0):
        split_normals(mesh, normals)
        return
    if not (length > 0.0).all():
        own = np.empty_like(normals)
        mesh.corner_normals.foreach_get("vector", own.reshape(-1))
        normals[length == 0.0] = own[length == 0.0]
    earlier = mesh.attributes.get(normals_attribute())
    if earlier is not None:
        mesh.attributes.remove(earlier)
    mesh.attributes.new(normals_attribute(), "FLOAT_VECTOR", "CORNER").data.foreach_set("vector", normals.reshape(-1))
    mesh.update()


def split_normals(mesh: bpy.types.Mesh, normals: np.ndarray) -> None:
    """The same as all Blenders have it, which bakes keep: they split faces, and lose what an attribute holds.

    Blender asks Python for each number. Lists answer four to ten times sooner than arrays, if nobody looks for garbage
    among them.
    """
    collecting = gc.isenabled()
    gc.disable()
    try:
        mesh.normals_split_custom_set(normals.reshape(-1, 3).tolist())
    finally:
        if collecting:
            gc.enable()


def adds_corners() -> bool:
    """Return True if corners can be added to a mesh that has some. Blender 5.2 may end where that is tried."""
    return bpy.app.version < (5, 0, 0)


def values_stored(attribute: bpy.types.Attribute) -> int:
    """Return the number of values that a mesh attribute stores. From Blender 5.0 on, it may store one value for all
    elements.
    """
    return 1 if getattr(attribute, "storage_type", "ARRAY") == "SINGLE" else len(attribute.data)


def freestyle_marks(mesh: bpy.types.Mesh, domain: str) -> np.ndarray:
    """Return True (n,) for edges or faces that are marked for Freestyle. From Blender 5.0 on the marks are attributes.

    Parameters
    ----------
    domain : {"EDGE", "FACE"}
        Elements to look up.
    """
    elements = mesh.edges if domain == "EDGE" else mesh.polygons
    marks = np.zeros(len(elements), dtype=bool)
    if bpy.app.version < (5, 0, 0):
        elements.foreach_get("use_freestyle_mark", marks)
    else:
        attribute = mesh.attributes.get(f"freestyle_{domain.lower()}")
        if attribute is not None and attribute.data_type == "BOOLEAN" and attribute.domain == domain:
            attribute.data.foreach_get("value", marks)
    return marks


def mark_for_freestyle(mesh: bpy.types.Mesh, domain: str, marks: np.ndarray) -> None:
    """Mark edges or faces (n,) for Freestyle, by `domain` EDGE or FACE."""
    if bpy.app.version < (5, 0, 0):
        (mesh.edges if domain == "EDGE" else mesh.polygons).foreach_set("use_freestyle_mark", marks)
    else:
        name = f"freestyle_{domain.lower()}"
        attribute = mesh.attributes.get(name) or mesh.attributes.new(name, "BOOLEAN", domain)
        attribute.data.foreach_set("value", marks)


def line_art_of(obj: bpy.types.Object) -> list:
    """The modifiers of an object that draw Line Art; before Blender 4.3 Grease Pencil had a list of its own."""
    if bpy.app.version < (4, 3, 0):
        return [modifier for modifier in obj.grease_pencil_modifiers if modifier.type == "GP_LINEART"]
    return [modifier for modifier in obj.modifiers if modifier.type == "LINEART"] if obj.type == "GREASEPENCIL" else []


def curves_of(data: bpy.types.ID) -> list:
    """The animation curves of what has its own action; in layers since Blender 4.4, and from 5.0 on in no other way."""
    return _curves(data.animation_data)


def every_curve_of(data: bpy.types.ID) -> list:
    """The animation curves of what is animated, by its own action or by strips that are not muted, within others or
    not."""
    animated, found = data.animation_data, []
    waiting = [strip for track in animated.nla_tracks if animated.use_nla and not track.mute for strip in track.strips]
    while waiting:
        strip = waiting.pop()
        if not strip.mute:
            waiting.extend(strip.strips)
            found += _curves(strip)
    return found + _curves(animated)


def _curves(holder: bpy.types.AnimData | bpy.types.NlaStrip) -> list:
    """The curves of the action that is assigned here, none where there is none; of those that move other things by the
    same action it has none."""
    action = holder.action
    if action is None:
        return []
    if bpy.app.version < (4, 4, 0):
        return list(action.fcurves)
    return [curve for layer in action.layers for strip in layer.strips for bag in strip.channelbags
            if bag.slot_handle == holder.action_slot_handle for curve in bag.fcurves]


def dices(scene: bpy.types.Scene, obj: bpy.types.Object) -> bool:
    """Return True if Cycles subdivides an object adaptively in renders, by the size of pixels.

    Its last modifier must be Subdivision Surface. Before Blender 5.0 the switch belongs to the object, and works only
    with the experimental feature set.
    """
    last = obj.modifiers[-1] if obj.modifiers else None
    if scene.render.engine != "CYCLES" or last is None or last.type != "SUBSURF" or not last.show_render:
        return False
    if bpy.app.version >= (5, 0, 0):
        return last.use_adaptive_subdivision
    return scene.cycles.feature_set == "EXPERIMENTAL" and obj.cycles.use_adaptive_subdivision


def inputs_of_nodes(modifier: bpy.types.NodesModifier) -> list:
    """The values that a Geometry Nodes modifier gives to its nodes; properties of its own before Blender 5.2."""
    if not hasattr(modifier, "properties"):
        return list(modifier.values())
    inputs = modifier.properties.inputs
    return [getattr(getattr(inputs, name), "value", None) for name in inputs.bl_rna.properties.keys()
            if name not in {"rna_type", "name"}]


def let_go_at_exit(cls: type) -> None:
    """Let a class of properties that have functions (for updates, of their own values) forget these when Python ends.

    4.2 as a module crashes at its end where such a class, though unregistered, still holds them.
    """
    if bpy.app.version < (4, 5, 0):
        atexit.register(cls.__annotations__.clear)
