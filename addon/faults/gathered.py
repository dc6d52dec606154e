"""Messages of one kind as one message, and many names as the first of them and a count."""
from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator

import bpy

NAMED = 3  # so many names are written out
ALSO = "{} Also: {}."
QUOTED, NUMBER = re.compile(r"'(.+?)'"), re.compile(r"\d[\d.,]*")


def listed(names: Iterable[str]) -> str:
    """Return names in quotation marks, the first three of them followed by the number of the others."""
    names = list(names)
    more = f" and {len(names) - NAMED} more" if len(names) > NAMED else ""
    return ", ".join(f"'{name}'" for name in names[:NAMED]) + more


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
    prefix, colon, rest = sentence.partition(": ")
    if colon and prefix in bpy.data.objects:
        yield NUMBER.sub("", rest), prefix
    for found in QUOTED.finditer(sentence):
        yield NUMBER.sub("", sentence[:found.start()]) + "''" + NUMBER.sub("", sentence[found.end():]), found[1]


def _as_one(alike: list[tuple[str, str]]) -> str:
    first = max(alike, key=lambda one: _largest_number(one[0].replace(one[1], "")))
    others = [name for sentence, name in alike if sentence != first[0]]
    return ALSO.format(first[0], listed(others)) if others else first[0]


def _largest_number(text: str) -> float:
    return max((float(number.strip(".,").replace(",", "")) for number in NUMBER.findall(text)), default=0.0)
