"""How opaque materials are, as nodes: what a bake of light cannot tell, since it ends at the first surface."""
from __future__ import annotations

import bpy

from ..reading.materials import one_output, surface_shader
from ..writing.nodes.shader_builder import ShaderBuilder, given, node_behind
from .layer_weights import layer_weights_as_fresnel

OPEN = {"BSDF_TRANSPARENT", "HOLDOUT"}
REFRACTING = {"FRESNEL", "BSDF_GLASS", "BSDF_REFRACTION"}
GLOWING = {"EMISSION": "Strength", "BSDF_PRINCIPLED": "Emission Strength"}  # by which input
# what is asked of a ray that a mirror has sent, from what is asked of one of the camera's: by which operation with
# which number, None for whether it is the camera's; that first, so that none of those is taken for the material's own
SENT_BY_A_MIRROR = {"Is Camera Ray": ("MULTIPLY", 0.0), "Is Glossy Ray": ("MAXIMUM", None),
                    "Is Singular Ray": ("MAXIMUM", None), "Is Reflection Ray": ("MAXIMUM", None),
                    "Ray Depth": ("ADD", 1.0), "Glossy Depth": ("ADD", 1.0)}


def without_openings(tree: bpy.types.NodeTree) -> None:
    """Let a material be opaque where it is baked, as if nothing of what lies behind came through; for light that falls
    on it or through it, it is what it was."""
    for node in list(tree.nodes):
        if node.type == "BSDF_PRINCIPLED":
            _unless_baked(tree, node.inputs["Alpha"], 1.0)
        elif node.type == "MIX_SHADER":
            through = [_shader_behind(socket) in OPEN for socket in node.inputs[1:3]]
            if through[0] != through[1]:
                _unless_baked(tree, node.inputs[0], float(through[0]))


def turn_over(tree: bpy.types.NodeTree) -> None:
    """Let a material take the front of what it is on for the back."""
    build = ShaderBuilder(tree)
    for node in [node for node in tree.nodes if node.type == "NEW_GEOMETRY"]:
        links = list(node.outputs["Backfacing"].links)
        front = build.calculated("SUBTRACT", 1.0, node.outputs["Backfacing"]) if links else None
        for link in links:
            build.feed(front, link.to_socket)
    layer_weights_as_fresnel(build, tree.nodes)
    # of what is seen from within Cycles takes the inverse index; of a Principled BSDF for what comes through it alone
    for node in [node for node in tree.nodes if node.type in REFRACTING or _is_clear(node)]:
        build.feed(build.calculated("DIVIDE", 1.0, given(node.inputs["IOR"])), node.inputs["IOR"])


def hide_own_light(tree: bpy.types.NodeTree) -> list[bpy.types.NodeSocket]:
    """Let a material have no light of its own where it is baked, as long as all of the sockets that are returned are
    1; what it sends to others, and to itself, it sends still. A bake that leaves emission out would leave that out too.
    """
    build, switches = ShaderBuilder(tree), []
    for node in [node for node in tree.nodes if node.type in GLOWING]:
        strength = node.inputs[GLOWING[node.type]]
        if not strength.is_linked and strength.default_value == 0.0:
            continue
        switch, path = build.add("ShaderNodeValue").outputs[0], build.add("ShaderNodeLightPath")
        switch.default_value = 0.0
        hidden = build.calculated("MULTIPLY", switch, path.outputs["Is Camera Ray"])
        shown = build.calculated("SUBTRACT", 1.0, hidden)
        build.feed(build.calculated("MULTIPLY", given(strength), shown), strength)
        switches.append(switch)
    return switches


def as_mirrors_see(tree: bpy.types.NodeTree) -> None:
    """Let a material take the first of a light path's rays, which is the one that is baked, for one that a mirror has
    sent: what is to be seen in mirrors alone, or not in them, goes by that."""
    for node in [node for node in tree.nodes if node.type == "LIGHT_PATH"]:
        for name, (operation, other) in SENT_BY_A_MIRROR.items():
            links = list(node.outputs[name].links)
            if not links:
                continue
            math = tree.nodes.new("ShaderNodeMath")
            math.operation, math.inputs[1].default_value = operation, other or 0.0
            tree.links.new(node.outputs[name], math.inputs[0])
            if other is None:
                tree.links.new(node.outputs["Is Camera Ray"], math.inputs[1])
            for link in links:
                tree.links.new(math.outputs[0], link.to_socket)


def show_opacity(tree: bpy.types.NodeTree) -> None:
    """Let a material emit how opaque it is, from 0 to 1."""
    output = one_output(tree)
    if output is None:
        return
    shader = surface_shader(tree)
    glow = tree.nodes.new("ShaderNodeEmission")
    _feed(tree, opacity_of(tree, shader), glow.inputs["Color"])
    tree.links.new(glow.outputs[0], output.inputs["Surface"])


def opacity_of(tree: bpy.types.NodeTree, shader: bpy.types.Node | None):
    """A socket or a number: how opaque what a shader node makes is."""
    if shader is None or shader.type in OPEN:
        return 0.0
    if shader.type == "BSDF_PRINCIPLED":
        return given(shader.inputs["Alpha"])
    if shader.type == "MIX_SHADER":
        mixed = tree.nodes.new("ShaderNodeMix")
        _feed(tree, given(shader.inputs[0]), mixed.inputs[0])
        for place, socket in zip((2, 3), shader.inputs[1:3], strict=True):
            _feed(tree, opacity_of(tree, node_behind(socket)), mixed.inputs[place])
        return mixed.outputs[0]
    return 1.0


def _unless_baked(tree: bpy.types.NodeTree, socket: bpy.types.NodeSocket, value: float) -> None:
    """Give a socket a value for the first of a light path's rays, which are those that are baked."""
    mixed, path = tree.nodes.new("ShaderNodeMix"), tree.nodes.new("ShaderNodeLightPath")
    tree.links.new(path.outputs["Is Camera Ray"], mixed.inputs[0])
    _feed(tree, given(socket), mixed.inputs[2])
    mixed.inputs[3].default_value = value
    tree.links.new(mixed.outputs[0], socket)


def _feed(tree: bpy.types.NodeTree, value, socket: bpy.types.NodeSocket) -> None:
    if isinstance(value, float):
        socket.default_value = (value,) * 3 + (1.0,) if socket.type == "RGBA" else value
    else:
        tree.links.new(value, socket)


def _is_clear(node: bpy.types.Node) -> bool:
    """Whether all of a Principled BSDF is glass."""
    if node.type != "BSDF_PRINCIPLED" or node.inputs["Transmission Weight"].is_linked:
        return False
    return node.inputs["Transmission Weight"].default_value == 1.0


def _shader_behind(socket: bpy.types.NodeSocket) -> str:
    node = node_behind(socket)
    return "" if node is None else node.type
