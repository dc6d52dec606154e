"""Messages of one kind are one message: the first of them, and the names of the others."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest

KINDS = ("{}: Dense areas were sampled at one ray per pixel ({} % of this reflection). Raise Memory for exact "
         "outlines.",
         "The mirror '{}' is coarse and shaded smooth: Cycles bends its normals, and throws more light than is here; "
         "give it more faces, or shade it flat.",
         "Cycles adds its own caustics of 'Lamp 1' in '{}', which is lit as well as it mirrors: switch Light Paths > "
         "Caustics > Reflective off.")


@pytest.fixture
def many(blank) -> list[str]:
    names = [f"Part.{number:03d}" for number in range(47)]
    for name in names:
        bpy.data.objects.new(name, None)
    return names


@pytest.mark.parametrize("kind", KINDS)
def test_what_differs_in_one_name_is_one_message(many, room, kind):
    gathered = room("addon.faults").gathered
    told = gathered([kind.format(name, 1.5 + number % 40) for number, name in enumerate(many)] + ["Something else."])
    # with the largest number that is among them
    first = many[39] if "{} %" in kind else many[0]
    others = [name for name in many if name != first]
    assert told == [f"{kind.format(first, 40.5)} Also: '{others[0]}', '{others[1]}', '{others[2]}' and 43 more.",
                    "Something else."]


def test_what_differs_in_more_stays_apart(many, room):
    gathered = room("addon.faults").gathered
    told = ["'A' has a linked reflection too: hide one of the two.", "'A' stays moved, as you left it: clear it.",
            "Cycles adds its own caustics of 'A' in 'B'.", "Cycles adds its own caustics of 'C' in 'D'.",
            "Left out because it is hidden: 'A'."]
    assert gathered(told) == told and gathered(told[:1] * 3) == told[:1] and gathered([]) == []
    assert gathered([f"Part.{number:03d}: {why}" for number, why in ((1, "Too far."), (2, "Too near."))]) == [
        "Part.001: Too far.", "Part.002: Too near."]
    assert gathered(["Left out because it is hidden: 'A'.", "Left out because it is hidden: 'B'."]) == [
        "Left out because it is hidden: 'A'. Also: 'B'."]


def test_it_is_told_in_german_too(many, room, monkeypatch):
    told, sentences = room("addon.faults.told"), room("addon.interface.german").SENTENCES
    monkeypatch.setattr(told, "pgettext_rpt", lambda text: sentences.get(text, text))
    sentence, = room("addon.faults").gathered([f"Left out because it is hidden: '{name}'." for name in many])
    assert told.translated(sentence) == (
        "Ausgelassen, weil ausgeblendet: 'Part.000'. Ebenso: 'Part.001', 'Part.002', 'Part.003' und 43 weitere.")


@pytest.mark.thorough
def test_the_report_of_many_mirrors_is_short(blank, capfd):
    """Mirrors that are apart, each of which is coarse for the light that it throws."""
    wall = parts.add("plane", "Wall", size=20.0, location=(0.0, 3.0, 3.0), rotation=(np.pi / 2, 0.0, 0.0))
    wall.data.materials.append(parts.material("Paint", "DIFFUSE"))
    chrome = parts.material("Chrome", "GLOSSY")
    for number in range(8):
        ball = parts.add("uv_sphere", f"Ball {number}", radius=0.3, segments=8, ring_count=4,
                         location=(number - 3.5, 0.0, 1.0))
        ball.data.shade_smooth()
        ball.data.materials.append(chrome)
    lamp = bpy.data.objects.new("Lamp", bpy.data.lights.new("Lamp", "POINT"))
    lamp.location = (0.0, -4.0, 2.0)
    blank.scene.collection.objects.link(lamp)
    parts.select()
    capfd.readouterr()
    assert bpy.ops.reflection_mesh.caustics() == {"FINISHED"}
    told = [line for line in capfd.readouterr().out.splitlines() if line.startswith(("Info", "Warning"))]
    assert any("coarse and shaded smooth" in line and "and 4 more." in line for line in told)
    assert len(told) <= 4 and max(map(len, told)) < 260
