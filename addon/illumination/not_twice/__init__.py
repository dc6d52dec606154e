"""Cycles' own caustics, left out where a mesh shows them, and the lamps' images in the mirrors, which go with them.

In come a lamp and a mirror; lights are linked so that both go on to look as they did, until it is taken back.
"""
from .cycles_caustics import leave_out
from .glint import follow_lamp
from .own_caustics import (
    bring_back_abandoned,
    bring_back_own_caustics,
    is_shown_in,
    leave_out_own_caustics,
    leaves_out,
    leaves_out_any,
    let_lamps_light_mirrors,
    makes_own_caustics,
)

__all__ = ["bring_back_abandoned", "bring_back_own_caustics", "follow_lamp", "is_shown_in", "leave_out",
           "leave_out_own_caustics", "leaves_out", "leaves_out_any", "let_lamps_light_mirrors", "makes_own_caustics"]
