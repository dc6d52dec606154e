"""The record of a baked frame, a JSON file beside its data. It is written last: a frame without it is incomplete."""
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
        Attributes that are packed into the file's colours, in this order.
    materials : tuple of (name, library)
        Materials of its faces.
    lit : bool
        True if it shows the frame's image of light.
    """

    file: str
    attributes: tuple
    materials: tuple
    lit: bool

    @property
    def is_empty(self) -> bool:
        """True if the result is empty. Otherwise it has at least the positions on the mirror."""
        return not self.attributes


@dataclass(frozen=True)
class FrameRecord:
    """The record of one frame: its settings, its results by the names of their mirrors, its image of light (or ""), its
    inputs (see `freshness`), and the number of overlapping faces of caustics. The last two are empty and 0 in frames of
    earlier versions.
    """

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
    """Return the name of a frame's file, numbered as in image sequences, with characters that all systems accept."""
    clean = bpy.path.clean_name(name)
    if clean != name.replace(" ", "_"):
        # two names must not become one
        clean = _marked(clean, name)
    return f"{clean}.{frame:04d}.{ending}"


def told_apart(names: list[str]) -> dict[str, str]:
    """Return a name for use in files for each of `names`. It is the name itself unless two names would be equal in
    files, which have no spaces and may ignore case.
    """
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
    """Return the record of a frame; None if there is no valid one."""
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
    """Return True if a frame has a record and all of its files."""
    return record is not None and all(os.path.isfile(os.path.join(folder, name)) for name in record.files)


def _three(entry: list) -> tuple[str, str, str]:
    name, kind, domain = entry
    return str(name), str(kind), str(domain)
