"""Results in glTF: the attributes that they carry, and the mirrors that they stand for.

Blender's glTF exporter calls the extension while it works. It writes attributes whose name begins with an underscore,
and asks add-ons which others to write, under which names.
"""
from __future__ import annotations

import bpy

from .lighting import is_lit
from .reading import is_result, mirrors_of
from .reading.materials import materials_on_faces, reflecting_materials

# those that leave points whole: what each face knows for itself would tear the mesh apart
CARRIED = frozenset({"reflected_position", "mirror_position", "path_length", "image_parity", "source_object",
                     "bounces"})


class ResultsInGltf:
    """The hooks of one export."""

    def __init__(self) -> None:
        self._covered: set | None = None

    def gather_attribute_keep(self, attribute, export_settings: dict) -> None:
        """Keep an attribute of a result's mesh; called for each if the user exports attributes."""
        if attribute.attr_name in CARRIED:
            attribute.attr_name, attribute.keep = f"_{attribute.attr_name}", True

    def gather_node_hook(self, node, obj: bpy.types.Object | None, export_settings: dict) -> None:
        """Leave out the mesh of a mirror that a lit result in the same file covers.

        Other engines cannot hide an object from the camera alone, and would show the mirror before the result.
        """
        if self._covered is None:
            self._covered = _covered_mirrors(export_settings["vtree"])
        if node.mesh is not None and obj in self._covered:
            export_settings["log"].info(f"The mirror '{obj.name}' is left out: its lit reflection stands for it.")
            node.mesh = None


def _covered_mirrors(tree) -> set[bpy.types.Object]:
    """Return the mirrors that lit results in the exporter's tree of objects cover, or that are windows to them.

    A mirror that has a frame in the same object stays, unless it is a window.
    """
    exported = [node.blender_object for node in tree.nodes.values() if node.blender_object is not None]
    return {mirror for obj in exported if is_result(obj) and is_lit(obj) and len(obj.data.polygons)
            for mirror in mirrors_of(obj) if obj.reflection_mesh.window or _mirrors_wholly(mirror)}


def _mirrors_wholly(obj: bpy.types.Object) -> bool:
    return not set(materials_on_faces(obj)) - {None, *reflecting_materials([obj])}
