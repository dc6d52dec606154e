"""The results of a scene, known without looking through thousands of objects at every redraw.

They are looked for again only where Blender has told of something by which there may be others: an object that came or
went, a collection, a role, undo and redo, another file.
"""
from __future__ import annotations

import bpy
from bpy.app.handlers import persistent

from ..registration import Handlers
from .results import RESULTS

_known: dict[tuple[int, str], list] = {}


def known_results(scene: bpy.types.Scene, layer: bpy.types.ViewLayer) -> list:
    """Return the results of any kind in a scene's view layer, from a cache. Results that a script has made or removed
    count from the view layer's next update on.
    """
    key = scene.session_uid, layer.name
    if key not in _known:
        # the view layer holds None in place of an object that was just removed
        _known[key] = [obj for obj in layer.objects if obj is not None and obj.reflection_mesh.role in RESULTS]
    try:
        return [obj for obj in _known[key] if obj.reflection_mesh.role in RESULTS]
    except ReferenceError:
        # one of them was removed
        forget_known()
        return known_results(scene, layer)


def forget_known(*_) -> None:
    """Look for results anew when they are asked for next."""
    _known.clear()


@persistent
def _after_change(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    if depsgraph.id_type_updated("COLLECTION"):
        forget_known()


@persistent
def _around_other_data(*_) -> None:
    forget_known()


HANDLERS = Handlers((_after_change, "depsgraph_update_post", "frame_change_post"),
                    (_around_other_data, "undo_pre", "undo_post", "redo_pre", "redo_post", "load_pre", "load_post"))
register = HANDLERS.register


def unregister() -> None:
    HANDLERS.unregister()
    forget_known()
