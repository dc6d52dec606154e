"""The talk's holes filled with rays: what is too crowded to be cut, within limits of work and memory; and probes."""
from .crowds import Crowds
from .limits import Limits
from .probes import missed_probes

__all__ = ["Crowds", "Limits", "missed_probes"]
