"""The talk's holes filled with rays: what is too crowded to be cut, within limits of work and memory; and probes.

In come candidates; out come those that can be cut, and cells of the picture that show what rays through them meet. Of
a result, probes tell which rays see something that no face shows. C. Mei, talk, 2006.
"""
from .crowds import Crowds
from .limits import Limits
from .probes import missed_probes

__all__ = ["Crowds", "Limits", "missed_probes"]
