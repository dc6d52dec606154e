"""`blender -b scene.blend --command reflection_mesh generate|light|bake|compare ...`: verbs, their options, what they
print. In comes a list of words, out comes an exit status."""
from .verbs import register, run, unregister

__all__ = ["register", "run", "unregister"]
