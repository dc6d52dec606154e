"""What is wrong with an input, in one sentence."""


class ReflectionError(ValueError):
    """The input cannot give a reflection; the message is one sentence for the user.

    Examples
    --------
    >>> import numpy as np
    >>> from core import ReflectionError, TriangleMesh, View, reflect
    >>> nothing = TriangleMesh(np.zeros((0, 3)), np.zeros((0, 3), dtype=int))
    >>> try:
    ...     reflect(View.looking_at((0, -4, 3), (0, 0, 0), (320, 240)), nothing, nothing)
    ... except ReflectionError as error:
    ...     print(error)
    The mirror has no faces; give it faces or choose another mirror.
    """


class NothingInView(ReflectionError):
    """The view sees nothing of the mirror."""
