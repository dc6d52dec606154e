"""Ctrl-C while Blender renders or changes the frame, for PyPI's module `bpy`, which does not listen to it as Blender
itself does.

Python's KeyboardInterrupt would be raised inside Cycles or a handler, whose caller prints a traceback and goes on.
"""
from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager

import bpy

STATUS = 130    # as shells have it: 128 and the signal's number


@contextmanager
def interrupt_held() -> Iterator[None]:
    """Ctrl-C is heard, and raised as KeyboardInterrupt when the block is done; a second one ends the process."""
    # Blender itself has a program's path
    if (bpy.app.binary_path or os.name != "posix" or threading.current_thread() is not threading.main_thread()
            or signal.getsignal(signal.SIGINT) is not signal.default_int_handler):
        yield
        return
    heard: list[int] = []
    reading, writing = os.pipe()
    os.set_blocking(writing, False)
    signal.signal(signal.SIGINT, lambda *_: None)
    earlier = signal.set_wakeup_fd(writing, warn_on_full_buffer=False)
    watcher = threading.Thread(target=_listen, args=(reading, heard), daemon=True)
    watcher.start()
    try:
        yield
    finally:
        signal.set_wakeup_fd(earlier)
        signal.signal(signal.SIGINT, signal.default_int_handler)
        os.close(writing)
        watcher.join()
        os.close(reading)
        if heard:
            raise KeyboardInterrupt


def _listen(reading: int, heard: list[int]) -> None:
    """Runs beside Cycles, which lets other threads run: Python hears signals in its main thread only."""
    while signals := os.read(reading, 16):
        heard += [number for number in signals if number == signal.SIGINT]
        if len(heard) > 1:
            os._exit(STATUS)
        if heard:
            print("Interrupted: ends with the present step; press again to end at once.",
                  file=sys.stderr, flush=True)
