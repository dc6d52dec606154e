"""The settings, each declared once: for the scene, for a mirror of its own, and as options of operators."""
from __future__ import annotations

from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty

from .choices import ATTRIBUTES, LIGHTS, METHODS, PLACEMENTS

SAMPLES = 64    # of light, per pixel
# what a reflection is made by, and how it is lit
SETTINGS = ("tolerance", "placement", "method", "depth", "memory", "hidden_faces")
LIGHT_SETTINGS = ("light_samples", "light_kind")
# what is written of it; a result remembers what it has
WRITTEN_SETTINGS = ("attributes", "join_parts")


def declared(names: tuple[str, ...], **more) -> dict:
    """The properties of the settings that are named, none of them animatable, for a class's annotations.

    Parameters
    ----------
    more
        What else is asked of each property: `options`, `override`.
    """
    more = {"options": set(), **more}
    return {name: KINDS[name](**{**VALUES[name], **more}) for name in names}


def option(setting: str, /, **more):
    """A setting as the option of an operator, that its last run does not remember: the file does.

    Parameters
    ----------
    more
        What differs for this operator.
    """
    return KINDS[setting](**{**VALUES[setting], "options": {"SKIP_SAVE"}, **more})


KINDS = {"tolerance": FloatProperty, "placement": EnumProperty, "method": EnumProperty, "depth": IntProperty,
         "memory": FloatProperty, "hidden_faces": BoolProperty, "light_samples": IntProperty,
         "light_kind": EnumProperty, "attributes": EnumProperty, "join_parts": BoolProperty}
VALUES = {
    "tolerance": {"name": "Tolerance", "default": 0.5, "min": 0.01, "soft_max": 8.0, "max": 1000.0, "precision": 2,
                  "subtype": "PIXEL",
                  "description": "How many pixels a point may be from where the mirror shows it; more is faster"},
    "placement": {"name": "Placement", "items": PLACEMENTS, "default": "LAYERED",
                  "description": "Where the reflection lies"},
    "method": {"name": "Made Of", "items": METHODS, "default": "GENERAL",
               "description": "What the reflection is made of"},
    "depth": {"name": "Bounces", "default": 1, "min": 1, "soft_max": 4, "max": 16,
              "description": "How many times the scene is followed from mirror to mirror; 1: mirrors show no mirrors"},
    "memory": {"name": "Memory (GB)", "default": 2.0, "min": 0.1, "soft_max": 64.0, "precision": 1,
               "description": "Gigabytes that the work may take: what would need more is worked out more coarsely, or "
               "refused"},
    "hidden_faces": {"name": "Hidden Faces", "default": False,
                     "description": "Also the faces that nearer ones hide whole, for objects that are to be taken away "
                     "later; what lets light through keeps them anyway"},
    "light_samples": {"name": "Light Samples", "default": SAMPLES, "min": 1, "soft_max": 4096,
                      "description": "Light paths for each pixel of the mirrors, which are denoised; more is cleaner "
                      "and slower"},
    "light_kind": {"name": "Light", "items": LIGHTS, "default": "AUTO", "description": "Where the light is kept"},
    "attributes": {"name": "Attributes", "items": ATTRIBUTES, "default": "ALL",
                   "description": "What the points and faces of a reflection know"},
    "join_parts": {"name": "Join Parts", "default": True,
                   "description": "Mirrors that have one topmost parent share one reflection; a mirror with settings "
                   "of its own, or with a reflection already, keeps its own"},
}
