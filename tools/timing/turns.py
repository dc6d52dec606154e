"""Two checkouts against each other, in turns in one run: processor seconds of `core.reflect`, arrays in and out.

    python -m tools.timing.turns OTHER_CHECKOUT [1000 10000 sphere ...] [--rounds 4]

A number stands for the scene of tools.timing.sizes with about so many vertices, a name for one of tests/inputs/scenes,
both at 1024 x 1024. Each checkout has a process of its own, without threads of NumPy's. Machines are noisy: the least
seconds of all rounds are compared, and the ratios of single rounds tell the spread.
"""
from __future__ import annotations

import argparse
import os
import statistics
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

from tools.measure import print_table
from tools.timing import sizes

HERE = Path(__file__).resolve().parents[2]
ONE_THREAD = {name: "1" for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")}


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("other", type=Path, help="the checkout to compare this one with")
    parser.add_argument("scenes", nargs="*", default=["1000", "10000", "sphere", "bowl", "water", "torus"])
    parser.add_argument("--rounds", type=int, default=4)
    parser.add_argument("--work", type=Path, help=argparse.SUPPRESS)
    options = parser.parse_args(arguments)
    if options.work:
        return _work(options.work)
    rows = []
    with _worker(options.other.resolve()) as other, _worker(HERE) as own:
        for name in options.scenes:
            taken = [(_asked(other, name), _asked(own, name)) for _ in range(options.rounds)]
            before, after = zip(*((theirs[0], mine[0]) for theirs, mine in taken))
            ratios = [one / two for one, two in zip(before, after)]
            rows.append((name, min(before), min(after), min(before) / min(after), statistics.median(ratios),
                         min(ratios), max(ratios), int(taken[0][0][1]), int(taken[0][1][1])))
    print_table([("scene", "other s", "this s", "other / this", "median", "from", "to", "other's faces", "faces"),
                 *rows])
    return 0


def _worker(checkout: Path) -> subprocess.Popen:
    """A process that reflects the scenes whose names it is told, by the method of a checkout."""
    return subprocess.Popen([sys.executable, "-m", "tools.timing.turns", str(HERE), "--work", str(checkout)],
                            cwd=HERE, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
                            env={**os.environ, **ONE_THREAD})


def _asked(worker: subprocess.Popen, name: str) -> tuple[float, ...]:
    """Processor seconds that a scene took, and its faces."""
    print(name, file=worker.stdin, flush=True)
    assert worker.stdout is not None  # a pipe, as asked for
    answer = worker.stdout.readline().split()
    if not answer:
        raise SystemExit(f"The scene {name} could not be reflected; see the error above.")
    return tuple(map(float, answer))


def _work(checkout: Path) -> int:
    sys.path.insert(0, str(checkout))
    import core
    given: dict[str, tuple] = {}
    for line in sys.stdin:
        name = line.strip()
        if name not in given:
            given[name] = _scene(core, name)
            core.reflect(*given[name])
        started = time.process_time()
        mesh = core.reflect(*given[name])
        print(time.process_time() - started, len(mesh.triangles), flush=True)
    return 0


def _scene(core, name: str) -> tuple:
    """View, mirror and scene."""
    if not name.isdigit():
        from tests.inputs.scenes import SCENES
        case = SCENES[name]((1024, 1024))
        return case.view, case.mirror, case.scene
    (positions, triangles), scene = sizes._ball(32), sizes._objects(int(name))
    normals = positions - positions.mean(axis=0)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    view = core.View.looking_at(sizes.EYE, sizes.TARGET, (sizes.SIZE, sizes.SIZE),
                                field_of_view=2.0 * np.arctan(18.0 / sizes.LENS))
    return view, core.TriangleMesh(positions, triangles, normals[triangles]), core.TriangleMesh(*scene)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
