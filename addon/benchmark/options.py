"""Options of a benchmark: methods, time limits and resolution."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from ...core import ReflectionError
from .methods import METHODS


@dataclass(frozen=True)
class Options:
    """Options of a benchmark.

    Attributes
    ----------
    methods : tuple of str
        Keys of `METHODS`; empty for all.
    budget : float
        Seconds for each value of a method's parameter, on each scene.
    pixels : int or None
        Longer side of the picture; None for the render's.
    samples : int
        Samples per pixel of the two pictures.
    growth : float
        Seconds for each point of the growth of run times; 0 leaves it out.
    work : bool
        True to count the work in the talk's setting.
    tell : callable
        Called with each line of progress.
    """

    methods: tuple = ()
    budget: float = 10.0
    pixels: int | None = None
    samples: int = 4
    growth: float = 0.0
    work: bool = True
    tell: Callable[[str], None] = print

    def __post_init__(self) -> None:
        unknown = [name for name in self.methods if name not in METHODS]
        if unknown:
            raise ReflectionError(f"There is no method '{unknown[0]}': choose from {', '.join(METHODS)}.")
        if not self.budget >= 0.0:
            raise ReflectionError("The budget must be a number of seconds, zero or more.")
        if self.samples < 1:
            raise ReflectionError("A picture takes at least one sample: raise --samples.")
