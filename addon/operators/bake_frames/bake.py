"""A range of frames as files: each made anew from the open file, which is as it was afterwards."""
from __future__ import annotations

import os
from collections import Counter
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field

import bpy

from .... import core
from ...faults import AllOrNothing, Steps, part, still_there
from ...files import check_folder, staged
from ...frames import (
    FrameRecord,
    Sequence,
    file_name,
    record_path,
    set_aside,
    told_apart,
    write_image,
    write_record,
    write_result,
    writes_usd,
)
from ...freshness import frame_origin
from ...reading import Assembly, NothingSeen, Participants, candidates, choose, read_view
from ...settings import of_each
from ..assembled import assembled
from ..clear import clear
from ..generate import generation
from ..light import lighting
from ..shortcomings import Refused
from .plan import (
    Plan,
    compared,
    found_frames,
    joined_or_none,
    lacking,
    open_frame,
)
from .thrown_light import ThrownLight

IN_OBJECT_MODE = "Reflections are baked in Object Mode: leave the present mode first."
NO_USD = "This Blender cannot write USD files, nor play them: bake and play with one that can, as those of blender.org."


@dataclass(frozen=True)
class Reflections:
    """Bakes reflections in mirrors frame by frame. This is the default.

    Attributes
    ----------
    mirrors : list of Assembly
    diffuse : list of bpy.types.Object
    lacks : dict
        Sentences on what is missing in mirrors, by frame.
    """

    mirrors: list[Assembly]
    diffuse: list
    lacks: dict = field(default_factory=dict)

    role, layers = "REFLECTION", 0

    @property
    def keys(self) -> list[str]:
        """Keys of the results in the records of frames: the names of the mirrors."""
        return [one.mirror.name for one in self.mirrors]

    def take(self, name: str) -> str:
        """Return the name under which a sequence stores its records."""
        return name

    def file(self, key: str, take: str) -> str:
        return f"{told_apart(self.keys)[key]} Reflection {take}".strip()

    def made_with(self, context: bpy.types.Context, plan: Plan, camera: bpy.types.Object | None) -> dict:
        return plan.made_with(context, camera, [one.mirror for one in self.mirrors])

    def origin(self, context: bpy.types.Context, plan: Plan) -> dict:
        """Return the inputs of the open frame, as text by mirror."""
        return frame_origin(context, self._chosen(context), bool(plan.samples))

    def _chosen(self, context: bpy.types.Context) -> Participants | None:
        return joined_or_none(context, self.mirrors, self.diffuse)

    def frame(self, context: bpy.types.Context, plan: Plan, results: list) -> Steps[None]:
        """Generate and light the open frame, adding to `results` as soon as they are there."""
        lacks = self.lacks.setdefault(context.scene.frame_current, [])
        return _results(context, plan, self._chosen(context), results, lacks)

    def by_key(self, results: list) -> dict:
        return {obj.reflection_mesh.mirror.name: obj for obj in results}

    def materials_of(self, result: bpy.types.Object | None) -> list | None:
        """Return the materials to record for a result; None for those of its mesh."""
        return None

    def clear(self, context: bpy.types.Context, results: list) -> None:
        clear(context, still_there(results))


def baking(context: bpy.types.Context, plan: Plan, tell: Callable[[FrameRecord], None] = lambda record: None,
           remark: Callable[[str], None] = lambda sentence: None) -> Steps[list]:
    """Bake all frames of a plan, yielding (fraction, stage). If closed at any step, restore the file and keep the
    finished frames in their folder.

    Parameters
    ----------
    tell : callable
        Called with the record of each finished frame.
    remark : callable
        Called with sentences on frames that are kept although the scene has changed, and on what frames lack.

    Returns
    -------
    sequences : list of Sequence
        Input of `bake_playing.playing`.

    Raises
    ------
    core.ReflectionError
        If a frame cannot be baked.
    """
    if context.mode != "OBJECT":
        raise core.ReflectionError(IN_OBJECT_MODE)
    if not writes_usd():
        raise core.ReflectionError(NO_USD)
    mirrors, diffuse = candidates(context, unmirrored=bool(plan.lamps))
    if not (mirrors and diffuse):
        choose(context)     # raises an error that says what is missing
    joint = assembled(context, Participants(mirrors, diffuse, []), plan.settings)
    twice = [name for name, count in Counter(mirror.name for mirror in mirrors).items() if count > 1]
    if twice:
        # one of them is linked; frames know mirrors by their names
        raise core.ReflectionError(f"Two mirrors are called '{twice[0]}': rename one of them.")
    baked = ThrownLight.of(context, plan, mirrors, diffuse) if plan.lamps else Reflections(joint, diffuse)
    if not (plan.cameras or plan.lamps):
        read_view(context)
    takes = plan.takes
    share = 1.0 / (len(takes) * len(plan.frames))
    found = [found_frames(context, plan, take, baked) for take in takes]
    if any(record is None for known in found for record in known.values()):
        check_folder(plan.folder)
    with set_aside(context, mirrors, baked.role):
        for (_, camera), known in zip(takes, found):
            yield from part(compared(context, plan, camera, (joint, diffuse), known, remark), 0.0, 0.0)
        for index, ((name, camera), known) in enumerate(zip(takes, found)):
            for number, frame in enumerate(plan.frames):
                start = (index * len(plan.frames) + number) * share
                yield start, f"Frame {frame} {name}".strip()
                if known[frame] is None:
                    open_frame(context, frame, camera)
                    steps = _frame(context, plan, (name, camera), baked)
                    known[frame] = yield from part(steps, start, share, f"Frame {frame}")
                    tell(known[frame])
    for sentence in lacking(baked.lacks):
        remark(sentence)
    placements = {one.mirror.name: of_each(plan.settings)(one.mirror).placement for one in joint}
    render = context.scene.render
    stretch = render.frame_map_old / render.frame_map_new
    return [Sequence(plan.folder, [known[frame] for frame in plan.frames], name, placements,
                     camera.name if camera else "", stretch)
            for (name, camera), known in zip(takes, found)]


def _frame(context: bpy.types.Context, plan: Plan, take: tuple,
           baked: Reflections | ThrownLight) -> Steps[FrameRecord]:
    """Make the open frame: its files take their places when all of them are whole, and its record last."""
    name, camera = take
    frame = context.scene.frame_current
    with AllOrNothing() as whole:
        results: list = []
        whole.undo(baked.clear, context, results)
        made_from = baked.origin(context, plan)
        yield from part(baked.frame(context, plan, results), 0.0, 0.95)
        by_key = baked.by_key(results)
        yield 0.95, "Writing"
        lit = [obj.reflection_mesh.light_material for obj in results if obj.reflection_mesh.light_material]
        image = file_name(f"Light {name}".strip(), frame, "exr") if lit else ""
        made = {}
        place = record_path(plan.folder, baked.take(name), frame)
        with staged(plan.folder) as scratch:
            for number, key in enumerate(baked.keys):
                start, share = 0.95 + 0.04 * number / len(baked.keys), 0.04 / len(baked.keys)
                yield start, f"Writing {key}"
                result = by_key.get(key)
                path = os.path.join(scratch, file_name(baked.file(key, name), frame, "usdc"))
                shows = result is not None and result.reflection_mesh.light_material is not None
                steps = write_result(context, result, path, shows, baked.materials_of(result))
                made[key] = yield from part(steps, start, share, f"Writing {key}")
            if image:
                yield 0.99, "Writing the light"
                write_image(lit[0], os.path.join(scratch, image))
            # from here on the frame is not done until it has a record again
            with suppress(FileNotFoundError):
                os.unlink(place)
        record = FrameRecord(frame, baked.made_with(context, plan, camera), made, image, made_from, baked.layers)
        with staged(plan.folder) as scratch:
            write_record(os.path.join(scratch, os.path.basename(place)), record)
        baked.clear(context, results)
    return record


def _results(context: bpy.types.Context, plan: Plan, chosen, results: list, lacks: list) -> Steps[None]:
    """Generate and light the open frame. Append to `results` as soon as they exist, and to `lacks` sentences on what is
    missing. Append no results if nothing is visible.
    """
    if chosen is None:
        return
    try:
        outcome = yield from part(generation(context, chosen, plan.settings), 0.0, 0.5 if plan.samples else 1.0)
    except NothingSeen:
        return
    except Refused as refused:
        lacks += refused.sentences
        return
    results += [obj for obj, _ in outcome.results]
    lacks += outcome.lacks
    context.view_layer.update()
    if plan.samples:
        yield from part(lighting(context, results, plan.samples, flat=True), 0.5, 0.5)
