"""What belongs to a baked frame, as JSON beside its files: written last, so that a frame without it is not done."""
from __future__ import annotations

import hashlib
import json
import os
from collections import Counter
from dataclasses import asdict, dataclass, field

import bpy

LONGEST = 1_000_000     # bytes of a record; its own are some thousand


@dataclass(frozen=True)
class ResultRecord:
    """One result in one frame.

    Attributes
    ----------
    file : str
        Name of its USD file.
    attributes : tuple of (name, kind, domain)
        What is packed into the file's colours, in this order.
    materials : tuple of (name, library)
        What its faces show.
    lit : bool
        Whether it shows the frame's picture of light.
    """

    file: str
    attributes: tuple
    materials: tuple
    lit: bool

    @property
    def is_empty(self) -> bool:
        """Whether there is nothing in it: else it has places on the mirror at the least."""
        return not self.attributes


@dataclass(frozen=True)
class FrameRecord:
    """One frame: what it was made with, its results by the names of their mirrors, its picture of light or "", what it
    was made from, as freshness tells it, and how many faces of light lie over each other; empty and 0 in frames of
    earlier versions."""

    frame: int
    made_with: dict
    results: dict
    image: str
    made_from: dict = field(default_factory=dict)
    layers: int = 0

    @property
    def files(self) -> list[str]:
        return [result.file for result in self.results.values()] + ([self.image] if self.image else [])


def file_name(name: str, frame: int, ending: str) -> str:
    """The name of a frame's file: as sequences are numbered, and with none but letters that every system takes."""
    clean = bpy.path.clean_name(name)
    if clean != name.replace(" ", "_"):
        # two names must not become one
        clean = _marked(clean, name)
    return f"{clean}.{frame:04d}.{ending}"


def told_apart(names: list[str]) -> dict[str, str]:
    """What files that belong to each of some names are to be called: the names, but where two of them would be one in
    files, in which spaces are no spaces and systems may not tell small letters from capital ones."""
    count = Counter(map(_in_files, names))
    return {name: _marked(name, name) if count[_in_files(name)] > 1 else name for name in names}


def _in_files(name: str) -> str:
    return bpy.path.clean_name(name).casefold()


def _marked(text: str, name: str) -> str:
    return f"{text}_{hashlib.sha256(name.encode()).hexdigest()[:6]}"


def record_path(folder: str, take: str, frame: int) -> str:
    return os.path.join(folder, file_name(f"Frame {take}".strip(), frame, "json"))


def write_record(path: str, record: FrameRecord) -> None:
    with open(path, "w", encoding="utf-8") as file:
        json.dump(asdict(record), file, indent=1, sort_keys=True)
        file.flush()
        os.fsync(file.fileno())


def read_record(path: str) -> FrameRecord | None:
    """The record of a frame; None where there is none that can be believed."""
    try:
        with open(path, encoding="utf-8") as file:
            known = json.loads(file.read(LONGEST))
        results = {str(mirror): ResultRecord(str(entry["file"]), tuple(map(_three, entry["attributes"])),
                                             tuple((str(name), str(library)) for name, library in entry["materials"]),
                                             bool(entry["lit"]))
                   for mirror, entry in known["results"].items()}
        record = FrameRecord(int(known["frame"]), dict(known["made_with"]), results, str(known["image"]),
                             {str(name): str(text) for name, text in known.get("made_from", {}).items()},
                             int(known.get("layers", 0)))
    except (OSError, ValueError, TypeError, KeyError, AttributeError, RecursionError):
        return None
    # names of files, not ways to other places
    return record if all(name and os.path.basename(name) == name for name in record.files) else None


def is_done(folder: str, record: FrameRecord | None) -> bool:
    """Whether a frame has a record and all of its files."""
    return record is not None and all(os.path.isfile(os.path.join(folder, name)) for name in record.files)


def _three(entry: list) -> tuple[str, str, str]:
    name, kind, domain = entry
    return str(name), str(kind), str(domain)
