"""What results know, for glTF: its exporter writes attributes whose name begins with an underscore, and asks add-ons
which others to write, and how to call them."""
from __future__ import annotations

# those that leave points whole: what each face knows for itself would tear the mesh apart
CARRIED = frozenset({"reflected_position", "mirror_position", "path_length", "image_parity", "source_object",
                     "bounces"})


class AttributesOfResults:
    """Called by Blender's glTF exporter where its user wants attributes, once for each of a mesh."""

    def gather_attribute_keep(self, attribute, export_settings: dict) -> None:
        if attribute.attr_name in CARRIED:
            attribute.attr_name, attribute.keep = f"_{attribute.attr_name}", True
