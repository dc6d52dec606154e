"""Memory that is kept between two arrays, in place of given back and asked for again."""
from __future__ import annotations

import numpy as np

KEPT = 31 << 20  # bytes: GNU's malloc learns from blocks of up to 32 MiB


def keep_freed_memory() -> None:
    """Let what arrays leave free serve the next ones.

    GNU's malloc hands the end of its heap back to the system whenever more than some hundred KB lie free there, and
    asks for each larger array anew: page by page the system clears it again. It learns better from a large block that
    is freed (mallopt(3), M_MMAP_THRESHOLD: "dynamically adjusted"), here one that nothing is written to, and then keeps
    up to twice as much. Elsewhere that is an array made for nothing, in some microseconds.
    """
    np.empty(KEPT, dtype=np.uint8)
