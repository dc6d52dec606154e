"""Error budget: the share of the tolerance that each step may deviate from the true picture.

Deviations of a camera's interpolated rays affect only the first guesses of Newton's method on the true map, and the
places at which clipping finds that something is seen at all: they may take nearly all of the tolerance. A straight
outline in place of a curved one is visible on both its sides: half. Deviations inside a face are visible, but add to no
others: nearly all.

Deviations are sampled where a quadratic function deviates most. If it is zero at a triangle's corners, its maximum
exceeds its values at the middles of the edges by a third at most.
"""
MIRROR_SHARE = 0.8  # share of the tolerance: deviation of a camera's rays
OUTLINE_SHARE = 0.5  # share of the tolerance: deviation of a straight outline in a camera
ENDING_SHARE = 0.4  # share of OUTLINE_SHARE: outlines of mirrors, which cut off everything behind them
FACE_SHARE = 0.8  # share of the tolerance: interpolation inside a face
WHOLE_OUTLINE_SHARE = 0.25  # share of FACE_SHARE: outlines of unclipped triangles, long and visible on both sides
DOUBT_SHARE = 0.5  # share of the allowed deviation: estimate from which on the true middle of an edge is computed
BESIDE_EDGES = 8.0  # factor on MIRROR_SHARE: deviation of a camera's rays outside its edges
TOGETHER = 2.0  # factor on the tolerance: largest diameter in the picture of vertices that are merged into one
TOGETHER_AT_OUTLINES = 1 / 3  # factor on that diameter where an outline runs through them
INSIDE = 4 / 3  # largest deviation inside a triangle, relative to the largest at the middles of its edges
INSIDE_WHOLE = 1.1  # the same of unclipped triangles, whose middles are sampled too
