"""Live: reflections that stay right while the camera, mirrors or objects move, coarse on the way and exact at rest.

`LiveUpdater` is told of changes (`note`) and asked to work (`step`); handlers and a timer do both. What is written, is
written by `generation`; between two of its results their vertices follow what moves.
"""
from .draw import draw_live
from .switch import register, unregister
from .updater import LiveUpdater

__all__ = ["LiveUpdater", "draw_live", "register", "unregister"]
