"""Inputs from which the light of results was made, and the first one that differs now.

Light is outdated where an input differs, by digest, and fits again as soon as the input is back.
"""
from __future__ import annotations

import json
from collections.abc import Iterable
from hashlib import blake2b

import bpy

from ...core import ReflectionError, View
from ..frames import plays
from ..reading import is_result, lost_mirror, mirrors_of, read_view, render_size
from .answers import answer
from .made_from import LONGEST, SIZE_DIFFERS, view_numbers
from .made_from import same_view as is_same_view
from .materials import SIZE
from .rendered import rendered

# the parts of a record, in the order in which they are compared, and what is said where they differ
DIFFERENT = {"view": "the camera has changed", "mirror": "the mirror has changed", "objects": "an object has changed",
             "materials": "a material has changed", "lamps": "the lamps or the world have changed",
             "settings": "the render settings have changed", "sources": "it shows other objects"}
OF_A_VIEW = {"view", "sources", "mirror"}  # parts by which other points are seen, whose light is what it was
RENDER = ("use_simplify", "simplify_subdivision_render", "simplify_child_particles_render", "hair_type", "hair_subdiv")
CYCLES = ("max_bounces", "diffuse_bounces", "glossy_bounces", "transmission_bounces", "volume_bounces",
          "transparent_max_bounces", "caustics_reflective", "caustics_refractive", "blur_glossy", "sample_clamp_direct",
          "sample_clamp_indirect", "pixel_filter_type", "filter_width", "use_fast_gi", "fast_gi_method",
          "ao_bounces_render", "volume_step_rate", "volume_max_steps", "volume_unbiased", "dicing_rate",
          "max_subdivisions", "use_light_linking", "texture_limit_render")
FAST_GI = ("ao_factor", "distance")  # properties of the world's light_settings


def lit_record(context: bpy.types.Context, view: View, lit: Iterable[bpy.types.Object], settings: dict) -> dict:
    """Return by result the text that it keeps, if `lit` are lit together now; `settings` are those of the operator."""
    lit = list(lit)
    mirrors = [mirror for result in lit for mirror in mirrors_of(result)]
    names = sorted({mirror.name_full for mirror in mirrors})
    known = {"view": [float(f"{number:.8g}") for number in view_numbers(view)], "mirrors": names, "lit_with": settings}
    return {result: json.dumps({**known, **_inputs(context, result, _sources(result), mirrors)}) for result in lit}


def lit_with(result: bpy.types.Object) -> dict:
    """Return the settings that a result was lit with; empty where it does not know them."""
    return _read(result).get("lit_with", {})


def why_light_differs(context: bpy.types.Context, result: bpy.types.Object) -> str:
    """Return what has changed since a result was lit, in a few words; "" where nothing has, or nobody can tell.

    As cheap as a look: the answer is kept until something changes again.
    """
    record = result.reflection_mesh
    if record.light_material is None or not record.lit_from or plays(result) or lost_mirror(result):
        return ""
    camera = context.scene.camera
    return answer(_changed, context, result, (record.lit_from, _settings(context), render_size(context.scene),
                                              None if camera is None else camera.session_uid))


def _changed(context: bpy.types.Context, result: bpy.types.Object) -> str:
    """Return the first input that differs from when a result was lit, in a few words."""
    try:
        return light_difference(context, read_view(context), result, _sources(result))
    except ReflectionError:
        return DIFFERENT["view"]


def light_difference(context: bpy.types.Context, view: View, result: bpy.types.Object, sources: list,
                     same_view: bool = True, same_mirror: bool = False) -> str:
    """Return what `why_light_differs` does, for a view and the sources that the result is to show.

    Without `same_view`, the view, the result's size and, without `same_mirror`, the mirror may be others than those it
    was lit for.
    """
    made, record = _read(result), result.reflection_mesh
    if not made:
        # results of earlier versions have no record
        return DIFFERENT["view"]
    # compare the view first: it is cheap, and while the camera is dragged nothing else is compared
    if same_view:
        numbers = view_numbers(view)
        if numbers[32:] != made["view"][32:]:
            return SIZE_DIFFERS
        if not is_same_view(made["view"], numbers):
            return DIFFERENT["view"]
    names, mirrors = set(made["mirrors"]), {*mirrors_of(result)}
    for obj in context.scene.objects:
        if obj.name_full in names:
            mirrors.add(obj)
        elif is_result(obj) and obj.reflection_mesh.light_material == record.light_material:
            mirrors |= {*mirrors_of(obj)}
    now = _inputs(context, result, sources, mirrors - {None})
    left_out = set() if same_view else OF_A_VIEW - ({"mirror"} if same_mirror else set())
    return next((sentence for name, sentence in DIFFERENT.items()
                 if name in now and name not in left_out and made.get(name, now[name]) != now[name]), "")


def _inputs(context: bpy.types.Context, result: bpy.types.Object, sources: list,
            mirrors: Iterable[bpy.types.Object]) -> dict:
    """Return digests of all inputs of a result's light except its view, by the keys of `DIFFERENT`."""
    shown, own = rendered(context), {mirror.session_uid for mirror in mirrors_of(result)}
    moving = {mirror.session_uid for mirror in mirrors}
    part_of = [shown.objects.get(source.session_uid, b"") for source in sources if source is not None]
    others = [digest for uid, digest in shown.objects.items() if uid not in moving]
    # objects that move with the view may be other mirrors of the same light
    mirror = [shown.objects.get(uid, b"") for uid in moving - own]
    materials = [shown.materials[uid] + (b"" if uid in moving else shown.objects[uid]) for uid in shown.materials]
    return {"sources": _digest(part_of),
            "mirror": _digest([*mirror, *(b"own" + shown.objects.get(uid, b"") for uid in own)]),
            "objects": _digest(others), "materials": _digest(materials), "lamps": shown.lamps,
            "settings": _settings(context)}


def _settings(context: bpy.types.Context) -> str:
    """Return a digest of the render settings on which light depends."""
    scene = context.scene
    known = [[getattr(scene.render, name, None) for name in RENDER],
             [getattr(getattr(scene, "cycles", None), name, None) for name in CYCLES],
             scene.view_settings.view_transform in {"Standard", "Raw"}, scene.view_settings.exposure]
    if scene.world is not None and getattr(getattr(scene, "cycles", None), "use_fast_gi", False):
        known.append([getattr(scene.world.light_settings, name) for name in FAST_GI])
    return _digest([repr(known).encode()])


def _sources(result: bpy.types.Object) -> list:
    return [source.object for source in result.reflection_mesh.sources if source.object is not None]


def _digest(parts: list[bytes]) -> str:
    return blake2b(b"".join(sorted(parts)), digest_size=SIZE).hexdigest()


def _read(result: bpy.types.Object) -> dict:
    """Return what `lit_record` wrote; empty if it wrote nothing."""
    text = result.reflection_mesh.lit_from
    try:
        known = json.loads(text) if 0 < len(text) <= LONGEST else {}
        return {**known, "view": tuple(map(float, known["view"])), "mirrors": list(known["mirrors"]),
                "lit_with": dict(known["lit_with"])} if known else {}
    except (ValueError, TypeError, KeyError, RecursionError):
        return {}
