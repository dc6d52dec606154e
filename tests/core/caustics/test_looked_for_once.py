"""How often a mirror is searched for what its own parts hide of a lamp's light."""
from __future__ import annotations

from core import Lamp, caustics
from core.culling import SceneAndMirrors
from tests.core.caustics.test_caustics import level, ring


def test_a_mirror_from_which_no_light_goes_on_is_searched_once(monkeypatch):
    """It only hides; which of its parts may see others need not be known before they are refined."""
    asked, search = [], SceneAndMirrors.mirrors_in

    def counted(met, cameras, bound, before=None):
        if before is None:  # else it asks again, for what was not found before
            asked.append(len(cameras))
        return search(met, cameras, bound, before)
    monkeypatch.setattr(SceneAndMirrors, "mirrors_in", counted)
    caustics(Lamp((0.3, 0.1, 1.7)), ring(48), level(0.0, 0.0, 0.0, 4.0))
    assert len(asked) == 1 and asked[0] > 100
