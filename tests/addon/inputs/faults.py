"""Full disks, and processes that are interrupted or killed: made on purpose, in any folder."""
from __future__ import annotations

import os
import resource
import signal
import subprocess
import sys
import time
from contextlib import contextmanager
from pathlib import Path
from threading import Timer

ROOT = Path(__file__).resolve().parents[3]
NO_LIMIT = resource.getrlimit(resource.RLIMIT_FSIZE)[1]
# Python has switched the signal off that would end the process
LIMITED = ("import resource, runpy, sys; limit = int(sys.argv[1]); del sys.argv[:2]; "
           "resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)); "
           "runpy.run_path(sys.argv[0], run_name='__main__')")
# of a comparison
RESULTS = {"reference.png", "result.png", "difference.png", "displacement.png", "holes.png", "report.json",
           "report.csv", "report.html"}


@contextmanager
def no_file_over(size: int):
    """A disk that is full, as far as a process can make one for itself."""
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, NO_LIMIT))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (NO_LIMIT, NO_LIMIT))


def command(*arguments, limit: int | None = None, scratch: Path | None = None) -> dict:
    """What `subprocess` runs the command line with."""
    script = [sys.executable, str(ROOT / "addon" / "run_with_bpy.py")]
    if limit is not None:
        script = [sys.executable, "-c", LIMITED, str(limit), script[1]]
    environment = {**os.environ, "PYTHONDONTWRITEBYTECODE": "1"}
    if scratch is not None:
        scratch.mkdir(exist_ok=True)
        environment["TMPDIR"] = str(scratch)
    return {"args": [*script, *map(str, arguments)], "env": environment, "stdout": subprocess.PIPE,
            "stderr": subprocess.PIPE, "text": True}


def contents(folder: Path) -> dict:
    """Every file below a folder, and every link, by its path."""
    return {str(path.relative_to(folder)): os.readlink(path) if path.is_symlink() else path.read_bytes()
            for path in sorted(folder.rglob("*")) if path.is_symlink() or path.is_file()}


def one_sentence(error: str) -> str:
    """The one line on stderr that is for the user."""
    assert "Traceback" not in error, error
    told = [line for line in error.splitlines() if line.startswith("Error: ")]
    assert len(told) == 1 and told[0].endswith("."), error
    return told[0]


def _hears_ctrl_c() -> None:
    signal.signal(signal.SIGINT, signal.SIG_DFL)


@contextmanager
def running(**options):
    """A process that ends with its test, and within a minute; it hears Ctrl-C even where these tests, as all that a
    script starts behind its back, do not."""
    with subprocess.Popen(preexec_fn=_hears_ctrl_c, **options) as process:
        watch = Timer(60.0, process.kill)
        watch.start()
        try:
            yield process
        finally:
            watch.cancel()
            process.kill()


def until_it_renders(process: subprocess.Popen, scratch: Path, seconds: float) -> None:
    """Wait for a picture that takes longer than this; only some Blenders tell of their samples."""
    since: dict = {}
    while process.poll() is None:
        now = time.perf_counter()
        since = {path.name: since.get(path.name, now) for path in scratch.glob("reflection_mesh_*")}
        if any(now - first >= seconds for first in since.values()):
            return
        time.sleep(0.02)
    raise AssertionError(process.stderr.read())
