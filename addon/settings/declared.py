"""The settings, each declared once: for the scene, for a mirror of its own, and as options of operators."""
from __future__ import annotations

from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty

from .choices import ATTRIBUTES, METHODS, PLACEMENTS, WORLD_FACES

SAMPLES = 64    # samples of light per pixel
# settings of the geometry and of the light
SETTINGS = ("tolerance", "placement", "method", "depth", "memory", "hidden_faces")
LIGHT_SETTINGS = ("light_samples",)
# settings of the written object; a result remembers its own
WRITTEN_SETTINGS = ("attributes", "world_faces", "join_parts")


def declared(names: tuple[str, ...], **more) -> dict:
    """Return the properties of the named settings, which are not animatable, as annotations of a class.

    Parameters
    ----------
    more
        Further arguments of each property: `options`, `override`.
    """
    more = {"options": set(), **more}
    return {name: KINDS[name](**{**VALUES[name], **more}) for name in names}


def option(setting: str, /, **more):
    """Return a setting as an option of an operator. Its last value is not remembered, since the file holds it.

    Parameters
    ----------
    more
        Arguments that differ for this operator.
    """
    return KINDS[setting](**{**VALUES[setting], "options": {"SKIP_SAVE"}, **more})


KINDS = {"tolerance": FloatProperty, "placement": EnumProperty, "method": EnumProperty, "depth": IntProperty,
         "memory": FloatProperty, "hidden_faces": BoolProperty, "light_samples": IntProperty,
         "attributes": EnumProperty, "world_faces": EnumProperty, "join_parts": BoolProperty}
VALUES = {
    "tolerance": {"name": "Tolerance", "default": 0.5, "min": 0.01, "soft_max": 8.0, "max": 1000.0, "precision": 2,
                  "subtype": "PIXEL",
                  "description": "Error in pixels that 99 % of the points stay below. Higher values are faster"},
    "placement": {"name": "Placement", "items": PLACEMENTS, "default": "LAYERED",
                  "description": "Position of the reflection's geometry"},
    "method": {"name": "Made Of", "items": METHODS, "default": "GENERAL",
               "description": "Type of the reflection's geometry"},
    "depth": {"name": "Bounces", "default": 0, "min": 0, "soft_max": 4, "max": 16,
              "description": "Number of reflections from mirror to mirror. 0 is automatic: as many as there are to "
                             "see. With 1, mirrors do not show other mirrors"},
    "memory": {"name": "Memory (GB)", "default": 2.0, "min": 0.1, "soft_max": 64.0, "precision": 1,
               "description": "Memory that the computation may use. What needs more is computed more coarsely or "
                              "refused"},
    "hidden_faces": {"name": "Hidden Faces", "default": False,
                     "description": "Keep faces that nearer faces hide completely, for objects that are removed "
                                    "later. Faces behind transparent faces are always kept"},
    "light_samples": {"name": "Light Samples", "default": SAMPLES, "min": 1, "soft_max": 4096,
                      "description": "Number of light paths for each pixel of the mirrors. The light is denoised"},
    "attributes": {"name": "Attributes", "items": ATTRIBUTES, "default": "ALL",
                   "description": "Attributes that are stored in the reflection's mesh"},
    "world_faces": {"name": "World Faces", "items": WORLD_FACES, "default": "LIT",
                    "description": "Faces that show the world, and what is left after the last bounce, so that the "
                                   "reflection covers its mirror"},
    "join_parts": {"name": "Join Parts", "default": True,
                   "description": "Mirrors that have one topmost parent share one reflection; a mirror with settings "
                   "of its own, or with a reflection already, keeps its own"},
}
