"""German. Tests hold it to every word that the interface shows, and to every sentence and stage that operators tell.

Of a sentence the key is what stands between the names and numbers in it, which it has as `{}`, or as `{count}` where
the sentence is kept in one piece; `{0}` of the translation is the first of them.
"""
from .errors import ERRORS
from .reports import REPORTS
from .stages import STAGES
from .words import OBSTACLES, WORDS

GERMAN = WORDS
SENTENCES = {**ERRORS, **REPORTS, **OBSTACLES}

__all__ = ["GERMAN", "SENTENCES", "STAGES"]
