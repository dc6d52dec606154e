"""The operator that bakes a range of frames: what is asked for and there already, each frame's files, and players.

From here come the operator's registration and what the verb `bake` puts in order by itself.
"""
from .bake import baking
from .bake_operator import FOLDER, WHAT, register, unregister
from .plan import blur_remarks, chosen_frames, empty_remarks, layer_remarks, plan_of, summary
from .playing import showing
from .side_by_side import side_by_side

__all__ = ["FOLDER", "WHAT", "baking", "blur_remarks", "chosen_frames", "empty_remarks", "layer_remarks", "plan_of",
           "register", "showing", "side_by_side", "summary", "unregister"]
