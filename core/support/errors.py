"""Errors of invalid input, with a message of one sentence."""


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
    """The view sees nothing of the mirror, or nothing in it, since one of them has no area.

    Examples
    --------
    >>> import numpy as np
    >>> from core import NothingInView, TriangleMesh, View, reflect
    >>> mirror = TriangleMesh(np.array([[-2, -2, 0], [2, -2, 0], [0, 2, 0]]), np.array([[0, 1, 2]]))
    >>> try:
    ...     reflect(View.looking_at((0, -4, 3), (0, -8, 6), (320, 240)), mirror, mirror)
    ... except NothingInView as error:
    ...     print(error)
    The view does not see the mirror; turn the camera to the mirror or move it into view.
    """
