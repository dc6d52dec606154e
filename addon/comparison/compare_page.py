"""The words of a comparison's page: its answer, its facts, and how they were measured."""
from __future__ import annotations

from ..report import Picture, Scene, number

NOTES = (
    "Displacement: the scene is rendered once in materials that emit positions, in the mirror and on the mesh. How "
    "far the two points of a pixel lie apart is divided by how far the true point moves from one pixel to the next.",
    "Holes: Cycles shows the scene and the mesh nothing. Spill: the reverse, or the mesh reaches outside the "
    "mirror. Wrong layer: another surface, more than two pixels off. Pixels are left out where a mirror is seen in "
    "the mirror beyond the depth that was followed, and where Cycles bends the normal.",
    "RMSE, PSNR (for a peak of 1) and relative MSE (squared difference over squared reference plus 0.01) are taken "
    "in linear light. SSIM (Wang et al. 2004) and FLIP (Andersson et al. 2020, 67 pixels per degree) are taken on "
    "sRGB values at exposure 0, clipped to 0..1. They contain the noise of both renders; displacement and holes do "
    "not.",
    "From Blender 5.0 on, Cycles rounds shading normals to 2 x 16 bits, which moves its own reflections. The errors"
    " without rounding are measured against Cycles with the same normals handed to it unrounded, as an attribute.",
)


def scene_of(name: str, report: dict, pictures: tuple[Picture, ...]) -> Scene:
    """Return a comparison's report and pictures as a section of a page."""
    return Scene(name, summary(report), facts(report), pictures)


def summary(report: dict) -> tuple[str, ...]:
    """Summarise a comparison of the reflection meshes with Cycles in sentences, the main result first.

    Parameters
    ----------
    report : dict
        Numbers of the comparison as `operators/compare.py` builds them and report.json holds them.

    Returns
    -------
    tuple of str
        Two paragraphs: quality and times, then the count of wrong pixels. Only one if no mirror pixel could be judged.
    """
    if not report["judged_pixels"]:
        return ("The camera sees no mirror whose reflection could be judged.",)
    displacement, coverage = report["displacement_px"], report["coverage_percent"]
    seconds = report["render_seconds"]
    made = f"It took {report['generate_seconds']:.2f} s to make. " if report["generate_seconds"] else ""
    if displacement["p99"] is None:
        close = "The reflection shows nothing that could be measured. "
    else:
        right = max(100.0 - coverage["all"], 0.0)
        close = (f"{right:.2f} % of the mirror shows the right surface, 99 % of it within {displacement['p99']:.2f} px "
                 f"of where Cycles shows it and half within {displacement['median']:.2f} px. ")
    samples = report["picture"]["samples"]
    quality = f", at {samples} sample{'' if samples == 1 else 's'} a pixel." if samples else "."
    times = (f"Cycles renders the picture in {seconds['reference']:.1f} s with the mirror and in "
             f"{seconds['result']:.1f} s with the reflection mesh" + quality)
    wrong = round(coverage["all"] * report["judged_pixels"] / 100.0)
    flip = number(report, "picture.mirror.flip")
    lit, noise = (number(report, f"picture.{name}psnr_displayed") for name in ("mirror.", "noise.mirror."))
    if lit is not None and noise is not None:
        times += (f" As displayed, the lit mesh equals the mirror to {lit:.1f} dB, where Cycles equals itself to "
                  f"{noise:.1f} dB with other noise.")
    return (close + made + times,
            f"Holes, spill and wrong layers together are {wrong} of {report['judged_pixels']} pixels." + (
                "" if flip is None else f" To the eye the pictures differ by a FLIP of {flip:.3f}, from 0 for equal to "
                "1, noise included."))


def facts(report: dict) -> dict:
    """Return the rows of the table of numbers that follows the summary: text by label, in the order of display.

    The rows are the objects, the displacement in pixels, the same without Cycles' rounding of normals, the percentages
    of wrong pixels, and the errors of the picture over the mirror and over the whole picture. Errors of pictures
    without a value are left out.

    Parameters
    ----------
    report : dict
        Numbers of the comparison, see `summary`. The keys `mirrors`, `diffuse`, `displacement_px`, `coverage_percent`
        and `picture` are needed; `without_packed_normals` is optional.
    """
    shown = {"objects": f"{', '.join(report['mirrors'])} reflect {', '.join(report['diffuse'])}",
             "displacement (px): median, 95 %, 99 %, largest": _distribution(report["displacement_px"])}
    exact = report.get("without_packed_normals")
    if exact:
        shown["the same without Cycles' rounded normals"] = _distribution(exact["displacement_px"])
        shown["what rounding moves in Cycles itself"] = _distribution(exact["shift_px"])
    coverage = report["coverage_percent"]
    shown["hole, spill, wrong layer (%)"] = "no mirror pixels" if coverage["all"] is None else ", ".join(
        f"{coverage[name]:.4f}" for name in ("hole", "spill", "wrong_layer"))
    picture = report["picture"]
    told = [(picture["mirror"], "over the mirror"), (picture["all"], "over the picture")]
    if picture.get("noise"):
        told.append((picture["noise"]["mirror"], "Cycles against itself with other noise, over the mirror"))
    for errors, label in told:
        if errors["rmse"] is not None:
            psnr, displayed = ("none (equal)" if errors[name] is None else f"{errors[name]:.2f} dB"
                               for name in ("psnr", "psnr_displayed"))
            shown[label] = (f"RMSE {errors['rmse']:.5f}, PSNR {psnr}, on sRGB values {displayed}, relative MSE "
                            f"{errors['relative_mse']:.6f}, SSIM {errors['ssim']:.5f}, FLIP {errors['flip']:.5f}")
    return shown


def environment(report: dict) -> dict:
    """Return the conditions of the measurement by label."""
    width, height = report["resolution"]
    samples = report["picture"]["samples"]
    return {"Blender": report["blender"], "resolution": f"{width} x {height}",
            "samples per pixel": samples if samples else "as the scene is set"}


def _distribution(values: dict) -> str:
    shown = (values[name] for name in ("median", "p95", "p99", "max"))
    return ", ".join("none" if value is None else f"{value:.3f}" for value in shown)
