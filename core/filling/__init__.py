"""The talk's holes filled with rays: what is too crowded to be cut, within limits of work and memory; and probes."""
from .crowds import thinned, with_crowds
from .limits import Limits
from .probes import missed_probes

__all__ = ["Limits", "missed_probes", "thinned", "with_crowds"]
