"""The user interface: panels, a menu, presets, links to the manual, and translations.

This package computes and changes nothing. It draws values from the file, and its buttons call operators.
"""
from ..registration import together
from . import manual, menus, panels, preset_buttons, translations

register, unregister = together(translations, manual, preset_buttons, panels, menus)
