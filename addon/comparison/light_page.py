"""Write the report of a comparison of caustics into its folder: pictures, numbers, and a page that shows them."""
from __future__ import annotations

import json
import os
from functools import partial

import bpy
import numpy as np

from ...core import in_steps
from ..faults import Steps, part
from ..report import Picture, Report, Run, Scene, csv_text, heat_map, page, run_rows
from .compare_images import DIFFERENCE, save_picture, surroundings
from .light_pictures import LightPictures, Shot

OWN, MESH = "CYCLES", "MESH"
MAPS = "Drawing error maps"
TITLES = {OWN: "Cycles' own caustics", MESH: "Meshes of light"}
FILES = ("reference", "cycles", "difference_cycles", "difference", "result")
"""The pictures, the result last."""
NOTES = (
    "All is rendered by Cycles from the same camera. Its own caustics are path traced, with the meshes hidden and the "
    "lamps lighting the mirrors; the reference is the mean of many such renders, each with other noise, and its own "
    "noise is told by how far these are apart. Clamping, Filter Glossy, denoising and adaptive sampling are off.",
    "RMSE and PSNR (for a peak of 1) are taken in linear light, over the pixels in which the camera sees something "
    "that the light may fall on. The noise is that of two renders with other seeds, over the square root of two. What "
    "the mesh does not do is in its error: light that goes on from where it falls, and the softness of a lamp that has "
    "fewer places than its size asks for.",
    "Rays: from places strewn over the mirror, one back to the lamp, which tells whether light comes there, and one "
    "along the reflection, in 64-bit numbers. The irradiance is compared over squares, 128 along the longest side of "
    "what is lit; in per cent of the flux. The rays' noise is what several throws differ by.",
    "The curve is where the mesh folds, and where the light of a small lamp is brightest. In the regions along it the "
    "mean profile of each picture across it says where its brightest line runs.")


def light_scene(report: dict, pictures: tuple, runs: tuple) -> Scene:
    """Return a comparison's report, pictures and runs as a section of a page."""
    return Scene(", ".join(report["results"]), summary(report), facts(report), pictures, runs)


def summary(report: dict) -> tuple[str, ...]:
    """Return the summary in sentences, the main result first."""
    runs = report["runs"]
    mesh = [run for run in runs if run["method"] == MESH][-1]
    own = [run for run in runs if run["method"] == OWN][-1]
    if mesh["picture"]["receivers"]["rmse"] is None:
        return ("The camera sees nothing that the light may fall on.",)
    errors = [run["picture"]["receivers"]["rmse"] for run in (mesh, own)]
    samples, noise = report["reference"]["samples"], report["reference"]["noise"]
    told = [f"With the meshes of light the picture is {errors[0]:.5f} (RMSE) from Cycles' own caustics at {samples} "
            f"samples, Cycles' own at {own['samples']} samples {errors[1]:.5f}; {noise:.5f} is the noise of the "
            f"{samples} samples themselves."]
    seconds = [f"{mesh['seconds']['render']:.1f} s at {mesh['samples']} samples",
               f"{own['seconds']['render']:.1f} s at {own['samples']}"]
    made = f" and {mesh['seconds']['generate']:.2f} s to generate" if mesh["seconds"].get("generate") else ""
    told.append(f"The picture with meshes takes {seconds[0]}{made}, that of Cycles' own {seconds[1]}.")
    for name, light in report["light"].items():
        if light and light["flux_percent"] is not None:
            told.append(f"{name}: {light['flux']:.4g} W fall where rays bring {light['flux_by_rays']:.4g} W "
                        f"({light['flux_percent']:+.3f} %, their noise {light['flux_noise_percent']:.3f} %); over "
                        f"{light['squares']} squares the irradiance differs by {light['irradiance_percent']:.2f} % "
                        f"(their noise {light['irradiance_noise_percent']:.2f} %).")
    curve = report["curve"]
    if curve["regions"]:
        told.append(f"The brightest line of the mesh runs {curve['apart_median']:.2f} px (median) from that of Cycles, "
                    f"{curve['apart_most']:.2f} px at the most, in {curve['regions']} regions along the curve.")
    return tuple(told)


def facts(report: dict) -> dict:
    """Return numbers by label."""
    shown = {"objects": f"{', '.join(report['mirrors'])} and {', '.join(report['lamps'])} light "
                        f"{', '.join(report['receivers'])}",
             "pixels in which something may be lit": report["receiver_pixels"]}
    curve = report["curve"]
    if curve["regions"]:
        shown["brightest line beside the fold, to the lit side (px): Cycles, meshes"] = (
            f"{curve['reference_median']:.2f}, {curve['mesh_median']:.2f}")
    return shown


def runs_of(pictures: LightPictures, errors: list, generate: float) -> tuple:
    """Return a `Run` for each shot with its (errors, noise), Cycles' own shots first."""
    shots = [(OWN, shot) for shot in pictures.own] + [(MESH, shot) for shot in pictures.mesh]
    runs = []
    for (method, shot), (found, noise) in zip(shots, errors):
        seconds = {"generate": generate} if method == MESH and generate else {}
        runs.append(Run(method, TITLES[method], "samples", float(shot.samples), {**seconds, "render": shot.seconds}, {},
                        {"picture": {"receivers": found, **({"noise": {"rmse": noise}} if noise is not None else {})}}))
    return tuple(runs)


def write_light_report(folder: str, scene: bpy.types.Scene, pictures: LightPictures, mask: np.ndarray,
                       report: dict, runs: tuple) -> Steps[None]:
    """Write the pictures, report.json, report.csv and report.html, in steps.

    Parameters
    ----------
    folder : str
        A folder for results that are not whole yet, as `files.staged` gives it.
    scene : bpy.types.Scene
        A temporary scene whose view settings are those of the user; its image settings are changed.
    mask : (height, width) bool
        Pixels in which something may be lit.
    """
    mesh, own = pictures.mesh[-1], _as_long(pictures)
    shown, box = [], surroundings(mask)
    for number, (name, linear, title, caption) in enumerate((
            ("reference", pictures.reference, "Cycles' own caustics, converged",
             f"{pictures.samples} samples per pixel."),
            ("result", mesh.picture, "Meshes of light", f"{mesh.samples} samples per pixel."),
            ("cycles", own.picture, "Cycles' own caustics", f"{own.samples} samples per pixel, the nearest to the time "
             "of the picture with the meshes."))):
        yield 0.25 * number, f"Writing {name}.png"
        path = os.path.join(folder, f"{name}.png")
        save_picture(path, scene, linear, "PNG")
        shown.append(Picture(name, title, caption, _jpeg(folder, name, scene, linear), "image/jpeg"))
    for name, shot, title in (("difference", mesh, "Difference of the meshes"),
                              ("difference_cycles", own, "Difference of Cycles' own")):
        yield 0.8, MAPS
        difference = np.abs(pictures.reference - shot.picture).mean(axis=2)
        data = yield from part(in_steps(partial(heat_map, difference, *DIFFERENCE)), 0.8, 0.0, MAPS)
        small = yield from part(in_steps(partial(heat_map, difference[box], *DIFFERENCE)), 0.8, 0.0, MAPS)
        with open(os.path.join(folder, f"{name}.png"), "wb") as file:
            file.write(data)
        shown.append(Picture(name, title, "From the converged picture; mean over the channels, in linear light (white "
                             "is 1).", small))
    yield 0.9, "Writing the report"
    whole = Report("Do the meshes show the light that mirrors throw?",
                   (light_scene(report, tuple(shown), runs),), environment=environment(report), notes=NOTES)
    for name, text in (("report.json", json.dumps(report, indent=2) + "\n"), ("report.csv", csv_text(run_rows(whole))),
                       ("report.html", page(whole))):
        with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
            file.write(text)


def environment(report: dict) -> dict:
    """Return the conditions of the measurement by label."""
    width, height = report["resolution"]
    return {"Blender": report["blender"], "resolution": f"{width} x {height}",
            "samples per pixel of the reference": report["reference"]["samples"], "rays": report["rays"]}


def _as_long(pictures: LightPictures) -> Shot:
    """Return Cycles' own picture whose render time is nearest to that of the last one with the meshes."""
    return min(pictures.own, key=lambda shot: abs(shot.seconds - pictures.mesh[-1].seconds))


def _jpeg(folder: str, name: str, scene: bpy.types.Scene, linear: np.ndarray) -> bytes:
    path = os.path.join(folder, f"{name}.jpg")
    save_picture(path, scene, linear, "JPEG")
    with open(path, "rb") as file:
        data = file.read()
    os.unlink(path)
    return data
