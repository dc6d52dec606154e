"""The words of the interface in other languages: one room for each, by Blender's own mechanism."""
from __future__ import annotations

import bpy

from .german import GERMAN

OPERATORS = bpy.app.translations.contexts.operator_default


def entries(language: dict) -> dict:
    """What Blender asks for: each word in the contexts of labels and of operators, which it looks up apart."""
    return {(context, word): translation for word, translation in language.items() for context in ("*", OPERATORS)}


# Blender has called German both
LANGUAGES = {locale: entries(GERMAN) for locale in ("de", "de_DE")}


def register() -> None:
    bpy.app.translations.register(__name__, LANGUAGES)


def unregister() -> None:
    bpy.app.translations.unregister(__name__)
