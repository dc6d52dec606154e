"""How the tolerance is shared out among the steps that may each miss the true picture by a part of it.

What a camera's interpolated rays stray by moves only the guesses from which Newton's method goes to the true map, and
the places at which clipping finds that something is seen at all: nearly all of the tolerance is theirs. A straight
outline in place of a bent one is seen, at both its sides: half. What the inside of a face strays by is seen as it is,
and adds to no other: nearly all.
"""
MIRROR_SHARE = 0.8  # of the tolerance: what the rays of a camera may stray
OUTLINE_SHARE = 0.5  # of the tolerance: what a straight outline in a camera may miss
FACE_SHARE = 0.8  # of the tolerance: what the interpolation inside a face may stray
