"""Sentences in other languages: none lacks its German, and what is told in a window is told in it."""
from __future__ import annotations

import re
import string
from types import SimpleNamespace

import bpy
import parts
import pytest
import told_sentences


@pytest.fixture
def german(room, monkeypatch):
    """Blender speaks German; as a module it knows no languages."""
    spoken = room("addon.interface.german")
    sentences, words = spoken.SENTENCES, spoken.GERMAN | spoken.STAGES
    monkeypatch.setattr(room("addon.faults.told"), "pgettext_rpt", lambda text: sentences.get(text, text))
    for module in ("told", "status_bar", "stepped_operator", "unforeseen"):
        module = f"addon.faults.{module}"
        monkeypatch.setattr(room(module), "pgettext_iface", lambda text: words.get(text, text))
    return sentences


def fields(text: str) -> list[str]:
    return [entry[1] for entry in string.Formatter().parse(text) if entry[1] is not None]


@pytest.mark.thorough
def test_no_sentence_lacks_its_german(room):
    german = room("addon.interface.german").SENTENCES
    told = told_sentences.told()
    assert len(told) > 120
    known_words = set(room("addon.interface.german").GERMAN)
    assert sorted(told - set(german) - known_words) == []
    # and none is translated that nobody says
    assert sorted(set(german) - told_sentences.written()) == []


def test_what_is_put_in_is_in_the_german_too(room):
    for english, german in room("addon.interface.german").SENTENCES.items():
        known, used = fields(english), fields(german)
        if all(name.isdigit() for name in used) and used:
            assert set(map(int, used)) <= set(range(len(known))), english
        else:
            assert sorted(known) == sorted(used), english


def test_every_sentence_is_recognized_whatever_is_in_it(room, german):
    """Not as another one, and with names and numbers in their places."""
    translated = room("addon.faults").translated
    for english, wanted in german.items():
        names = fields(english)
        for values in ([f"{number + 1}" for number in range(len(names))], [f"Ding {number}" for number in range(9)]):
            put = {name: value for name, value in zip(names, values) if name}
            # parts of sentences hold numbers alone: names may be made of the same words
            whole = english.endswith(".") or ":" in english or sum(map(str.isalpha, english)) > 20
            if whole or not names or values[0] == "1":
                assert translated(english.format(*values, **put)) == wanted.format(*values, **put), english
    for name in ("Frame 3", "Two faces", "My reflections", "frames of mine"):
        assert translated(f"The mirror '{name}' is hidden: show it in the viewport and in renders.") == (
            f"Der Spiegel '{name}' ist ausgeblendet: zeige ihn in der Ansicht und im Render.")


def test_what_is_lacking_is_told_in_german(room, german):
    translated, place = room("addon.faults").translated, room("addon.operators.shortcomings")
    counts = {**dict.fromkeys(place.SENTENCES, 3), "filled_pixels": 1, "mirror_pixels": 8}
    told = place.shortcomings("Mirror", SimpleNamespace(counts=counts, missing_share=0.0, positions=range(9)))
    assert len(told) == len(place.SENTENCES) > 5
    for sentence in told:
        assert "{" not in sentence + translated(sentence) and translated(sentence) != sentence
    assert "12.5 %" in translated(told[0]) and "33.3 %" in translated(told[-1])


@pytest.mark.parametrize("count", [1, 2])
def test_one_of_something_is_no_plural(room, german, count):
    """"1 faces": in either language."""
    translated = room("addon.faults").translated
    light = SimpleNamespace(name="Light", data=SimpleNamespace(polygons=range(count)),
                            reflection_mesh=SimpleNamespace(faces=count, points=0, seconds=1.0))
    thrown = room("addon.operators.caustics").Thrown([light], {}, 0, [], [])
    plan = SimpleNamespace(frames=range(count), takes=[None], folder="there")
    told = [thrown.summary(1.0), room("addon.live.update").REFLECTION_MESH_OT_update._summary(None, [light]),
            room("addon.operators.bake_frames.plan").summary([plan], count, 1.0),
            room("addon.operators.mirror_uvs").Outcome([light], []).summary(1.0)]
    english, other = ("1 face", "1 frame"), ("Fläche", "Einzelbild")
    if count == 2:
        english, other = ("2 faces", "2 frames"), ("Flächen", "Einzelbildern")
    for sentence in told:
        assert re.search(rf"({'|'.join(english)})\b", sentence), sentence
        assert re.search(rf"\b{count} ({'|'.join(other)})\b", translated(sentence)), translated(sentence)


def test_nothing_is_reported_past_the_languages():
    assert told_sentences.reports() == []


def test_errors_and_refusals_are_told_in_german(blank, room, german):
    cube, mirror = parts.add("cube", "Box", location=(0.0, -1.5, 1.0)), parts.add_wall_mirror()
    cube.hide_render = True
    parts.select(cube, mirror)
    assert parts.refusal() == (
        "Das Objekt 'Box' ist ausgeblendet: zeige es in der Ansicht, im Render und für Glanzstrahlen.")
    cube.hide_render = False
    blank.scene.camera.location = (0.0, 6.0, 1.0)
    blank.scene.camera.rotation_euler = (1.45, 0.0, 0.0)
    blank.view_layer.update()
    assert parts.refusal() == (
        "Mirror: Die Kamera sieht den Spiegel nicht; drehe sie zum Spiegel oder rücke ihn ins Bild.")


def test_an_error_that_nobody_foresaw_is_told_in_german(blank, room, german, monkeypatch):
    cube, mirror = parts.add("cube", "Box", location=(0.0, -1.5, 1.0)), parts.add_wall_mirror()
    parts.select(cube, mirror)

    def fails(*_):
        raise ZeroDivisionError("Kamera weg")
    monkeypatch.setattr(room("addon.operators.generate"), "read_view", fails)
    assert parts.refusal() == ("Spiegelung erzeugen misslang aus einem unvorhergesehenen Grund (ZeroDivisionError: "
                               "Kamera weg): nichts hat sich geändert; die Konsole sagt mehr.")


def test_what_was_done_is_told_in_german(blank, room, german, monkeypatch):
    cube, mirror = parts.add("cube", "Box", location=(0.0, -1.5, 1.0)), parts.add_wall_mirror()
    cube.data.materials.append(parts.material("Grey", "DIFFUSE"))
    parts.select(cube, mirror)
    said = []
    faults = room("addon.faults.told")
    translated = faults.translated

    def heard(sentence: str, depth: int = 0) -> str:
        found = translated(sentence, depth)
        if not depth:
            said.append(found)
        return found
    monkeypatch.setattr(faults, "translated", heard)
    parts.generate()
    assert re.fullmatch(r"'Mirror Reflection': \d+ Flächen, [\d.]+ KB, Fehler etwa [\d.]+ px, [\d.]+ s; noch nicht "
                        "beleuchtet", said[-1])
    parts.select()
    bpy.ops.reflection_mesh.clear()
    assert said[-1] == "1 Spiegelung entfernt."
    frames = room("addon.operators.bake_frames.plan").frames_listed([2, 3])
    assert translated(f"Kept although they were baked from another state of the scene (the mirror has changed): "
                      f"{frames} in '/tmp'; overwrite them, or choose another folder, to have all alike.") == (
        "Behalten, obwohl die Szene beim Backen eine andere war (der Spiegel hat sich geändert): Einzelbilder 2, 3 in "
        "'/tmp'; überschreibe sie, oder wähle einen anderen Ordner, damit alle gleich sind.")


@pytest.mark.thorough
def test_no_stage_lacks_its_german(room, german):
    """And none is translated that no work has."""
    translated, known = room("addon.faults").translated_stage, room("addon.interface.german").STAGES
    stages = told_sentences.stages()
    assert len(stages) > 40
    assert [stage for stage in sorted(stages) if translated(stage) == stage] == []
    assert sorted(set(known) - stages) == []
    for english, wanted in known.items():
        assert english.count("{}") == wanted.count("{}"), english


def test_stages_are_in_plain_words():
    """The status bar shows them: names of data structures and of steps of the method say nothing to artists."""
    jargon = re.compile(r"\b(k-d|trees?|cones?|rays through|projections?|irradiance|whole faces|three-ray|cameras)\b")
    assert [stage for stage in told_sentences.stages() if jargon.search(stage)] == []


@pytest.mark.parametrize("method", ["GENERAL", "POINTS"])
def test_all_that_work_tells_comes_in_german(blank, room, german, method):
    parts.select(parts.add("ico_sphere", "Ball", subdivisions=4, location=(0.0, -1.5, 1.0)), parts.add_wall_mirror())
    generation, chosen = room("addon.operators.generate").generation, room("addon.reading").choose(blank)
    told = []
    room("addon.faults").finished(generation(blank, chosen, room("core").Settings(method=method)), told.append)
    stages = [stage for _, stage in told]
    assert len(set(stages)) >= 5
    for stage in stages:
        spoken = room("addon.faults").translated_stage(f"Frame 7: {stage}").split(": ")
        assert spoken[0] == "Bild 7" and spoken[1:-1] == [name for name in ["Mirror"] if f"{name}: " in stage]
        assert spoken[-1] != stage.split(": ")[-1], stage


def test_the_status_bar_speaks_german(room, german):
    translated = room("addon.faults").translated_stage
    assert translated("Rendering the faces in the mirror, 2 of 7") == (
        "Rendern: die Flächen im Spiegel, 2 von 7")
    assert translated("Rendering Cycles caustics at 64 samples once more, 10 of 11") == (
        "Rendern: Kaustik von Cycles mit 64 Samples noch einmal, 10 von 11")
    assert translated("Writing My {0} mirror: of gold") == "My {0} mirror wird geschrieben: of gold"
    assert translated("") == "" and translated("{}: {0}") == "{}: {0}"
    assert room("addon.faults.status_bar").time_left(10.0, 0.25) == "noch etwa 30 s"


def test_in_english_and_of_strange_names_nothing_is_changed(room):
    translated = room("addon.faults").translated
    for sentence in ("The mirror 'Mirror' is hidden: show it in the viewport and in renders.", "", "a: b: c",
                     "x {} {y}", "'{}' is a folder: name a file in it.", "The mirror '{0}' is hidden: {oh}", "a\nb: c"):
        assert translated(sentence) == sentence
