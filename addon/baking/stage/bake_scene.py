"""A temporary scene in which Cycles bakes the light on objects, by stand-ins whose triangles have room of their own."""
from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import bpy

from ....core import View
from ...faults import still_there
from ...reading import forgets_particles, is_result, rendered_collections
from ...rendering import copied_scene, look_through, put_swift_world
from ...writing import UV_MAP
from .bake_targets import new_target
from .bakes import BakeScene
from .linked_lamps import count_the_mirror, link_lamps
from .stand_ins import StandIn, new_object, swap_names


@contextmanager
def bake_scene(context: bpy.types.Context, view: View, sources: list, stands: list[tuple[StandIn, bpy.types.Mesh]], *,
               opacity: bool, backs: bool) -> Iterator[BakeScene]:
    """The user's scene as a copy, with stand-ins, each with its mesh, in place of `sources`; with `opacity` they glow
    by how opaque they are, and with `backs` what is baked is turned over. What materials ask of the camera is answered
    as to `view`. The meshes go with the scene."""
    with copied_scene(context, UV_MAP) as (scene, back):
        made = [mesh for _, mesh in stands]
        back.callback(lambda: bpy.data.batch_remove(still_there(made)))
        _prepare(scene)
        if opacity:
            # they glow by themselves
            scene.world = None
        else:
            put_swift_world(scene, back)
        look_through(scene, bpy.data.objects.new(UV_MAP, bpy.data.cameras.new(UV_MAP)), back)
        _without_results(scene)
        count_the_mirror(scene, back)
        whole = list(filter(forgets_particles, sources))
        _take_out(scene, whole)
        for source in sources:
            if source in whole:
                continue
            back.callback(setattr, source, "hide_render", source.hide_render)
            source.hide_render = True
        materials = dict.fromkeys(material for stand, _ in stands for material in stand.mesh.materials or (None,))
        switches: list = []
        targets = {material: new_target(material, view, (opacity, backs), made, switches) for material in materials}
        objects = []
        for stand, mesh in stands:
            obj = new_object(sources[stand.owner], stand, mesh)
            made.append(obj)
            scene.collection.objects.link(obj)
            objects.append((stand.owner, obj))
            # linked objects keep their names, and a new one is a change
            if stand.told is None and sources[stand.owner].library is None and sources[stand.owner] not in whole:
                swap_names(sources[stand.owner], obj)
                back.callback(swap_names, sources[stand.owner], obj)
        link_lamps([(sources[owner], obj) for owner, obj in objects], back)
        # Cycles clamps a lamp's body one bounce later than what lamps light
        own, of_all = context.scene.cycles.sample_clamp_direct, scene.cycles.sample_clamp_direct
        yield BakeScene(scene, objects, targets, switches, None if opacity or own == of_all else own)


def _without_results(scene: bpy.types.Scene) -> None:
    """Let no reflection be in a temporary scene, as far as that changes nothing of the user's: only the camera would
    see it, and Cycles takes up its picture of light for each band, be it hidden or not."""
    for obj in [obj for obj in scene.collection.objects if is_result(obj)]:
        scene.collection.objects.unlink(obj)
    layers = [scene.view_layers[0].layer_collection]
    while layers:
        layer = layers.pop()
        held = layer.collection.all_objects
        if held and all(is_result(obj) for obj in held):
            layer.exclude = True
        else:
            layers.extend(layer.children)


def _take_out(scene: bpy.types.Scene, objects: list) -> None:
    """Let objects be in no render of a temporary scene, without a change of their own: whatever else is in their
    collections is in the scene by itself."""
    if not objects:
        return
    root = scene.view_layers[0].layer_collection
    rendered, layers = rendered_collections(root), list(root.children)
    for obj in [obj for obj in objects if obj.name in scene.collection.objects]:
        scene.collection.objects.unlink(obj)
    while layers:
        layer = layers.pop()
        layers.extend(layer.children)
        if layer.exclude or layer.collection not in rendered or not any(obj in objects
                                                                        for obj in layer.collection.objects):
            continue
        # all that is within is excluded with it
        within = [(inner, inner.exclude) for inner in _within(layer)]
        layer.exclude = True
        for inner, excluded in within:
            inner.exclude = excluded
        for obj in [obj for obj in layer.collection.objects if obj not in objects]:
            if obj.name not in scene.collection.objects:
                scene.collection.objects.link(obj)


def _within(layer: bpy.types.LayerCollection) -> list:
    """What is in a collection of a view layer, each before what is in it."""
    return [inner for child in layer.children for inner in (child, *_within(child))]


def _prepare(scene: bpy.types.Scene) -> None:
    bake = scene.render.bake
    for name in ("use_pass_direct", "use_pass_indirect", "use_pass_diffuse", "use_pass_glossy", "use_pass_transmission",
                 "use_pass_emit"):
        setattr(bake, name, True)
    bake.view_from = "ACTIVE_CAMERA"
    cycles = scene.cycles
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    # the eye sees by way of the mirror, which is one bounce, and whose light counts as indirect
    cycles.max_bounces, cycles.glossy_bounces = max(cycles.max_bounces - 1, 0), max(cycles.glossy_bounces - 1, 0)
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect
    # the picture that shows the light is exposed
    cycles.film_exposure = 1.0
