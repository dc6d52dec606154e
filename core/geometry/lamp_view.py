"""A lamp in the eye's place: it lights what it sees of a mirror, and what stands in the way casts a shadow."""
from __future__ import annotations

from dataclasses import dataclass

from .triangle_mesh import TriangleMesh
from .view import View


@dataclass(frozen=True)
class LampView(View):
    """A view from a lamp, whose picture ends exactly at its borders, so that several such views make a whole one.

    Parameters
    ----------
    shades : TriangleMesh, optional
        What may stand between the lamp and the mirror: the mirror is seen only where none of it stands before it.
    screens : TriangleMesh, optional
        What may stand behind the mirror on the light's way: it hides what lies behind it, as mirrors do, and reflects
        nothing. The diffuse scene may be a part of it.
    """

    shades: TriangleMesh | None = None
    screens: TriangleMesh | None = None
