"""Live: reflections that stay right while the camera, mirrors or objects move, coarse on the way and exact at rest.

`LiveUpdater` is told of changes (`note`) and asked to work (`step`); handlers and a timer do both. What is written, is
written by `generation`; between two of its results their vertices follow what moves.
"""
from ..registration import together
from . import switch, update
from .kept import abandoned_light, abandoned_results, kept_light, kept_results
from .switch import present
from .updater import LiveUpdater

__all__ = ["LiveUpdater", "abandoned_light", "abandoned_results", "kept_light", "kept_results", "present",
           "register", "unregister"]


register, unregister = together(switch, update)
