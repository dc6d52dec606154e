"""Print the progress of a command, in words or in the lines that a render farm's worker parses."""
from __future__ import annotations

from ..faults import Steps, finished


def announced(steps: Steps, farm: str = "") -> object:
    """Run steps to their end and print each stage once. Return their result.

    Parameters
    ----------
    farm : str
        "OPENJD" prints lines for Open Job Description ("How Jobs Are Run", Stdout/Stderr Messages).
    """
    told = ""

    def tell(progress: tuple[float, str]) -> None:
        nonlocal told
        fraction, stage = progress
        if stage == told:
            return
        told = stage
        if farm == "OPENJD":
            print(f"openjd_progress: {100.0 * fraction:.1f}", f"openjd_status: {stage}", sep="\n", flush=True)
        else:
            print(f"{100.0 * fraction:3.0f} %  {stage}", flush=True)
    return finished(steps, tell)
