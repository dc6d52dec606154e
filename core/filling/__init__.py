"""Ray-sampled fallback for cameras with too many triangles, the limits on work and memory, and probes of the result.

Input are candidates. Output are the candidates that can be clipped, and cells of the picture that show the triangles
hit by rays. Probes count the rays that see an object which no face of the result shows. C. Mei, talk, 2006.
"""
from .crowds import Crowds
from .limits import Limits
from .probes import missed_probes

__all__ = ["Crowds", "Limits", "missed_probes"]
