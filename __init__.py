"""Reflection Mesh: mirror reflections computed forward, as geometry."""
from .addon import register, unregister

__all__ = ["register", "unregister"]
