"""German. Tests hold it to every word that the interface shows, and to every sentence and stage that operators tell.

Of a sentence the key is what stands between the names and numbers in it, which it has as `{}`, or as `{count}` where
the sentence is kept in one piece; `{0}` of the translation is the first of them.
"""
from .errors import ERRORS
from .obstacles import OBSTACLES
from .operator_words import OPERATORS
from .panel_words import LIVE, PANELS, STATUS_BAR
from .reports import REPORTS
from .setting_words import ROLES, SETTINGS
from .stages import STAGES

GERMAN = {**OPERATORS, **SETTINGS, **ROLES, **PANELS, **OBSTACLES, **LIVE, **STATUS_BAR}
SENTENCES = {**ERRORS, **REPORTS, **OBSTACLES}

__all__ = ["GERMAN", "SENTENCES", "STAGES"]
