"""What a result was made from, and whether that has changed since: told in one sentence, and mended by Generate."""
from .digests import register, unregister
from .made_from import COARSE, Origin, origin_of, record_of, same_view, view_numbers, why_stale

__all__ = ["COARSE", "Origin", "origin_of", "record_of", "register", "same_view", "unregister", "view_numbers",
           "why_stale"]
