"""The extension in Blender: roles, operators, panels, a menu and a command. The optics are in `core`."""
from . import command_line, freshness, interface, live, operators, properties, reading, standing
from .gltf_export import ResultsInGltf
from .registration import together
from .writing import cameras, windows

__all__ = ["ResultsInGltf", "register", "unregister"]

register, unregister = together(properties, reading, windows, cameras, freshness, standing, operators, live, interface,
                                command_line)
