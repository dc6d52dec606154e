"""Seeds that failed once: written down by the search, tried again by the tests in every later run.

A seed stands for what the generators of this version make of it. Failures worth more than that are made small and
written down in `kept_examples` instead. What was found and is not mended yet stands in the same file under "not
mended": no test tries it, and the search does not find it anew; whoever mends it moves it to the others.
"""
from __future__ import annotations

import json
from pathlib import Path

FILE = Path(__file__).with_name("kept_seeds.json")
OF_A_KIND = 3  # seeds that fail alike: more teach nothing, and cost time in every run


def kept_seeds(kind: str, file: Path = FILE) -> list[int]:
    """The seeds kept of one kind, "core", "light", "scenes", "lamps", "lit" or "thrown"."""
    return [int(seed) for seed in _read(file).get(kind, {})]


def keep(kind: str, seed: int, problem: str, file: Path = FILE) -> bool:
    """Write a seed down with what was wrong, unless it is there or enough others failed alike; whether it was."""
    kept = _read(file)
    if f"{kind} {seed}" in kept.get("not mended", {}):
        return False
    seeds = kept.setdefault(kind, {})
    alike = [one for one in seeds.values() if _sort_of(one) == _sort_of(problem)]
    if str(seed) in seeds or len(alike) >= OF_A_KIND:
        return False
    seeds[str(seed)] = problem
    file.write_text(json.dumps(kept, indent=2, ensure_ascii=False) + "\n", encoding="utf-8")
    return True


def _read(file: Path) -> dict:
    return json.loads(file.read_text(encoding="utf-8")) if file.exists() else {}


def _sort_of(problem: str) -> str:
    """What comes before the numbers of a problem: "source", or "twin: moved"."""
    words = problem.split(": ")
    return ": ".join(words[:2]) if words[0] in ("twin", "error", "changed", "result") else words[0]
