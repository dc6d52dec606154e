"""Messages of one kind as one message, and many names as the first of them and a count."""
from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator

import bpy

NAMED = 3  # so many names are written out
ALSO = "{} Also: {}."
FRAMES = "In frame"  # first words of sentences on single frames
QUOTED = re.compile(r"('.+?')")
NUMBER = re.compile(r"\d+(?:\.\d+)?")


def listed(names: Iterable[str]) -> str:
    """Return names in quotation marks, the first three of them followed by the number of the others."""
    names = [f"'{name}'" for name in names]
    if len(names) <= NAMED:
        return ", ".join(names)
    return "{names} and {count} more".format(names=", ".join(names[:NAMED]), count=len(names) - NAMED)


def gathered(sentences: Iterable[str]) -> list[str]:
    """Return each sentence once. Sentences that differ in one name, and in numbers, become the one with the largest
    number, followed by the other names."""
    ways = {sentence: list(_without_a_name(sentence)) for sentence in sentences}
    count = Counter(rest for own in ways.values() for rest, _ in own)
    alike: dict = {}
    for sentence, own in ways.items():
        rest, name = max(own, key=lambda way: count[way[0]], default=(sentence, ""))
        alike.setdefault(rest, []).append((sentence, name))
    return list(map(_as_one, alike.values()))


def _without_a_name(sentence: str) -> Iterator[tuple[str, str]]:
    """Yield the sentence without one of its names and without numbers, and that name, for each of its names."""
    head, colon, rest = sentence.partition(": ")
    if colon and head in bpy.data.objects:
        yield "".join(_without_numbers(rest)), head
    pieces = _without_numbers(sentence)
    if sentence.startswith(FRAMES):
        # the frames distinguish the sentence, so keep them
        pieces[0] = QUOTED.split(sentence)[0]
    for place in range(1, len(pieces), 2):
        yield "".join((*pieces[:place], "''", *pieces[place + 1:])), pieces[place][1:-1]


def _without_numbers(text: str) -> list[str]:
    """Return alternately the unquoted parts without numbers, and the quoted parts."""
    return [piece if place % 2 else NUMBER.sub("", piece) for place, piece in enumerate(QUOTED.split(text))]


def _as_one(alike: list[tuple[str, str]]) -> str:
    first = max(alike, key=lambda one: _largest_number(one[0].removeprefix(one[1])))
    others = [name for sentence, name in alike if sentence != first[0]]
    return ALSO.format(first[0], listed(others)) if others else first[0]


def _largest_number(text: str) -> float:
    found = [number for piece in QUOTED.split(text)[::2] for number in NUMBER.findall(piece)]
    return max(map(float, found), default=0.0)
