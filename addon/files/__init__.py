"""Files that others find whole or not at all: written beside, read back, and put in their places at the end."""
from .chosen_folder import chosen_folder
from .open_exr import open_exr
from .save_blend import check_place, save_blend
from .scratch import has_room, scratch_folder, scratch_is_full
from .staged import check_folder, staged
from .whole import is_whole

__all__ = ["check_folder", "check_place", "chosen_folder", "has_room", "is_whole", "open_exr", "save_blend",
           "scratch_folder", "scratch_is_full", "staged"]
