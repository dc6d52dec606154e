"""The operator that generates the light which mirrors throw: what is asked for, the making of it, what it lacks.

From here come the operator's registration and what frames, Live and the verb `caustics` put in order by themselves.
"""
from .asked import Asked, asked_again, keep_own, left_out_before, left_out_of, remember
from .caustics_operator import register, unregister
from .throwing import NothingThrown, Thrown, name_of, throwing

__all__ = ["Asked", "NothingThrown", "Thrown", "asked_again", "keep_own", "left_out_before", "left_out_of", "name_of",
           "register", "remember", "throwing", "unregister"]
