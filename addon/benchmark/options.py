"""What a benchmark runs, and for how long."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from ...core import ReflectionError
from .methods import METHODS


@dataclass(frozen=True)
class Options:
    """What a benchmark runs.

    Attributes
    ----------
    methods : tuple of str
        Keys of `METHODS`; all where empty.
    budget : float
        Seconds for each value of a method's knob, on each scene.
    pixels : int or None
        The picture's longer side; the render's own where None.
    samples : int
        Per pixel of the two pictures.
    growth : float
        Seconds for each point of the growth of methods, which is left out where 0.
    work : bool
        Whether the talk's setting is counted.
    tell : callable
        Is told what is done, a line at a time.
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
