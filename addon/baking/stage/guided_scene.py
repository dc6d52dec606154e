"""Light that was baked in bands, to be denoised as Cycles does where it bakes in one: objects shine it, alone."""
from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager

import bpy

from ...reading.materials import one_output
from ...rendering import denoise, with_cycles
from ...writing import UV_MAP

GUIDES = 1  # samples of albedo and normals, which have hardly any noise
# of all that is met: what materials do, but no light
PASSES = {"EMIT", "DIFFUSE", "GLOSSY", "TRANSMISSION"}
RAYS = ("visible_camera", "visible_diffuse", "visible_glossy", "visible_transmission", "visible_shadow")
LIKE = ("device", "denoising_use_gpu", "denoising_quality")


@contextmanager
def guided_scene(like: bpy.types.Scene, objects: list, switches: list,
                 image: bpy.types.Image) -> Iterator[bpy.types.Scene]:
    """A scene like another in which `objects` stand alone and what they are of shines the texels of an image, and
    nothing else, as `switches` then say: a bake of `PASSES` is that image, denoised by albedo and normals."""
    with ExitStack() as back:
        scene = bpy.data.scenes.new(UV_MAP)
        back.callback(bpy.data.scenes.remove, scene)
        with_cycles(scene)
        for name in LIKE:
            if hasattr(like.cycles, name):
                setattr(scene.cycles, name, getattr(like.cycles, name))
        scene.render.threads_mode, scene.render.threads = like.render.threads_mode, like.render.threads
        scene.cycles.use_adaptive_sampling, scene.cycles.samples = False, GUIDES
        denoise(scene.cycles, "FAST")
        scene.render.bake.view_from, scene.camera = "ACTIVE_CAMERA", like.camera
        for obj in (*objects, like.camera):
            scene.collection.objects.link(obj)
        for obj in objects:
            # rays end at what is met first; but what nothing may meet is not in the scene at all
            for name, met in (*((name, False) for name in RAYS), ("visible_volume_scatter", True)):
                back.callback(setattr, obj, name, getattr(obj, name))
                setattr(obj, name, met)
        for switch in switches:
            back.callback(setattr, switch, "default_value", switch.default_value)
            switch.default_value = 1.0
        for material in {slot.material for obj in objects for slot in obj.material_slots}:
            back.enter_context(_shining(material, image))
        yield scene


@contextmanager
def _shining(target: bpy.types.Material, image: bpy.types.Image) -> Iterator[None]:
    """Let a material shine the texels of an image, beside what else it does."""
    tree, output, cycles = target.node_tree, one_output(target.node_tree), target.cycles
    if output is None:
        yield
        return
    socket = output.inputs["Surface"]
    link = next(iter(socket.links), None)
    before, muted = (None, False) if link is None else (link.from_socket, link.is_muted)
    sampling = cycles.emission_sampling
    # it is met by no ray: to count it among the lamps would take time for nothing
    cycles.emission_sampling = "NONE"
    made = [tree.nodes.new(kind) for kind in ("ShaderNodeUVMap", "ShaderNodeTexImage", "ShaderNodeEmission",
                                              "ShaderNodeAddShader")]
    uv, texels, glow, both = made
    try:
        if before is not None and not muted:
            tree.links.new(before, both.inputs[0])
        uv.uv_map, texels.image, texels.interpolation = UV_MAP, image, "Closest"
        tree.links.new(uv.outputs["UV"], texels.inputs["Vector"])
        tree.links.new(texels.outputs["Color"], glow.inputs["Color"])
        tree.links.new(glow.outputs[0], both.inputs[1])
        tree.links.new(both.outputs[0], socket)
        yield
    finally:
        if before is not None:
            tree.links.new(before, socket).is_muted = muted
        for node in made:
            tree.nodes.remove(node)
        cycles.emission_sampling = sampling
