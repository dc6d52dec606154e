"""Settings: declared once, held by the scene and by mirrors that have their own, given to operators and verbs."""
from .choices import ATTRIBUTES, METHODS, PLACEMENTS, WORLD_FACES
from .declared import LIGHT_SETTINGS, SAMPLES, SETTINGS, WRITTEN_SETTINGS, option
from .holders import SettingsOfMirror, SettingsOfScene, SettingsOptions, holder_of, make_own, mirror_of
from .wanted import SettingsOfMirrors, UsesSettings, Wanted, joins, of_each, written_of

__all__ = ["ATTRIBUTES", "LIGHT_SETTINGS", "METHODS", "PLACEMENTS", "SAMPLES", "SETTINGS",
           "SettingsOfMirror", "SettingsOfMirrors", "SettingsOfScene", "SettingsOptions", "UsesSettings",
           "WORLD_FACES", "WRITTEN_SETTINGS", "Wanted", "holder_of", "joins", "make_own", "mirror_of", "of_each",
           "option", "written_of"]
