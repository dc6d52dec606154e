"""The search at random, for as long as one likes, or of some seeds alone:

    make fuzz SECONDS=600 [FIRST=SEED]
    python -m tests.fuzz [core|light|scenes|lamps|lit|thrown] [--seconds 600] [--first SEED]
    python -m tests.fuzz core|light|scenes|lamps|lit|thrown SEED [SEED ...]

Seeds are new every time. Each is tried in a process that may crash or be stopped; the one that fails is printed with
what is wrong and how to try it alone, and kept in tests/fuzz/kept_seeds.json, which the tests try from then on.
"""
from __future__ import annotations

import argparse
import itertools
import sys
import time
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from threading import Lock

from tests.fuzz.asking import Asked
from tests.fuzz.kept import keep

KINDS = ("core", "light", "scenes", "lamps", "lit", "thrown")
TELLING = Lock()


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kind", nargs="?", choices=KINDS)
    parser.add_argument("seeds", nargs="*", type=int)
    parser.add_argument("--seconds", type=float, default=600.0, help="how long to search, by the clock on the wall")
    parser.add_argument("--first", type=int, default=int(time.time()) * 1000, help="the first seed to try")
    chosen = parser.parse_args()
    if chosen.seeds:
        return int(_tried(chosen.kind, chosen.seeds, None))
    until = time.monotonic() + chosen.seconds
    kinds = [chosen.kind] if chosen.kind else KINDS
    with ThreadPoolExecutor(len(kinds)) as side_by_side:
        return int(any(list(side_by_side.map(lambda kind: _tried(kind, itertools.count(chosen.first), until), kinds))))


def _tried(kind: str, seeds: Iterable[int], until: float | None) -> bool:
    """Try seeds of one kind, all of them or until the clock says so; whether any failed."""
    failed, count, asked = 0, 0, Asked(kind)
    try:
        for seed in seeds:
            answer = asked.about(seed)
            count, failed = count + 1, failed + bool(answer["problems"])
            if until is None:
                _tell(f"{kind} {answer['name']}", *(answer["problems"] or ["nothing is wrong"]))
            elif answer["problems"]:
                kept = keep(kind, seed, answer["problems"][0])
                _tell(f"{kind} {seed}: {'; '.join(answer['problems'])[:300]}",
                      f"{'kept' if kept else 'like others that are kept'}; alone: "
                      f"{sys.executable} -m tests.fuzz {kind} {seed}")
            if until is not None and time.monotonic() > until:
                break
    finally:
        asked.close()
    _tell(f"{failed} of {count} {kind} failed")
    return failed > 0


def _tell(first: str, *more: str) -> None:
    with TELLING:
        print("\n    ".join((first, *more)), flush=True)


if __name__ == "__main__":
    sys.exit(main())
