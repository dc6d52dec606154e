"""Pictures projected from the six sides of a box, by a normal that is told: Blender's own go by the surface's."""
from __future__ import annotations

import bpy

from .shader_builder import ShaderBuilder, given

STEP = 1e-6  # stands for no blend at all
ALIKE = ("image", "interpolation", "extension")
FRAMES = ("frame_duration", "frame_offset", "frame_start", "use_auto_refresh", "use_cyclic")


def project_by(build: ShaderBuilder, picture: bpy.types.Node, normal: bpy.types.NodeSocket) -> None:
    """Let three flat pictures, mixed by `normal` in the object's own space, stand for one that is projected by box.

    The sides and how they blend are those of Cycles (`svm_node_tex_image_box`); in the small triangle in which three
    sides meet, the blend of pairs is carried on.
    """
    at, parts = build.separated(given(picture.inputs["Vector"])), build.separated(normal)
    shares = _shares(build, normal, max(picture.projection_blend, STEP))
    sides = []
    # coordinates that each side shows, and the sign of the normal on this axis for which it is mirrored
    for axis, (across, up, turned) in enumerate(((1, 2, "LESS_THAN"), (0, 2, "GREATER_THAN"), (1, 0, "GREATER_THAN"))):
        over = build.calculated(turned, parts[axis], 0.0)
        way = build.calculated("SUBTRACT", 1.0, build.calculated("MULTIPLY", over, 2.0))
        x = build.calculated("ADD", build.calculated("MULTIPLY", at[across], way), over)
        sides.append(_side(build, picture, build.combined(x, at[up], 0.0)))
    for name in ("Color", "Alpha"):
        links = list(picture.outputs[name].links)
        if links:
            mixed = [build.vector("SCALE", side.outputs[name], Scale=share) for side, share in zip(sides, shares)]
            both = build.vector("ADD", build.vector("ADD", mixed[0], mixed[1]), mixed[2])
            shown = both if name == "Color" else build.separated(both)[0]
            for link in links:
                build.feed(shown, link.to_socket)


def _side(build: ShaderBuilder, picture: bpy.types.Node, place: bpy.types.NodeSocket) -> bpy.types.Node:
    side = build.add("ShaderNodeTexImage", **{name: getattr(picture, name) for name in ALIKE})
    for name in FRAMES:
        setattr(side.image_user, name, getattr(picture.image_user, name))
    build.feed(place, side.inputs["Vector"])
    return side


def _shares(build: ShaderBuilder, normal: bpy.types.NodeSocket, blend: float) -> tuple:
    """Return the weights of the three sides. Two sides blend where their components of the normal are about equal. The
    weight of a side is the smaller one of its two pairs.
    """
    size = build.vector("ABSOLUTE", normal)
    x, y, z = build.separated(size)
    share = build.vector("DIVIDE", size, build.vector("ADD", size, build.combined(y, z, x)))
    edge = 0.5 * (1.0 - blend)
    first = build.vector("SCALE", build.vector("SUBTRACT", share, (edge,) * 3), Scale=1.0 / blend)
    first = build.vector("MINIMUM", build.vector("MAXIMUM", first, (0.0,) * 3), (1.0,) * 3)
    xy, yz, zx = build.separated(first)
    least = build.vector("MINIMUM", first, build.vector("SUBTRACT", (1.0,) * 3, build.combined(zx, xy, yz)))
    whole = build.dot(least, (1.0,) * 3)
    return build.separated(build.vector("SCALE", least, Scale=build.calculated("DIVIDE", 1.0, whole)))
