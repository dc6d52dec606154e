"""A temporary scene in which Cycles bakes the light on objects, by stand-ins whose triangles have room of their own."""
from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import bpy

from ....core import View
from ...faults import still_there
from ...reading import forgets_particles, goes_by_name, is_result
from ...rendering import OwnCollections, copied_scene, look_through, put_swift_world
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
        own = OwnCollections(context, scene, back)
        look_through(scene, bpy.data.objects.new(UV_MAP, bpy.data.cameras.new(UV_MAP)), back)
        count_the_mirror(scene, back)
        # only the camera would see results, and Cycles takes up their pictures of light for each band, hidden or not
        own.remove([obj for obj in context.view_layer.objects if is_result(obj)])
        own.leave_out(sources)
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
            if stand.told is None and goes_by_name(sources[stand.owner]) and not (
                    sources[stand.owner].library or forgets_particles(sources[stand.owner])):
                swap_names(sources[stand.owner], obj)
                back.callback(swap_names, sources[stand.owner], obj)
        link_lamps([(sources[owner], obj) for owner, obj in objects], back)
        # Cycles clamps a lamp's body one bounce later than what lamps light
        own, of_all = context.scene.cycles.sample_clamp_direct, scene.cycles.sample_clamp_direct
        yield BakeScene(scene, objects, targets, switches, None if opacity or own == of_all else own)


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
