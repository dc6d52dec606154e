"""Nodes that tell what lamps send along the way from the mirror to what it shows, at each point of a result.

The way goes from `mirror_position` to `reflected_position`; where it meets a lamp's body is worked out at each point
that is shaded, so that a lamp's outline is as sharp as the picture.
"""
from __future__ import annotations

import bpy
import numpy as np

from ..writing.nodes.shader_builder import ShaderBuilder
from .shown_lamps import ShownLamp

HALF = 0.5


def lamp_light(build: ShaderBuilder, lamps: tuple[ShownLamp, ...]) -> bpy.types.NodeSocket:
    """The sum of the radiance of the lamps that the way meets, as a colour."""
    start, end, bounces = (build.add("ShaderNodeAttribute", attribute_name=name)
                           for name in ("mirror_position", "reflected_position", "bounces"))
    way = _Way(build, start.outputs["Vector"], build.vector("SUBTRACT", end.outputs["Vector"],
                                                            start.outputs["Vector"]))
    total = None
    for lamp in lamps:
        # where a second mirror stands on the way, the attributes do not tell it
        met = build.calculated("MULTIPLY", way.meets(lamp), build.calculated("COMPARE", bounces.outputs["Fac"], 1.0))
        light = build.vector("SCALE", lamp.radiance, Scale=met)
        total = light if total is None else build.vector("ADD", total, light)
    return total


class _Way:
    """The way of light from what is shown to the mirror, backward."""

    def __init__(self, build: ShaderBuilder, start: bpy.types.NodeSocket, way: bpy.types.NodeSocket) -> None:
        self.build, self.start, self.way = build, start, way
        self.ahead = build.vector("NORMALIZE", way)

    def meets(self, lamp: ShownLamp) -> bpy.types.NodeSocket:
        """Return the factor by which a lamp's `radiance` is visible along the light path: 0 if the path misses it."""
        offset = self.build.vector("SUBTRACT", tuple(lamp.place), self.start)
        met = self._flat(lamp, offset) if lamp.shape in {"RECTANGLE", "ELLIPSE"} else self._round(lamp, offset)
        return self.build.calculated("MULTIPLY", met, self._narrowed(lamp)) if lamp.spot or lamp.cone[0] > 0.0 else met

    def _flat(self, lamp: ShownLamp, offset: bpy.types.NodeSocket) -> bpy.types.NodeSocket:
        build, (right, up, back) = self.build, lamp.axes.T
        along = build.dot(self.way, tuple(back))
        part = build.calculated("DIVIDE", build.dot(offset, tuple(back)), along)
        at = build.vector("SUBTRACT", build.vector("SCALE", self.way, Scale=part), offset)
        spot = [build.dot(at, tuple(axis / max(size, 1e-30))) for axis, size in zip((right, up), lamp.size)]
        if lamp.shape == "ELLIPSE":
            far = build.calculated("SQRT", build.calculated("ADD", *(build.calculated("POWER", value, 2.0)
                                                                    for value in spot)))
        else:
            far = build.calculated("MAXIMUM", *(build.calculated("ABSOLUTE", value) for value in spot))
        # its back does not shine
        return self._all(build.calculated("LESS_THAN", far, HALF), build.calculated("GREATER_THAN", along, 0.0),
                         self._between(part))

    def _round(self, lamp: ShownLamp, offset: bpy.types.NodeSocket) -> bpy.types.NodeSocket:
        build, radius = self.build, HALF * lamp.size[0]
        length = build.vector("LENGTH", self.way)
        foot = build.dot(offset, self.ahead)
        aside = build.vector("LENGTH", build.vector("SUBTRACT", offset, build.vector("SCALE", self.ahead, Scale=foot)))
        if lamp.shape == "BALL":
            inside = build.calculated("SQRT", build.calculated("MAXIMUM", build.calculated(
                "SUBTRACT", radius * radius, build.calculated("POWER", aside, 2.0)), 0.0))
            first = build.calculated("SUBTRACT", foot, inside)
        else:
            # where the way crosses the plane that faces its start
            far = build.vector("LENGTH", offset)
            aside = build.calculated("MULTIPLY", build.calculated("DIVIDE", aside, foot), far)
            first = build.calculated("DIVIDE", build.calculated("POWER", far, 2.0), foot)
        return self._all(build.calculated("LESS_THAN", aside, radius),
                         self._between(build.calculated("DIVIDE", first, length)))

    def _narrowed(self, lamp: ShownLamp) -> bpy.types.NodeSocket:
        """By the cone of a spot lamp, or the spread of an area lamp, as `illumination.Eye.share` has them."""
        build, cosine = self.build, self.build.dot(self.ahead, tuple(lamp.axes[:, 2]))
        if lamp.spot:
            if not np.allclose(lamp.axes.T @ lamp.axes, np.eye(3), atol=1e-6):
                # its cone is drawn out
                sides = [build.dot(self.ahead, tuple(axis)) for axis in lamp.axes.T[:2]]
                squares = [build.calculated("MULTIPLY", side, side) for side in (*sides, cosine)]
                whole = build.calculated("ADD", build.calculated("ADD", *squares[:2]), squares[2])
                cosine = build.calculated("DIVIDE", cosine, build.calculated("SQRT", whole))
            smooth = build.add("ShaderNodeMapRange", interpolation_type="SMOOTHSTEP")
            for name, value in (("Value", cosine), ("From Min", lamp.cone[0]), ("From Max", sum(lamp.cone))):
                build.feed(value, smooth.inputs[name])
            return smooth.outputs[0]
        tangent = build.calculated("TANGENT", build.calculated("ARCCOSINE", cosine))
        kept = build.calculated("SUBTRACT", 1.0, build.calculated("MULTIPLY", tangent, lamp.cone[0]))
        return build.calculated("MULTIPLY", build.calculated("MAXIMUM", kept, 0.0), lamp.cone[1])

    def _between(self, part: bpy.types.NodeSocket) -> bpy.types.NodeSocket:
        """Return 1 if a point of the light path lies between the mirror and the source, else 0.

        `part` is its position: 0 at the mirror, 1 at the source.
        """
        return self._all(self.build.calculated("GREATER_THAN", part, 0.0),
                         self.build.calculated("LESS_THAN", part, 1.0))

    def _all(self, first: bpy.types.NodeSocket, *others: bpy.types.NodeSocket) -> bpy.types.NodeSocket:
        for other in others:
            first = self.build.calculated("MULTIPLY", first, other)
        return first
