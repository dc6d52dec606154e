"""Settings of the core's tests: the folders in `FORWARD` test the forward method alone."""
import pytest

import core.reflection

FORWARD = {"filling", "whole_faces"}    # folders that test what mirrors of small triangles, made by rays, have none of


@pytest.fixture(scope="module", autouse=True)
def forward(request):
    """Make all mirrors forward, as where their layers let light through or *Hidden Faces* is on."""
    with pytest.MonkeyPatch.context() as patch:
        if request.path.parent.name in FORWARD:
            patch.setattr(core.reflection, "_backward", lambda *_: None)
        yield
