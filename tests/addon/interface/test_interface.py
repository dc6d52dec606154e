"""Other languages, the way to the manual, and that nothing of the interface stays behind."""
from __future__ import annotations

import string
from types import SimpleNamespace

import bpy
import interface_words
import pytest
from drawn_panels import drawn, pair

from tools.extension_zip import PACKAGE


@pytest.fixture
def scene(blank) -> bpy.types.Scene:
    return pair(blank)


def fields(text: str) -> list:
    """What is put into a text, with its formats."""
    return sorted(entry[1:3] for entry in string.Formatter().parse(text) if entry[1])


def test_no_word_lacks_its_german(scene, room):
    german = room("addon.interface.german").GERMAN
    drawn_names = {*drawn(room, "VIEW_3D").properties, "role", "matte"}
    known = interface_words.words(drawn_names)
    assert len(known) > 100 and known == set(german)
    for word, translation in german.items():
        assert translation and fields(word) == fields(translation)


def test_blender_is_given_the_words_in_both_contexts(room, monkeypatch):
    translations, faults, told = room("addon.interface.translations"), room("addon.faults.told"), {}
    fake = SimpleNamespace(register=told.__setitem__, unregister=told.pop)
    monkeypatch.setattr(translations, "bpy", SimpleNamespace(app=SimpleNamespace(translations=fake)))
    for name in ("_known", "_stages"):
        # what is known while the extension is on is that of all tests
        monkeypatch.setattr(faults, name, [])
    translations.register()
    (words,) = told.values()
    assert {("*", "Tolerance"), ("Operator", "Generate Reflection"), ("*", "Rendering light")} <= set(words["de"])
    assert set(words["de"]) == set(words["de_DE"]) and faults._known and faults._stages
    translations.unregister()
    assert told == {} and not (faults._known or faults._stages)


def traces() -> list:
    """What of the extension Blender holds: types, manual, presets, menu entries."""
    names = [name for name in dir(bpy.types) if "reflection_mesh" in name.lower() or name.startswith("Reflection")]
    menu = [function for function in bpy.types.VIEW3D_MT_object.draw._draw_funcs
            if function.__module__.startswith(PACKAGE)]
    manual = [function for function in bpy.utils._manual_map if function.__module__.startswith(PACKAGE)]
    presets = [path for path in bpy.utils._preset_path_registry if "reflection_mesh" in path]
    return [names, menu, manual, presets]


def test_switching_off_leaves_nothing(blank):
    before = traces()
    assert all(before)
    bpy.ops.preferences.addon_disable(module=PACKAGE)
    try:
        gone = traces()
    finally:
        bpy.ops.preferences.addon_enable(module=PACKAGE)
    assert gone == [[], [], [], []]
    assert list(map(len, traces())) == list(map(len, before))
