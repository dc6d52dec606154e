"""Changes that the depsgraph reports, and a check if its reports are complete.

Meshes are stored by the object for which they are evaluated. Cycles keeps meshes by the same flags.
"""
from __future__ import annotations

from collections.abc import Callable

import bpy
from bpy.app.handlers import persistent

from ..registration import Handlers

_listeners: list[Callable[[set[int] | None], None]] = []
_evaluating: list[bool] = [False]


def listen(forget: Callable[[set[int] | None], None]) -> None:
    """Call `forget` with the `session_uid` of all data whose geometry may have changed, or with None for all."""
    _listeners.append(forget)


def trusted(depsgraph: bpy.types.Depsgraph) -> bool:
    """Return True if all changes in an evaluated depsgraph have been reported. This is not the case during an
    evaluation (in other handlers), for renders, and if the handlers were removed.
    """
    return depsgraph.mode == "VIEWPORT" and not _evaluating[0] and HANDLERS.are_there()


def _tell(changed: set[int] | None) -> None:
    for forget in _listeners:
        forget(changed)


@persistent
def _before_evaluation(*_) -> None:
    _evaluating[0] = True


@persistent
def _after_evaluation(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    _evaluating[0] = False
    # a render's depsgraph tells of nothing that has happened in the file
    if depsgraph.mode == "VIEWPORT":
        changed = {update.id.original.session_uid for update in depsgraph.updates if update.is_updated_geometry}
        if changed:
            _tell(changed)


@persistent
def _after_all(*_) -> None:
    """Release everything before or after events that may replace all data."""
    _evaluating[0] = False
    _tell(None)


HANDLERS = Handlers(
    (_before_evaluation, "depsgraph_update_pre", "frame_change_pre"),
    (_after_evaluation, "depsgraph_update_post", "frame_change_post"),
    (_after_all, "undo_pre", "undo_post", "redo_pre", "redo_post", "load_pre", "load_post"))


def register() -> None:
    _evaluating[0] = False
    HANDLERS.register()


def unregister() -> None:
    HANDLERS.unregister()
    _tell(None)
