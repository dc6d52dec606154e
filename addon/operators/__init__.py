"""The operators, one room each, with the work that they do in steps, when they can run, and what they tell.

What reads, computes and writes stands in other packages; here it is put in order, from the scene to all
results or none.
"""
from ..registration import together
from . import (
                                 bake_frames,
                                 caustics,
                                 clear,
                                 compare,
                                 generate,
                                 light,
                                 make_mirror,
                                 mirror_uvs,
                                 print_sheet,
                                 select_result,
)

__all__ = ["register", "unregister"]

register, unregister = together(generate, light, caustics, bake_frames, mirror_uvs, print_sheet, compare, clear,
                                 select_result, make_mirror)
