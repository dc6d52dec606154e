"""What the user sees: panels, a menu, presets, the way to the manual, and all of it in other languages.

Nothing is computed here and nothing changed: what is drawn is read from the file, and buttons call operators.
"""
from ..registration import together
from . import manual, menus, panels, preset_buttons, translations

register, unregister = together(translations, manual, preset_buttons, panels, menus)
