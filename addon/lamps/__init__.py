"""Lamps that mirrors show: which of them a result has between a mirror and what it shows, and nodes that add them.

Cycles' lamps have a shape and hide nothing: what stands behind one is seen too, and its light added.
"""
from .lamp_nodes import lamp_light
from .shown_lamps import ShownLamp, lamps_before, lamps_that_show

__all__ = ["ShownLamp", "lamp_light", "lamps_before", "lamps_that_show"]
