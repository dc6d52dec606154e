"""Write the report of a comparison into its folder: pictures, numbers, and a page that shows them."""
from __future__ import annotations

import json
import os

import bpy

from ..faults import Steps, part
from ..metrics import Measurement
from ..report import Report, csv_text, flat, page
from .compare_images import comparison_pictures
from .compare_page import NOTES, environment, scene_of
from .pictures import Pictures


def write_report(folder: str, scene: bpy.types.Scene, pictures: Pictures, measurement: Measurement,
                 report: dict) -> Steps[None]:
    """Write reference.png, result.png, difference.png, displacement.png, holes.png, report.json, .csv and .html.

    In steps, as pictures may be large.

    Parameters
    ----------
    folder : str
        A folder for results that are not whole yet, as `files.staged` gives it.
    scene : bpy.types.Scene
        A temporary scene whose view settings are those of the user; its image settings are changed.
    report : dict
        What report.json holds.
    """
    files = yield from part(comparison_pictures(folder, scene, pictures, measurement), 0.0, 0.9)
    yield 0.9, "Writing the report"
    shown = Report("Is the reflection mesh worth it on this scene?",
                   (scene_of(", ".join(report["mirrors"]), report, files),), environment=environment(report),
                   notes=NOTES)
    for name, text in (("report.json", json.dumps(report, indent=2) + "\n"), ("report.csv", csv_text([flat(report)])),
                       ("report.html", page(shown))):
        with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
            file.write(text)
