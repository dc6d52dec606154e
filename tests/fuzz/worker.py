"""Tries seeds, one after another, in a process of its own that may crash or be killed:

    python -m tests.fuzz.worker core|light|scenes|lamps|lit|thrown

reads a seed a line and answers each with a line of JSON: {"seed": ..., "name": ..., "problems": [...]}.
"""
from __future__ import annotations

import json
import os
import resource
import shutil
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

# of processor time, for a seed with all that is done to it
SECONDS = {"core": 60, "light": 90, "scenes": 120, "lamps": 300, "lit": 300, "thrown": 300}
GIGABYTES = 8  # of address space, for all seeds


def main(kind: str) -> None:
    # what the libraries print is no answer
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    with {"core": _core, "light": _light, "scenes": _scenes, "lamps": _lamps, "lit": _lit,
          "thrown": _thrown}[kind]() as tried:
        resource.setrlimit(resource.RLIMIT_AS, (GIGABYTES * 10**9, resource.RLIM_INFINITY))
        for line in sys.stdin:
            # SIGXCPU ends the process where a seed takes longer
            last = int(time.process_time()) + SECONDS[kind] + 1
            resource.setrlimit(resource.RLIMIT_CPU, (last, resource.RLIM_INFINITY))
            answers.write(json.dumps({"seed": int(line), **tried(int(line))}) + "\n")
            answers.flush()


@contextmanager
def _core() -> Iterator[Callable[[int], dict]]:
    from tests.fuzz.drawing.configurations import drawn
    from tests.fuzz.trying import problems_of

    def tried(seed: int) -> dict:
        configuration = drawn(seed)
        return {"name": configuration.name, "problems": problems_of(configuration, seed)}
    yield tried


@contextmanager
def _light() -> Iterator[Callable[[int], dict]]:
    from tests.fuzz.light_trial import tried_light
    yield tried_light


@contextmanager
def _scenes() -> Iterator[Callable[[int], dict]]:
    with _extension():
        from tests.fuzz.blender.scene_trial import tried_scene
        yield tried_scene


@contextmanager
def _lamps() -> Iterator[Callable[[int], dict]]:
    with _extension():
        from tests.fuzz.blender.scene_light_trial import tried_lamps
        yield tried_lamps


@contextmanager
def _lit() -> Iterator[Callable[[int], dict]]:
    with _extension():
        from tests.fuzz.blender.lit_trial import tried_lit
        yield tried_lit


@contextmanager
def _thrown() -> Iterator[Callable[[int], dict]]:
    with _extension():
        from tests.fuzz.blender.thrown_trial import tried_thrown
        yield tried_thrown


@contextmanager
def _extension() -> Iterator[None]:
    """With the extension as users have it, in preferences of its own."""
    from tools import extension_zip
    folder = Path(tempfile.mkdtemp(prefix="reflection_mesh_fuzz_"))
    # before anything imports bpy
    extension_zip.use_throw_away_preferences(folder)
    extension_zip.install(extension_zip.build(folder / "zip"))
    try:
        yield
    finally:
        extension_zip.switch_off()
        shutil.rmtree(folder, ignore_errors=True)


if __name__ == "__main__":
    main(sys.argv[1])
