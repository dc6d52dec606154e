"""The plan of a bake, the frames that exist already, and a check if these show the scene as it is now."""
from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import asdict, dataclass, replace

import bpy

from .... import core
from ...faults import Steps, gathered, listed, one_or_more
from ...frames import Sequence, frame_numbers, frame_text, is_done, read_record, record_path, told_apart
from ...freshness import frame_difference, frame_origin
from ...reading import (
    Assembly,
    NothingSeen,
    Participants,
    candidates,
    render_size,
    shadow_catchers,
    visible,
    why_caught,
)
from ...settings import SAMPLES, SettingsOfMirrors, Wanted, of_each
from ..shortcomings import DEPTH_OF_FIELD, STEREO, render_shortcomings

NUMBER = re.compile(r"[\d.,]+")
NAMED = 8   # so many frames are named one by one
LACKING = "In frame"  # first words of sentences on what frames lack


@dataclass(frozen=True)
class Plan:
    """The plan of a bake.

    Attributes
    ----------
    folder : str
        Absolute path.
    frames : list of int
    settings : core.Settings, or a function from a mirror to its settings
    samples : int
        Samples of light per pixel; 0 for no light.
    cameras : list of bpy.types.Object
        One sequence for each. If empty, one for the scene's camera, which markers may change.
    layer : str
        Name that distinguishes the sequences of a view layer; empty if there is only one.
    overwrite : bool
        Make existing frames again. Otherwise keep those that were made with the same settings.
    lamps : list of bpy.types.Object
        Lamps whose caustics are baked; empty to bake reflections.
    eyes : int
        Number of points on each lamp; 0 for as many as its caustics were last made with.
    leave_out : bool or None
        Leave out Cycles' own caustics of these lamps; None keeps the choice of the last time.
    """

    folder: str
    frames: list[int]
    settings: core.Settings | SettingsOfMirrors
    samples: int = SAMPLES
    cameras: tuple = ()
    layer: str = ""
    overwrite: bool = False
    lamps: tuple = ()
    eyes: int = 0
    leave_out: bool | None = None

    @property
    def takes(self) -> list:
        """The (name, camera or None) of each sequence."""
        apart = told_apart([camera.name for camera in self.cameras])
        names = [apart[camera.name] if len(self.cameras) > 1 else "" for camera in self.cameras]
        return [(f"{self.layer} {name}".strip(), camera)
                for name, camera in zip(names or [""], self.cameras or [None], strict=True)]

    def made_with(self, context: bpy.types.Context, camera: bpy.types.Object | None, mirrors: list) -> dict:
        """Return the settings that a frame depends on, besides the contents of the file. Mirrors with settings of their
        own have an entry by name.
        """
        settings = _plain(of_each(self.settings)(None))
        each = {mirror.name: _plain(of_each(self.settings)(mirror)) for mirror in mirrors}
        own = {name: values for name, values in each.items() if values != settings}
        return {**settings, **({"own": own} if own else {}), "samples": self.samples,
                "camera": camera.name if camera else "",
                "scene": context.scene.name, "view_layer": context.view_layer.name,
                "resolution": "{} x {}".format(*render_size(context.scene))}


def _plain(settings: core.Settings) -> dict:
    return {name: value for name, value in asdict(settings).items() if isinstance(value, str | int | float)}


def found_frames(context: bpy.types.Context, plan: Plan, take: tuple, baked) -> dict:
    """Return the frames of a sequence by number: the record of a frame that exists already, None for one that must be
    made. `baked` is the kind of result.
    """
    name, camera = take
    known: dict = dict.fromkeys(plan.frames)
    if plan.overwrite:
        return known
    made_with = baked.made_with(context, plan, camera)
    for frame in plan.frames:
        record = read_record(record_path(plan.folder, baked.take(name), frame))
        if not is_done(plan.folder, record):
            continue
        if record.made_with != made_with or set(record.results) != set(baked.keys):
            raise core.ReflectionError(f"Frame {frame} in '{plan.folder}' was baked with other settings or mirrors: "
                                       "overwrite it, or choose another folder.")
        known[frame] = record
    return known


def open_frame(context: bpy.types.Context, frame: int, camera: bpy.types.Object | None) -> None:
    """Go to a frame, which may bring a camera of its own unless one is given."""
    context.scene.frame_set(frame)
    if camera is not None:
        context.scene.camera = camera


def compared(context: bpy.types.Context, plan: Plan, camera: bpy.types.Object | None, everything: tuple,
              known: dict, remark: Callable[[str], None]) -> Steps[None]:
    """Compare existing frames with the scene as it is now. Pass a sentence to `remark` if they differ."""
    changed, reason = [], ""
    for frame, record in known.items():
        if record is not None and record.made_from:
            yield 0.0, f"Comparing frame {frame}"
            open_frame(context, frame, camera)
            chosen = joined_or_none(context, *everything)
            why = frame_difference(record.made_from, frame_origin(context, chosen, bool(plan.samples)))
            reason = reason or why
            changed += [frame] if why else []
    if changed:
        remark(f"Kept although they were baked from another state of the scene ({reason}): {frames_listed(changed)} "
               f"in '{plan.folder}'; overwrite them, or choose another folder, to have all alike.")


def frames_listed(frames: list[int]) -> str:
    """Return frame numbers in words; only the first ones if there are many."""
    if len(frames) == 1:
        return f"frame {frames[0]}"
    named = ", ".join(map(str, frames[:NAMED]))
    return f"frames {named} and {len(frames) - NAMED} more" if len(frames) > NAMED else f"frames {named}"


def lacking(lacks: dict) -> list[str]:
    """Return the sentences in `lacks`, a dict by frame. Each is listed once, with all its frames, and begins with
    `LACKING`. Sentences that differ only in numbers count as one.
    """
    frames: dict = {}
    for frame, sentences in lacks.items():
        for sentence in gathered(sentences):
            _, those = frames.setdefault(NUMBER.sub("", sentence), (sentence, []))
            those.append(frame)
    return [f"In {frames_listed(sorted({*those}))}: {sentence}" for sentence, those in frames.values()]


def joined_or_none(context: bpy.types.Context, mirrors: list[Assembly], diffuse: list) -> Participants | None:
    """Return the participants of the open frame; None if all mirrors or all other objects are hidden."""
    try:
        seen = visible(context, [part for one in mirrors for part in one.parts], diffuse)
        return replace(seen, assemblies=tuple(mirrors))
    except NothingSeen:
        return None


def plan_of(context: bpy.types.Context, folder: str, frames: str, wanted: Wanted, **more) -> Plan:
    """Return a plan for the frames in the text `frames`, or for the scene's range if it is empty."""
    numbers = chosen_frames(context.scene, frames)
    return Plan(folder, numbers, wanted, wanted.samples(candidates(context)[0]), **more)


def chosen_frames(scene: bpy.types.Scene, text: str) -> list[int]:
    """Return the frames in a text, or the scene's range if it is empty."""
    return frame_numbers(text or frame_text(scene.frame_start, scene.frame_end, scene.frame_step))


def scene_remarks(context: bpy.types.Context, cameras: tuple, thrown: bool = False) -> list[str]:
    """Return sentences on how renders of the scene differ from the baked frames, and on mirrors that were left out."""
    caught = [] if thrown else shadow_catchers(context)
    return [*map(why_caught, caught), *render_shortcomings(context, *candidates(context)),
            *_blur_remarks(context.scene, cameras, thrown)]


def _blur_remarks(scene: bpy.types.Scene, cameras: tuple, thrown: bool = False) -> list[str]:
    """Return sentences on effects of the scene, such as motion blur, that baked reflections (or caustics, if `thrown`)
    lack.
    """
    told = []
    if scene.render.use_motion_blur:
        told.append("Motion blur: reflections are sharp, since their faces change from frame to frame; blur them after "
                    "the render, or render in-between frames and mix them.")
    marked = [marker.camera for marker in scene.timeline_markers if marker.camera]
    if not thrown and any(camera and camera.type == "CAMERA" and camera.data.dof.use_dof
                          for camera in (cameras or [scene.camera, *marked])):
        told.append(DEPTH_OF_FIELD)
    return told + [STEREO] * (scene.render.use_multiview and not thrown)


def empty_remarks(sequences: list[Sequence]) -> list[str]:
    """Return a sentence on mirrors that show nothing, or cast no caustics of a lamp, in any frame of any sequence."""
    seen = {key for sequence in sequences for key in sequence.records[0].results if key not in sequence.empty}
    empty = sorted(set().union(*(sequence.empty for sequence in sequences)) - seen)
    if not empty:
        return []
    return [f"Empty in every baked frame, since hidden, out of sight or with nothing to show: {listed(empty)}."]


def layer_remarks(scene: bpy.types.Scene, layers: list) -> list[str]:
    """Return a list of one sentence, if one view layer alone was baked (`layers`) and the scene renders others too.

    The list is empty otherwise.
    """
    names = {layer.name for layer in layers}
    others = [layer.name for layer in scene.view_layers if layer.use and layer.name not in names]
    if len(names) > 1 or not others:
        return []
    return [f"The frames show what the view layer '{layers[0].name}' sees, and '{others[0]}' shows them too: bake "
            "all view layers that are rendered, for a sequence each."]


def summary(plans: list[Plan], made: int, seconds: float) -> str:
    """Return one line on what was baked."""
    return one_or_more(sum(len(plan.frames) * len(plan.takes) for plan in plans),
                       "{made} of 1 frame baked into '{folder}', {seconds} s",
                       "{made} of {count} frames baked into '{folder}', {seconds} s",
                       made=made, folder=plans[0].folder, seconds=f"{seconds:.2f}")
