"""The options of verbs that are settings: what is not given is what the file holds."""
from __future__ import annotations

import argparse

from ..settings import ATTRIBUTES, METHODS, PLACEMENTS, SETTINGS, WORLD_FACES, WRITTEN_SETTINGS


def number(text: str) -> float | None:
    """Return a number; None for an empty text, since templates of farms pass options even without values."""
    return float(text) if text else None


def whole_number(text: str) -> int | None:
    """Return an integer; None for an empty text."""
    return int(text) if text else None


def text(given: str) -> str:
    """Return a non-empty text. Reject an empty one, e.g. from an empty variable of a script, since it is not the same
    as a missing option.
    """
    if not given.strip():
        raise argparse.ArgumentTypeError("it is given without a value: write one, or leave the option out")
    return given


class Names(argparse.Action):
    """Collect the names that follow an option, without empty ones.

    Empty names are an error unless `--progress OPENJD` was given: templates of Open Job Description pass all options,
    and those without a value get an empty name. Options are parsed in order, so `--progress` must stand before the
    names.
    """

    def __call__(self, parser: argparse.ArgumentParser, namespace: argparse.Namespace, values,
                 option_string: str | None = None) -> None:
        told = [name for name in values if name.strip()]
        if len(told) < len(values) and namespace.progress != "OPENJD":
            parser.error(f"argument {option_string}: it is given without a value: write one, or leave the option out")
        setattr(namespace, self.dest, told)


def add_settings(parser: argparse.ArgumentParser, only: tuple[str, ...] = SETTINGS, of_farms: bool = False) -> None:
    """Add the options for the settings `only`. With `of_farms`, numbers may be empty."""
    real, whole = (number, whole_number) if of_farms else (float, int)
    asked = {
        "tolerance": {"type": real, "metavar": "PIXELS", "help": "how far off a point may be"},
        "placement": {"choices": [item[0] for item in PLACEMENTS], "help": "where the reflection lies"},
        "method": {"choices": [item[0] for item in METHODS], "help": "what the reflection is made of"},
        "depth": {"type": whole, "metavar": "BOUNCES",
                  "help": "how many mirrors are followed, one after another; 0: as many as there are to see"},
        "memory": {"type": real, "metavar": "GB", "help": "what would need more is worked out more coarsely, or "
                   "refused"},
        "hidden_faces": {"action": argparse.BooleanOptionalAction, "help": "also the faces that nearer ones hide "
                         "whole"},
    }
    for name in only:
        asked[name]["help"] += " (else as the file has it)"
        parser.add_argument(f"--{name.replace('_', '-')}", **asked[name])


def add_written(parser: argparse.ArgumentParser) -> None:
    """Add the options for what is written of a reflection."""
    for name, items, text_ in (("attributes", ATTRIBUTES, "what points and faces know"),
                               ("world-faces", WORLD_FACES, "when faces show the world")):
        parser.add_argument(f"--{name}", choices=[item[0] for item in items], help=f"{text_} (else as the file has it)")
    parser.add_argument("--join-parts", action=argparse.BooleanOptionalAction,
                        help="mirrors that have one topmost parent share one reflection (else as the file has it)")


def add_own(parser: argparse.ArgumentParser) -> None:
    """Add the option for Cycles' own caustics."""
    parser.add_argument("--keep-own", dest="leave_out", action="store_false", default=None,
                        help="let Cycles add caustics of its own (else as before)")
    parser.add_argument("--replace-own", dest="leave_out", action="store_true", help="let it add none (else as before)")


def given(options: argparse.Namespace, **more) -> dict:
    """Return the settings that were given, by name. `more` are settings whose options have other names."""
    values = {name: getattr(options, name, None) for name in SETTINGS + WRITTEN_SETTINGS} | more
    return {name: value for name, value in values.items() if value is not None}
