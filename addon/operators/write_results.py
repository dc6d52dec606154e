"""All results of a generation, written at once or not at all, and what there is to tell of them."""
from __future__ import annotations

from dataclasses import dataclass, field

import bpy

from ...core import View
from ..faults import AllOrNothing, listed, one_or_more
from ..frames import stop_playing
from ..lamps import lamps_before, lamps_that_show
from ..lighting import (
    can_be_lit,
    forget_previews,
    is_lit,
    keep_light,
    lacks_mattes,
    needs_light,
    show_previews,
    show_world,
    shows_preview,
    update_mattes,
)
from ..reading import DiffuseScene, mirrors_of, results_of
from ..writing import (
    Reflection,
    gather,
    mesh_bytes,
    protect,
    put_back_materials,
    show_for_camera,
    size_text,
    told_of,
    write_object,
)
from .shortcomings import WORTH_TELLING, better_of_points

CUT = "it shows other faces"


@dataclass(frozen=True)
class Manners:
    """Options for writing results, besides the method.

    Attributes
    ----------
    collect : bool
        Put new results into the scene's collection of results instead of beside their mirrors.
    preview_unlit : bool
        Results that lose their light show a preview instead of materials that lamps light.
    protect : bool
        Make results unselectable and lock their transforms.
    preview : bool
        All results without light show a preview.
    """

    collect: bool = False
    preview_unlit: bool = False
    protect: bool = False
    preview: bool = False


@dataclass(frozen=True)
class Outcome:
    """The outcome of a generation.

    Attributes
    ----------
    results : list of (bpy.types.Object, core.ReflectionMesh)
        One for each mirror.
    remarks : list of str
        Sentences on what was left out or lost.
    unlit : list of bpy.types.Object
        Results that must still be lit.
    news : list of str
        Sentences on other things worth knowing.
    copies : list of bpy.types.Object
        The user's copies of results, updated with them.
    dropped : list of str
        Sentences on results whose light was removed because it no longer fits.
    lacks : list of str
        Sentences on what a mirror lacks although something is visible in it.
    read : tuple
        Inputs: the view, the surface of each mirror, the diffuse scene.
    """

    results: list
    remarks: list
    unlit: list
    news: list
    copies: list
    dropped: list = field(default_factory=list)
    lacks: list = field(default_factory=list)
    read: tuple = ()

    def summary(self, seconds: float) -> str:
        """Return one line on what was generated."""
        points = sum(obj.reflection_mesh.points for obj, _ in self.results)
        faces = sum(obj.reflection_mesh.faces for obj, _ in self.results)
        size = (one_or_more(points, "1 point", "{count} points") if points
                else one_or_more(faces, "1 face", "{count} faces"))
        error = max(result.estimated_error for _, result in self.results)
        share = max(result.filled_share for _, result in self.results)
        filled = f", {share:.1f} % filled by rays" if share >= WORTH_TELLING else ""
        names = listed(obj.name for obj, _ in self.results)
        memory = size_text(sum(mesh_bytes(mesh) for mesh in {obj.data for obj, _ in self.results}
                               | {copy.data for copy in self.copies}))
        light = "; not lit yet" if self.unlit else ""
        return f"{names}: {size}, {memory}, error about {error:.2f} px{filled}, {seconds:.2f} s{light}"


def write_results(context: bpy.types.Context, prepared: list[Reflection], view: View, scene: DiffuseScene,
                  manners: Manners, unfit: dict[bpy.types.Object, str]) -> Outcome:
    """Write all results or none; `view` saw what they show of `scene`, and `unfit` says why light no longer fits."""
    there, remarks = set(context.scene.objects), []
    previewed = {obj for made in prepared for obj in results_of(context, made.mirror)
                 if shows_preview(obj) or (manners.preview_unlit and is_lit(obj))}
    lamps, lit = lamps_that_show(context), {obj for obj in there if is_lit(obj)}
    with AllOrNothing() as whole:
        written = [write_object(context, made, whole) for made in prepared]
        for made, group in zip(prepared, written):
            for entry in group:
                remarks += put_back_materials(entry.obj, made.arrays.materials, entry.changes)
                whole.after(stop_playing, entry.obj)
        keep_light([entry.obj for group in written for entry in group if not unfit.get(entry.obj)], view,
                   whole)
        results = [(group[0].obj, made.result) for group, made in zip(written, prepared)]
        entries = [entry for group in written for entry in group]
        unlit = [entry.obj for entry in entries
                 if not is_lit(entry.obj) and (needs_light(entry.obj)
                                               or lamps_before(entry.obj.data, lamps, mirrors_of(entry.obj)))]
        # reflections of one mirror share their mesh
        for obj in {obj.data: obj for obj in (entry.obj for entry in entries)}.values():
            if obj.reflection_mesh.world_faces == "ALWAYS" and not is_lit(obj) and can_be_lit(obj):
                show_world(obj, view, context.scene.world, whole)
        show_previews([obj for obj in unlit if manners.preview or obj in previewed], view, lamps, whole)
        if manners.collect:
            gather(context, [obj for obj, _ in results if obj not in there], whole)
        if manners.protect:
            whole.after(protect, [obj for obj, _ in results])
        whole.after(forget_previews)
        whole.after(show_for_camera, context.scene)
    dropped = [f"The light of '{entry.obj.name}' no longer fits: {unfit.get(entry.obj) or CUT}. Click Light Reflection."
               for entry in entries if entry.obj in lit and not is_lit(entry.obj)]
    update_mattes(context)
    remarks += [f"'{entry.obj.name}' has no mattes, because Attributes is Shown. Set Attributes to All and generate "
                "again." for entry in entries if lacks_mattes(entry.obj)]
    news = _told(entries) + [hint for made in prepared for hint in better_of_points(made.mirror.name, made.result)]
    return Outcome(results, remarks, unlit, news, [entry.obj for entry in entries if entry.copy], dropped)


def _told(written: list) -> list[str]:
    """Return sentences on results that the user had moved, and on their copies."""
    moved = [entry.obj.name for entry in written if entry.changes.moved is not None and not entry.copy]
    news = [sentence for entry in written for sentence in told_of(entry.obj, entry.freed)]
    news += [f"'{name}' stays moved, as you left it: clear it and generate again to have it on its mirror."
            for name in moved]
    copies = [entry.obj.name for entry in written if entry.copy]
    if copies:
        news.append(f"Updated too, as a copy: {listed(copies)}.")
    return news
