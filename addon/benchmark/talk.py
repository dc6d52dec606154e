"""Count the work of each method in the setting of the talk's cost model, and compare it with the model's prediction."""
from __future__ import annotations

from functools import partial

from ...core.rivals import METHODS, morphed, primary_hits
from ...core.rivals.scenes import talk_setting
from ..report import Cost

KINDS = {"intersections": "Ti", "traversals": "Tt", "projections": "Tp"}
LINES = (
    ("RAYS", METHODS["RAYS"].title, METHODS["RAYS"].run, 1, {"Ti": 2_000_000, "Tt": 1_000_000},
     "A little more than two tests a pixel, since nearer boxes are opened first and leaves hold few triangles."),
    ("CLUSTERS", METHODS["CLUSTERS"].title, METHODS["CLUSTERS"].run, 0, {"Ti": 2_000_000, "Tt": 2_000},
     "A cone round all rays of a mirror triangle meets some 16 triangles of the scene here, not two; only mirror "
     "triangles in the picture are traversed for."),
    ("MORPHING", METHODS["MORPHING"].title + ", as in the talk", partial(morphed, rounds=0), 1_000_000,
     {"Ti": 1_000_000, "Tt": 1_000}, "The 1M Ti, first hits of the eye's rays with the mirror, are a z-buffer's "
     "work here, which is given to all methods and counted apart."),
    ("UNREFINED", METHODS["UNREFINED"].title, METHODS["UNREFINED"].run, 0, {"Tp": 2_000, "Tt": 2_000},
     "Three cubics a vertex instead of two: near a shared edge a vertex lies in the cones of all cameras round it."),
    ("GENERAL", METHODS["GENERAL"].title, METHODS["GENERAL"].run, 0.5, {"Tp": 2_000, "Tt": 2_000},
     "The talk does not refine. Half a pixel takes more cameras, each a traversal; smaller cones hold fewer vertices, "
     "so that the projections hardly grow."),
)


def costs(pixels: int = 1024) -> tuple[list[Cost], str]:
    """Return the counted and predicted work of the methods in the talk, and a sentence on the setting."""
    made = talk_setting((pixels, pixels))
    hits = primary_hits(made.view, made.mirror, made.scene)
    found = []
    for key, title, run, value, predicted, explanation in LINES:
        counts = run(made.view, made.mirror, made.scene, value, hits).counts
        measured = {short: counts[name] for name, short in KINDS.items() if counts[name] or short in predicted}
        found.append(Cost(key, title, measured, predicted, explanation))
    setting = (f"The talk's setting: {len(hits.pixel):,} pixels that show the mirror, {len(made.scene.positions):,} "
               f"diffuse vertices and {len(made.scene.triangles):,} triangles, {len(made.mirror.positions):,} vertices "
               f"and {len(made.mirror.triangles):,} triangles of the mirror. Ti: tests of a ray against a triangle; "
               "Tt: traversals of a tree; Tp: projections of a vertex. Predicted in round numbers for 1M, 1K and 2K.")
    return found, setting
