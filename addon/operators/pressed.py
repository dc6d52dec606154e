"""Options that are on if a button is pressed, and off for scripts, which get what they ask for."""
from __future__ import annotations

import bpy


class ProtectsResults:
    """Mix-in of operators that write results: those made by a button are protected from clicks and moves."""

    protect: bpy.props.BoolProperty(name="Protect", default=False, options={"SKIP_SAVE"},
                                    description="Clicks in the viewport select the mirror instead of the result, and "
                                    "the result cannot be moved. On if a button is pressed")

    # no annotation: Blender takes those of an operator for its properties
    on_if_pressed = ("protect",)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set:
        for name in self.on_if_pressed:
            if not self.properties.is_property_set(name):
                setattr(self, name, True)
        return super().invoke(context, event)
