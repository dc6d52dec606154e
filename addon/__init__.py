"""What Blender sees of the extension: roles, operators, panels, a menu and a command; the optics are in `core`."""
from . import (
    bake,
    caustics,
    clear,
    command_line,
    compare,
    generate,
    interface,
    light,
    mirror_uvs,
    print_sheet,
    properties,
)
from .gltf_attributes import AttributesOfResults
from .lighting import stale_light
from .writing import cameras, windows

__all__ = ["AttributesOfResults", "register", "unregister"]

MODULES = (properties, windows, cameras, stale_light, generate, light, caustics, bake, mirror_uvs, print_sheet, compare,
           clear, interface, command_line)


def register() -> None:
    for module in MODULES:
        module.register()


def unregister() -> None:
    for module in reversed(MODULES):
        module.unregister()
