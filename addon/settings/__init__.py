"""Settings: declared once, held by the scene and by mirrors that have their own, given to operators and verbs."""
from .choices import ATTRIBUTES, METHODS, PLACEMENTS
from .declared import LIGHT_SETTINGS, SAMPLES, SETTINGS, WRITTEN_SETTINGS, option
from .holders import SettingsOfMirror, SettingsOfScene, SettingsOptions, holder_of, make_own, mirror_of
from .wanted import SettingsOfMirrors, UsesSettings, Wanted, attributes_of, joins, of_each

__all__ = ["ATTRIBUTES", "LIGHT_SETTINGS", "METHODS", "PLACEMENTS", "SAMPLES", "SETTINGS",
           "SettingsOfMirror", "SettingsOfMirrors", "SettingsOfScene", "SettingsOptions", "UsesSettings",
           "WRITTEN_SETTINGS", "Wanted", "attributes_of", "holder_of", "joins", "make_own", "mirror_of", "of_each",
           "option"]
