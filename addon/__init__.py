"""What Blender sees of the extension: roles, operators, a panel and a command; the optics are in `core`."""
from . import clear, command_line, compare, generate, light, panel, properties
from .lighting import stale_light

MODULES = (properties, stale_light, generate, light, compare, clear, panel, command_line)


def register() -> None:
    for module in MODULES:
        module.register()


def unregister() -> None:
    for module in reversed(MODULES):
        module.unregister()
