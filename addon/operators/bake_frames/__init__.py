"""The operator that bakes a range of frames: what is asked for and there already, each frame's files, and players.

From here come the operator's registration and what the verb `bake` puts in order by itself.
"""
from .bake_operator import FOLDER, WHAT, register, unregister
from .plan import Plan, blur_remarks, chosen_frames, empty_remarks, layer_remarks, plan_of, summary
from .side_by_side import side_by_side
from .view_layers import baking_layers, show_layers

__all__ = ["FOLDER", "Plan", "WHAT", "baking_layers", "blur_remarks", "chosen_frames", "empty_remarks",
           "layer_remarks", "plan_of", "register", "show_layers", "side_by_side", "summary", "unregister"]
