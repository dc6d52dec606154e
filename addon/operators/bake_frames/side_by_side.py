"""Frames in several processes side by side: each takes its share of a copy of the open file, as machines of a farm do.

Two threads of one Blender would wait for Python's one interpreter most of the time.
"""
from __future__ import annotations

import os
import queue
import re
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import bpy

from ....core import ReflectionError
from ...faults import STATUS, Steps
from ...files import save_blend, scratch_folder
from .plan import LACKING

STAGE = re.compile(r"\s*(\d+) %  ([^:]*)")
SUMMARY = re.compile(r"(\d+) of \d+ frame")
PASSED_ON = ("Saved: '", LACKING)  # first words of lines that are passed on to the user
PATIENCE = 5.0      # seconds that a process has for ending by itself
LISTENING = 0.05    # seconds between two looks at whether Ctrl-C or ESC was pressed


def side_by_side(words: list[str], frames: list[int], jobs: int,
                 heard: Callable[[str], None] = lambda line: None) -> Steps[int]:
    """Bake frames in `jobs` processes with the arguments `words` of the command `bake`, yielding (fraction, stage).
    Return the number of frames made. `heard` is called with lines on finished files and on what frames lack.

    Raises
    ------
    ReflectionError
        With what the first process said that failed; the others are ended, and the frames that are done stay.
    """
    shares = [frames[start::jobs] for start in range(min(jobs, len(frames)))]
    with scratch_folder() as folder:
        # save the open scene, whose changes may not have been saved
        path = os.path.join(folder, os.path.basename(bpy.data.filepath) or "scene.blend")
        save_blend(path)
        with _running([_command(path, words, share) for share in shares]) as processes:
            made = yield from _heard(processes, heard)
    return made


def words_of(settings: dict) -> list[str]:
    """Return settings as command line arguments of the command `bake`.

    `{"tolerance": 0.5, "hidden_faces": False, "light_samples": 8}` becomes `["--tolerance", "0.5", "--no-hidden-faces",
    "--light", "8"]`.
    """
    words: list[str] = []
    for name, value in settings.items():
        flag = "light" if name == "light_samples" else name.replace("_", "-")
        words += [f"--{flag}" if value else f"--no-{flag}"] if isinstance(value, bool) else [f"--{flag}", str(value)]
    return words


def _command(path: str, words: list[str], frames: list[int]) -> list[str]:
    """Return the command that starts a process which bakes these frames without a file that plays them. Of repeated
    options, the last one counts.
    """
    start = [sys.executable, str(Path(__file__).parents[2] / "run_with_bpy.py"), path]
    if bpy.app.binary_path:
        # enable the extension, which the saved preferences may not have enabled
        extension = __package__.rpartition(".addon.")[0]
        start = [bpy.app.binary_path, "-b", path, "--addons", extension, "--command", "reflection_mesh"]
    return [*start, *words, "--frames", ",".join(map(str, frames)), "--frames-only", "--progress", "WORDS", "--jobs",
            "1"]


@contextmanager
def _running(commands: list[list[str]]) -> Iterator[list[subprocess.Popen]]:
    """Start processes and end them with the block, at first with a request to end."""
    processes: list[subprocess.Popen] = []
    try:
        for command in commands:
            processes.append(subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                              stderr=subprocess.STDOUT, encoding="utf-8", errors="replace",
                                              creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0)))
        yield processes
    finally:
        for process in processes:
            if process.poll() is None:
                process.send_signal(signal.SIGINT) if _hears_ctrl_c() else process.terminate()
        for process in processes:
            with suppress(subprocess.TimeoutExpired):
                process.wait(PATIENCE)
            process.kill()
            process.wait()


def _hears_ctrl_c() -> bool:
    """Return True if one Ctrl-C also ends processes started here. It does not for Blender itself, nor for processes
    that a shell runs in the background.
    """
    return os.name == "posix" and not bpy.app.binary_path and signal.getsignal(signal.SIGINT) != signal.SIG_IGN


def _heard(processes: list[subprocess.Popen], heard: Callable[[str], None]) -> Steps[int]:
    """Listen to the processes until all have ended well."""
    lines: queue.SimpleQueue = queue.SimpleQueue()
    readers = [threading.Thread(target=_read, args=(process, number, lines), daemon=True)
               for number, process in enumerate(processes)]
    for reader in readers:
        reader.start()
    done, errors, made, stage = [0.0] * len(processes), [""] * len(processes), 0, "Frames"
    left = len(processes)
    while left:
        yield sum(done) / len(done), stage
        with suppress(queue.Empty):
            number, line = lines.get(timeout=LISTENING)
            if line is None:
                left -= 1
                done[number] = 1.0
                _ended_well(processes[number].wait(), errors[number])
            elif line.startswith(PASSED_ON):
                heard(line)
            elif line.startswith("Error: "):
                errors[number] = line.removeprefix("Error: ")
            elif told := STAGE.match(line):
                done[number], stage = int(told[1]) / 100.0, told[2]
            elif told := SUMMARY.match(line):
                made += int(told[1])
    return made


def _read(process: subprocess.Popen, number: int, lines: queue.SimpleQueue) -> None:
    assert process.stdout is not None
    for line in process.stdout:
        lines.put((number, line.rstrip("\n")))
    lines.put((number, None))


def _ended_well(status: int, error: str) -> None:
    if status == STATUS:
        raise KeyboardInterrupt
    if status:
        raise ReflectionError(error or f"A process that baked frames ended without a word ({status}): let fewer bake "
                              "at once, as memory may have run out; the frames that are done stay.")
