"""Layer Weights as Fresnel nodes, whose index may be told."""
from __future__ import annotations

from collections.abc import Iterable

import bpy

from ..writing.nodes.shader_builder import ShaderBuilder, given


def layer_weights_as_fresnel(build: ShaderBuilder, nodes: Iterable[bpy.types.Node]) -> None:
    """Let Fresnel nodes tell what the Layer Weights among nodes tell as Fresnel."""
    for node in [node for node in nodes if node.type == "LAYER_WEIGHT"]:
        links = list(node.outputs["Fresnel"].links)
        if not links:
            continue
        fresnel = build.add("ShaderNodeFresnel")
        rest = build.calculated("SUBTRACT", 1.0, given(node.inputs["Blend"]))
        build.feed(build.calculated("DIVIDE", 1.0, rest), fresnel.inputs["IOR"])
        if node.inputs["Normal"].is_linked:
            build.feed(given(node.inputs["Normal"]), fresnel.inputs["Normal"])
        for link in links:
            build.feed(fresnel.outputs[0], link.to_socket)
