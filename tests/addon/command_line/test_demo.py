"""The demo tells one line for each stage, and keeps what Blender tells for those who ask for it."""
import importlib
import os
import tempfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture
def demo(monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT))
    return importlib.import_module("tools.demo")


def speak() -> str:
    """As Cycles does: past Python, to the process' standard output."""
    os.write(1, b"Fra:1 Sample 1/16\n")
    return "done"


def test_a_stage_is_one_line(demo, capfd):
    with tempfile.TemporaryFile() as log:
        made, seconds = demo.Stages(log.fileno())("Rendering", speak)
        log.seek(0)
        assert log.read() == b"Fra:1 Sample 1/16\n"
    assert made == "done" and capfd.readouterr().out == f"Rendering ... {seconds:.1f} s\n"
    demo.Stages(None)("Rendering", speak)
    assert capfd.readouterr().out.splitlines()[:2] == ["Rendering ...", "Fra:1 Sample 1/16"]


def test_what_blender_told_is_shown_after_an_error(demo, capfd, monkeypatch, tmp_path):
    def break_down(options, folder, stage):
        stage("Rendering", speak)
        raise RuntimeError("Enough.")
    monkeypatch.setattr(demo, "demonstrate", break_down)
    monkeypatch.setattr(demo.extension_zip, "use_throw_away_preferences", lambda folder: None)
    with pytest.raises(RuntimeError, match="Enough."):
        demo.main(["--folder", str(tmp_path)])
    told = capfd.readouterr()
    assert told.err == "Fra:1 Sample 1/16\n" and "Fra:" not in told.out
