"""A worker that is asked about seeds, and started again where one ends it."""
from __future__ import annotations

import contextlib
import json
import os
import signal
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import Timer

ROOT = Path(__file__).resolve().parents[2]
WALL = 600.0  # seconds by the clock on the wall after which a worker that waits for something is ended


class Asked:
    """A worker of one kind, "core", "light", "scenes", "lamps", "lit" or "thrown"."""

    def __init__(self, kind: str) -> None:
        self.kind = kind
        self._worker: subprocess.Popen | None = None
        # where a worker that is killed leaves its files
        self._folder = TemporaryDirectory(prefix="reflection_mesh_fuzz_", ignore_cleanup_errors=True)

    def about(self, seed: int) -> dict:
        """The worker's answer; where it ended instead, what ended it."""
        if self._worker is None:
            self._worker = subprocess.Popen(
                [sys.executable, "-m", "tests.fuzz.worker", self.kind], cwd=ROOT, stdin=subprocess.PIPE,
                stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
                env={**os.environ, "OPENBLAS_NUM_THREADS": "1", "TMPDIR": self._folder.name})
        patience = Timer(WALL, self._worker.kill)
        patience.start()
        try:
            self._worker.stdin.write(f"{seed}\n")
            self._worker.stdin.flush()
            answer = self._worker.stdout.readline()
        except BrokenPipeError:
            answer = ""
        finally:
            patience.cancel()
        if answer:
            return json.loads(answer)
        return {"seed": seed, "name": str(seed), "problems": [_ending(self._ended())]}

    def close(self) -> None:
        if self._worker is not None:
            self._ended()
        self._folder.cleanup()

    def _ended(self) -> int:
        """The exit status of the worker, which ends where nothing more is asked."""
        worker, self._worker = self._worker, None
        with contextlib.suppress(BrokenPipeError):
            worker.stdin.close()
        status = worker.wait()
        worker.stdout.close()
        return status


def _ending(status: int) -> str:
    if status in (-signal.SIGXCPU, -signal.SIGKILL):
        return "time: without an end"
    return f"crash: {signal.Signals(-status).name if status < 0 else f'status {status}'}"
