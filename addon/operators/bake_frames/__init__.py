"""The operator that bakes a range of frames: what is asked for and there already, each frame's files, and players.

From here come the operator's registration and what the verb `bake` puts in order by itself.
"""
from .bake_operator import FOLDER, WHAT, register, unregister
from .plan import Plan, chosen_frames, empty_remarks, layer_remarks, plan_of, scene_remarks, summary
from .side_by_side import side_by_side
from .view_layers import baking_layers, show_layers

__all__ = ["FOLDER", "Plan", "WHAT", "baking_layers", "chosen_frames", "empty_remarks", "layer_remarks",
           "plan_of", "register", "scene_remarks", "show_layers", "side_by_side", "summary", "unregister"]
