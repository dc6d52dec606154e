"""Live in Blender: the switch, the handlers that tell of changes, the timer that asks for work."""
import time

import bpy
from bpy.app.handlers import persistent
from bpy.props import BoolProperty, EnumProperty, PointerProperty

from .. import compat
from ..operators import polls
from ..reading import known_results
from ..registration import Handlers
from .updater import LiveUpdater

INTERVAL = 0.02     # seconds between two looks
WAIT = 0.25         # the same while something else is at work
EYES = (
    ("CAMERA", "Camera", "Update reflections for the scene's camera"),
    ("VIEW", "Viewport", "Update reflections for the largest 3D viewport. Generate Reflection makes them for the "
                         "camera again"),
)
JOBS = ("RENDER", "OBJECT_BAKE", "COMPOSITE")

updater: LiveUpdater | None = None


def present() -> LiveUpdater | None:
    """Return the object that updates the results of the file; None if Live is off."""
    return updater


def start(of_viewport: bool) -> None:
    """Begin to keep the results of the file right."""
    global updater
    stop()
    updater = LiveUpdater(of_viewport)
    HANDLERS.register()
    bpy.app.timers.register(_tick, first_interval=INTERVAL)


def stop() -> None:
    """Stop Live. Results stay as they are."""
    global updater
    if updater is not None:
        updater.forget()
        HANDLERS.unregister()
        if bpy.app.timers.is_registered(_tick):
            bpy.app.timers.unregister(_tick)
    updater = None


def is_busy() -> bool:
    """Return True while a render, a bake or an operator of this extension is running."""
    if any(map(bpy.app.is_job_running, JOBS)):
        return True
    return any(operator.bl_idname.startswith("REFLECTION_MESH_OT_")
               for window in bpy.context.window_manager.windows for operator in window.modal_operators)


def _tick() -> float | None:
    """Do one step; called by the timer. Return the seconds until the next call."""
    if updater is None:
        return None
    if is_busy():
        updater.forget()
        return WAIT
    before = updater.milliseconds, updater.told, updater.at_rest
    window = next(iter(bpy.context.window_manager.windows), None)
    with bpy.context.temp_override(**({} if window is None else {"window": window})):
        updater.step(bpy.context, time.monotonic())
    if before != (updater.milliseconds, updater.told, updater.at_rest):
        _redraw()
    return INTERVAL


def _redraw() -> None:
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type in {"VIEW_3D", "PROPERTIES"}:
                area.tag_redraw()


@persistent
def _after_change(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    # a render's depsgraph tells of nothing that has happened in the file
    if updater is None or depsgraph.mode != "VIEWPORT":
        return
    own = _own(scene, depsgraph.view_layer)
    changed = [update.id for update in depsgraph.updates if update.id.original not in own]
    if changed:
        updater.note(not all(map(_is_camera, changed)))


def _own(scene: bpy.types.Scene, layer: bpy.types.ViewLayer) -> set:
    """Return results and their meshes, which Live writes itself."""
    results = set(known_results(scene, layer))
    return results | {obj.data for obj in results}


def _is_camera(changed: bpy.types.ID) -> bool:
    return isinstance(changed, bpy.types.Camera) or (isinstance(changed, bpy.types.Object) and changed.type == "CAMERA")


@persistent
def _before_other_data(*_) -> None:
    """Release data before undo and redo, which replace it."""
    if updater is not None:
        updater.forget()


@persistent
def _after_other_data(*_) -> None:
    if updater is not None:
        updater.note()


@persistent
def _before_opening(*_) -> None:
    """Switch Live off before another file opens."""
    stop()


HANDLERS = Handlers((_after_change, "depsgraph_update_post", "frame_change_post"),
                    (_before_other_data, "undo_pre", "redo_pre"), (_after_other_data, "undo_post", "redo_post"))
# not with the others: Blender passes over the next handler where one goes while its list is gone through
OPENING = Handlers((_before_opening, "load_pre"))


def _switch(live: bpy.types.PropertyGroup, on: bool) -> None:
    if on:
        start(live.eye == "VIEW")
    else:
        stop()


def _choose_eye(live: bpy.types.PropertyGroup, _context: bpy.types.Context) -> None:
    if updater is not None:
        start(live.eye == "VIEW")


class ReflectionLive(bpy.types.PropertyGroup):
    """`WindowManager.reflection_mesh_live`: whether results are kept right, and for whom. No file remembers it."""

    on: BoolProperty(name="Live", description="Update reflections while the camera, mirrors or objects move: coarsely "
                     "while they move, exactly afterwards", get=lambda live: updater is not None, set=_switch,
                     options={"SKIP_SAVE"})
    eye: EnumProperty(name="Seen From", description="View that Live updates reflections for", items=EYES,
                      default="CAMERA", update=_choose_eye, options={"SKIP_SAVE"})


class REFLECTION_MESH_OT_live(bpy.types.Operator):
    """Update reflections while the camera, mirrors or objects move: coarsely while they move, exactly afterwards"""

    bl_idname = "reflection_mesh.live"
    bl_label = "Live Reflections"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return polls.passes(cls, context)

    def execute(self, context: bpy.types.Context) -> set:
        live = context.window_manager.reflection_mesh_live
        live.on = not live.on
        return {"FINISHED"}


CLASSES = (ReflectionLive, REFLECTION_MESH_OT_live)


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    compat.let_go_at_exit(ReflectionLive)
    bpy.types.WindowManager.reflection_mesh_live = PointerProperty(name="Live Reflections", type=ReflectionLive)
    OPENING.register()


def unregister() -> None:
    stop()
    OPENING.unregister()
    del bpy.types.WindowManager.reflection_mesh_live
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
