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

STATUS = 130    # exit status of shells: 128 and the signal's number


@contextmanager
def interrupt_held() -> Iterator[list[int]]:
    """Catch Ctrl-C in the block: the list is then no longer empty, and KeyboardInterrupt is raised at the end of the
    block. A second Ctrl-C ends the process.
    """
    heard: list[int] = []
    # Blender itself has a program's path
    if (bpy.app.binary_path or os.name != "posix" or threading.current_thread() is not threading.main_thread()
            or signal.getsignal(signal.SIGINT) is not signal.default_int_handler):
        yield heard
        return
    reading, writing = os.pipe()
    os.set_blocking(writing, False)
    signal.signal(signal.SIGINT, lambda number, _: heard.append(number))
    earlier = signal.set_wakeup_fd(writing, warn_on_full_buffer=False)
    watcher = threading.Thread(target=_listen, args=(reading,), daemon=True)
    watcher.start()
    try:
        yield heard
    finally:
        signal.set_wakeup_fd(earlier)
        os.close(writing)
        watcher.join()
        os.close(reading)
        # the last, so that nothing is raised before
        signal.signal(signal.SIGINT, signal.default_int_handler)
        if heard:
            raise KeyboardInterrupt


def _listen(reading: int) -> None:
    """Listen in a thread beside Cycles, which lets other threads run. Python handles signals in its main thread only.
    """
    count = 0
    while signals := os.read(reading, 16):
        count += signals.count(signal.SIGINT)
        if count > 1:
            os._exit(STATUS)
        if count:
            print("Interrupted: ends with the present step; press again to end at once.",
                  file=sys.stderr, flush=True)
