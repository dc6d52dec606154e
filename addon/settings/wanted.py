"""Combine the settings given to an operator or a command with those in the file, which they override."""
from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

import bpy

from ...core import ReflectionError, Settings
from .declared import SETTINGS
from .holders import holder_of, mirror_of

SettingsOfMirrors = Callable[[bpy.types.Object], Settings]


@dataclass(frozen=True)
class Wanted:
    """Settings of each mirror: those of the file, unless others are given.

    Calling it with a mirror returns the mirror's `core.Settings`. Calling it with None returns those for mirrors
    without settings of their own.

    Attributes
    ----------
    scene : bpy.types.Scene
    given : dict
        Values by name of setting, which override those of the scene and of all mirrors.
    """

    scene: bpy.types.Scene
    given: dict = field(default_factory=dict)

    def value(self, mirror: bpy.types.Object | None, name: str):
        """Return one setting of a mirror."""
        return self.given[name] if name in self.given else getattr(holder_of(mirror, self.scene), name)

    def __call__(self, mirror: bpy.types.Object | None) -> Settings:
        """Return the settings of a mirror.

        Raises
        ------
        ReflectionError
            If a value is invalid.
        """
        values = {"maximum_memory" if name == "memory" else name: self.value(mirror, name) for name in SETTINGS}
        try:
            return Settings(**values)
        except ValueError as error:
            # its name here, not that of the core's argument
            raise ReflectionError(str(error).replace("maximum_memory", "memory")) from error

    def samples(self, mirrors: Iterable) -> int:
        """Return the samples of light that is rendered once for all these mirrors: the largest number among them."""
        return max((self.value(mirror, "light_samples") for mirror in mirrors),
                   default=self.value(None, "light_samples"))

    def lights(self, results: Iterable) -> list[tuple[list, int]]:
        """Group results that are lit alike: (results, samples)."""
        groups: dict = {}
        for result in results:
            mirror = result.reflection_mesh.mirror
            groups.setdefault(self.value(mirror, "light_samples"), []).append(result)
        return [(group, samples) for samples, group in groups.items()]


def written_of(settings: Settings | SettingsOfMirrors, mirror: bpy.types.Object, scene: bpy.types.Scene,
               name: str) -> str:
    """Return a setting of what is written of a mirror's reflection, one of `WRITTEN_SETTINGS`."""
    return settings.value(mirror, name) if isinstance(settings, Wanted) else getattr(holder_of(mirror, scene), name)


def joins(settings: Settings | SettingsOfMirrors, scene: bpy.types.Scene, mirror: bpy.types.Object) -> bool:
    """Return True if a mirror is to share one result with the other mirrors of its hierarchy; one with settings of its
    own has a result of its own."""
    wanted = settings if isinstance(settings, Wanted) else Wanted(scene)
    return not mirror.reflection_mesh.own_settings and wanted.value(mirror, "join_parts")


def of_each(settings: Settings | SettingsOfMirrors) -> SettingsOfMirrors:
    """Return settings that are equal for all mirrors as a function of the mirror."""
    return settings if callable(settings) else lambda mirror: settings


class UsesSettings:
    """Mix-in of operators: options that were not given are the file's, and are shown as they were used, so that the
    panel after the run (F9) begins with them; what is changed there is given, and holds for all mirrors."""

    # no annotation: Blender takes those of an operator for its properties, which the Info editor lists
    # options that `show_used` has set, which nobody gave; the panel after the run keeps the operator with them
    used = {}
    # options whose setting is called otherwise
    renamed = {}
    uses = SETTINGS

    def wanted(self, context: bpy.types.Context) -> Wanted:
        """Return the settings, with the given options over those of the file."""
        return Wanted(context.scene, {name: getattr(self, option) for name, option in self._options()
                                      if self._is_given(option)})

    def show_used(self, wanted: Wanted, mirrors: Iterable = ()) -> None:
        """Show the used values in options that were not given; those of the active mirror if mirrors differ."""
        mirrors = list(mirrors)
        active = bpy.context.view_layer.objects.active
        shown = active if active in mirrors else next(iter(mirrors), None)
        used = {}
        for name, option in self._options():
            if not self._is_given(option):
                setattr(self, option, wanted.value(shown, name))
                used[option] = getattr(self, option)
        self.used = used

    def begin(self, context: bpy.types.Context) -> set:
        # a file browser that comes first shows the options
        mirror = mirror_of(context.view_layer.objects.active)
        self.show_used(self.wanted(context), [] if mirror is None else [mirror])
        return super().begin(context)

    def _options(self) -> list[tuple[str, str]]:
        return [(name, self.renamed.get(name, name)) for name in self.uses]

    def _is_given(self, option: str) -> bool:
        if not self.properties.is_property_set(option):
            return False
        return not (option in self.used and self.used[option] == getattr(self, option))
