"""Reflection Mesh: mirror reflections computed forward, as geometry."""
from .addon import ResultsInGltf as glTF2ExportUserExtension
from .addon import register, unregister

__all__ = ["glTF2ExportUserExtension", "register", "unregister"]
