"""The words of the interface in other languages: one room for each, by Blender's own mechanism."""
from __future__ import annotations

import bpy

from ..faults import know_sentences, know_stages
from .german import GERMAN, SENTENCES, STAGES

OPERATORS = bpy.app.translations.contexts.operator_default


def entries(language: dict) -> dict:
    """Return the translations in the form that Blender needs: by (context, word), for labels and for operators."""
    return {(context, word): translation for word, translation in language.items() for context in ("*", OPERATORS)}


# Blender has called German both
LANGUAGES = {locale: entries(GERMAN | SENTENCES | STAGES) for locale in ("de", "de_DE")}


def register() -> None:
    bpy.app.translations.register(__name__, LANGUAGES)
    know_sentences(SENTENCES)
    know_stages(STAGES)


def unregister() -> None:
    know_sentences(())
    know_stages(())
    bpy.app.translations.unregister(__name__)
