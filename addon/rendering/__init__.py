"""Cycles at work on temporary scenes; what it renders comes back as arrays."""
from .cycles_pictures import rendered, with_cycles

__all__ = ["rendered", "with_cycles"]
