"""Register the parts of the extension when it is enabled, and unregister them in reverse order."""
from __future__ import annotations

from collections.abc import Callable
from types import ModuleType

import bpy

Change = Callable[[], None]


class Handlers:
    """Functions in Blender's lists of handlers, which are called when something has happened.

    Parameters
    ----------
    listed : tuple of (function, str, ...)
        Each with the names of its lists in `bpy.app.handlers`.
    """

    def __init__(self, *listed: tuple) -> None:
        self._listed = [(name, function) for function, *names in listed for name in names]

    def register(self) -> None:
        for name, function in self._listed:
            getattr(bpy.app.handlers, name).append(function)

    def unregister(self) -> None:
        for name, function in reversed(self._listed):
            if function in getattr(bpy.app.handlers, name):
                getattr(bpy.app.handlers, name).remove(function)

    def are_there(self) -> bool:
        """Return True if all handlers are still in Blender's lists."""
        return all(function in getattr(bpy.app.handlers, name) for name, function in self._listed)


def together(*parts: ModuleType | Handlers) -> tuple[Change, Change]:
    """`register` and `unregister` of several parts as one."""
    def register() -> None:
        for part in parts:
            part.register()

    def unregister() -> None:
        for part in reversed(parts):
            part.unregister()
    return register, unregister
