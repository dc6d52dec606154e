"""Reflection Mesh: mirror reflections computed forward, as geometry."""
from .addon import AttributesOfResults as glTF2ExportUserExtension
from .addon import register, unregister

__all__ = ["glTF2ExportUserExtension", "register", "unregister"]
