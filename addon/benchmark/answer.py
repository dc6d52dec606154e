"""The words of a benchmark: what a scene's runs say, its facts, and how all of it was measured."""
from __future__ import annotations

from ..report import Run
from .options import Options
from .running import Contest

NOTES = (
    "Truth: Cycles renders the scene in materials that emit the object, the face and the position that a mirror shows. "
    "A displacement is the distance of the point shown from the true one, over the true point's motion from one pixel "
    "to the next. Holes, spill and wrong layers are counted as in a comparison. The mean error takes at most one "
    "pixel for a displacement, and one for every hole, spill and wrong layer.",
    "Over the pixels' area: the truth is rendered twice more on lattices that share no divisor with the picture's, so "
    "that places everywhere in the pixels are judged alike. A mesh is drawn there; a picture of samples shows its "
    "nearest sample. This is the measure of the first plot, because what the forward method makes is geometry, which "
    "is rendered, anti-aliased, zoomed and edited later, where a picture knows its samples alone.",
    "At the pixels' centres ray tracing is exact by definition, since the truth takes the same rays, and for small "
    "pictures of small scenes it is faster too. A picture of two or four samples across a pixel has no sample at the "
    "centre; its nearest is a part of a pixel away.",
    "Seconds are all that a method does from arrays to what is shown, in NumPy, but for Blender's BVHTree; what takes "
    "less than half a second is run again, and the quicker run counts. Meshes are drawn once by the z-buffer, in the "
    "stages drawing and picture. What the eye sees of the mirror at the pixels' centres is given to all and not in the "
    "seconds; what a method sees of it at more places is, as far as it takes longer than what was given.",
    "Several mirrors are taken as one mesh. What a mirror shows of a mirror is left out.",
)


def summary(runs: tuple[Run, ...], cycles: float, samples: int) -> tuple[str, ...]:
    """The answer first, then what stands behind it."""
    general = [run for run in runs if run.method == "GENERAL"]
    if not general:
        return (f"Cycles takes {cycles:.2f} s for this picture at {samples} samples a pixel.",)
    said = []
    for name, where in (("area", "over the pixels' area"), ("centres", "at the pixels' centres")):
        good = [f"{run.value:g}" for run in general if run.numbers["on_front"][name]]
        said.append(f"on the Pareto front {where} (tolerance {', '.join(good)} px)" if good else
                    f"not on the Pareto front {where}")
    best = min(general, key=lambda run: abs((run.value or 0.0) - 0.5))
    text = [f"The general camera, refined, is {said[0]}, and {said[1]}."]
    text.append(f"At a tolerance of {best.value:g} px it takes {best.total:.2f} s, with a mean error of "
                f"{best.numbers['area']['mean_error_px']:.3f} px over the pixels' area and "
                f"{best.numbers['mean_error_px']:.3f} px at their centres. " + _rays(runs)
                + f"Cycles takes {cycles:.2f} s for the picture at {samples} samples a pixel.")
    return tuple(text)


def _rays(runs: tuple[Run, ...]) -> str:
    told = [f"{run.total:.2f} s and {run.numbers['area']['mean_error_px']:.3f} px with {run.value:g} x {run.value:g} "
            "samples a pixel" for run in runs if run.method == "RAYS" and run.value >= 1]
    return f"Ray tracing takes {'; '.join(told)}. " if told else ""


def facts(contest: Contest, seconds: dict, options: Options) -> dict:
    """Numbers by label; `seconds` are those of Cycles' pictures."""
    case, hits, centres = contest.case, contest.hits, contest.truths.centres
    width, height = case.view.resolution
    names = [", ".join(obj.name for obj in objects) for objects in (case.mirrors, case.diffuse)]
    return {"objects": f"{names[0]} reflect {names[1]}" + (
                "; the mirrors are taken as one mesh" if len(case.mirrors) > 1 else ""),
            "mirror": f"{len(case.mirror.triangles):,} triangles, {int(centres.mirror.sum()):,} of {width} x {height} "
                      "pixels",
            "diffuse scene": f"{len(case.scene.mesh.positions):,} vertices, {len(case.scene.mesh.triangles):,} "
                             "triangles",
            "judged": f"{int(centres.judged.sum()):,} pixels, and about as many places anywhere in them",
            "what the eye sees of the mirror, given to all": f"{sum(hits.seconds.values()):.2f} s",
            "Cycles' pictures": f"{seconds['reference']:.2f} s with the mirror, {seconds['result']:.2f} s with the "
                                f"mesh, {options.samples} samples a pixel",
            "allowed for each value of a knob": f"{options.budget:g} s; what is expected to take longer is left out"}
