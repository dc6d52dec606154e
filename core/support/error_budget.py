"""How the tolerance is shared out among the steps that may each miss the true picture by a part of it.

What a camera's interpolated rays stray by moves only the guesses from which Newton's method goes to the true map, and
the places at which clipping finds that something is seen at all: nearly all of the tolerance is theirs. A straight
outline in place of a bent one is seen, at both its sides: half. What the inside of a face strays by is seen as it is,
and adds to no other: nearly all.

What is judged by samples is judged where a quadratic strays most: what is zero at the corners of a triangle exceeds its
values at the middles of the edges by a third at the most.
"""
MIRROR_SHARE = 0.8  # of the tolerance: what the rays of a camera may stray
OUTLINE_SHARE = 0.5  # of the tolerance: what a straight outline in a camera may miss
ENDING_SHARE = 0.4  # of that: what outlines of mirrors may miss, at which all ends that lies behind
FACE_SHARE = 0.8  # of the tolerance: what the interpolation inside a face may stray
WHOLE_OUTLINE_SHARE = 0.25  # of that: what outlines of whole faces may stray, seen at both their sides, and in one line
DOUBT_SHARE = 0.5  # of that: what straying is guessed to be from which on the middle of an edge is looked for
BESIDE_EDGES = 8.0  # times the share of cameras: what their rays may stray by beside an edge
TOGETHER = 2.0  # times the tolerance: the size of what is drawn together, no more of it than that from its middle
TOGETHER_AT_OUTLINES = 1 / 3  # of that size: that of what an outline runs through
INSIDE = 4 / 3  # what a triangle strays inside, to the most that it does at the middles of its edges
INSIDE_WHOLE = 1.1  # the same of whole faces, which are judged in their middles too
