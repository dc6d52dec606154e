"""Show how the work of the tests' scenes differs from what tests/core/reflection/counts.json holds.

    python -m tools.counts            print each count that differs, as held and as found
    python -m tools.counts --write    hold what is found

A change that does more work says so in its commit, with the reason.
"""
from __future__ import annotations

import argparse
import json
from pathlib import Path

from core import reflect
from tests.inputs.dense_scenes import dense
from tests.inputs.scenes import SCENES
from tests.oracles.true_map import mesh_of

FILE = Path(__file__).resolve().parent.parent / "tests" / "core" / "reflection" / "counts.json"
PIXELS = 512
EXACT = ("mirror_triangles", "cameras", "candidates", "projections", "roots", "images", "cut", "joined",
         "caustic_edges")
NEARLY = ("pairs", "occluded", "filled", "faces")
DENSE, LONGEST = {"dense sphere": "sphere", "dense ortho": "sphere_ortho", "dense cylinder": "cylinder"}, 0.24
# in dense scenes all counts depend on the last digits: those where unclipped triangles end
WHOLE = ("whole", "left", "hidden", "pieces", "cameras", "polygons", "faces")


def counted(name: str) -> dict[str, int]:
    """Return the counts of one scene's reflection that tests compare."""
    if name in DENSE:
        case = dense(DENSE[name], (PIXELS, PIXELS), LONGEST)
        counts = reflect(case.view, case.mirror, case.scene).counts
        return {count: int(counts[count]) for count in WHOLE}
    counts = mesh_of(name, PIXELS).counts
    counts = counts | {"cut": counts["polygons"] - counts["filled"]}
    return {count: int(counts[count]) for count in EXACT + NEARLY}


def main() -> None:
    parser = argparse.ArgumentParser(description="Compare the counts of work with those that tests hold.")
    parser.add_argument("--write", action="store_true", help="hold what is found")
    options = parser.parse_args()
    held = json.loads(FILE.read_text(encoding="utf-8"))
    found = {name: counted(name) for name in (*SCENES, *DENSE)}
    for name, counts in found.items():
        for count, number in counts.items():
            if number != held.get(name, {}).get(count):
                print(f"{name}, {count}: held {held.get(name, {}).get(count)}, found {number}")
    if options.write:
        FILE.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
