"""What the documents' pictures call the method without filling leaves out what rays fill."""
import importlib

import numpy as np
import pytest

from core import Settings, reflect

SCARCE = Settings(maximum_memory=1e-4)  # holds hardly a candidate, and leaves nearly everything to rays


# what the tool draws with is installed beside one Blender alone, that of the slow tests
@pytest.mark.slow
def test_the_method_without_filling_has_the_faces_that_no_ray_has_filled(monkeypatch):
    from tests.oracles.true_map import case_of
    from tools.pictures import parts
    monkeypatch.setattr(parts, "_room", importlib.import_module)
    case = case_of("sphere")
    filled = reflect(case.view, case.mirror, case.scene, SCARCE)
    with parts._nothing_filled():
        clipped = reflect(case.view, case.mirror, case.scene, SCARCE)
    assert filled.counts["filled"] > 0 and clipped.counts["filled"] == clipped.counts["rays"] == 0
    assert len(clipped.triangles) < len(filled.triangles)
    again = reflect(case.view, case.mirror, case.scene, SCARCE)
    assert np.array_equal(again.positions, filled.positions)
