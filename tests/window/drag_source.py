"""A file dragged onto a window with the mouse, as file managers do it: by the protocol Xdnd 5, with nothing but libX11.

    python drag_source.py FILE X Y

drops FILE at X, Y of the screen and ends with status 0 once the window there has read it. The protocol is that of
https://www.freedesktop.org/wiki/Specifications/XDND: the source says by messages where the mouse is, the target
answers, and asks for the file's address as it would for what is pasted.
"""
from __future__ import annotations

import ctypes
import sys
import time
from ctypes import POINTER, byref, c_char_p, c_int, c_long, c_ubyte, c_uint, c_ulong, c_void_p
from pathlib import Path

VERSION = 5
SELECTION_NOTIFY, SELECTION_REQUEST, CLIENT_MESSAGE = 31, 30, 33
LIST = "text/uri-list"
LIMIT = 60.0    # seconds that a window may take to answer: screens without a graphics card draw slowly

Event = c_long * 24     # XEvent: numbers of the size of a pointer, each field in one of its own

x11 = ctypes.CDLL("libX11.so.6")
x11.XOpenDisplay.restype = c_void_p
x11.XOpenDisplay.argtypes = [c_char_p]
x11.XDefaultRootWindow.restype = c_ulong
x11.XDefaultRootWindow.argtypes = [c_void_p]
x11.XInternAtom.restype = c_ulong
x11.XInternAtom.argtypes = [c_void_p, c_char_p, c_int]
x11.XCreateSimpleWindow.restype = c_ulong
x11.XCreateSimpleWindow.argtypes = [c_void_p, c_ulong, c_int, c_int, c_uint, c_uint, c_uint, c_ulong, c_ulong]
x11.XChangeProperty.argtypes = [c_void_p, c_ulong, c_ulong, c_ulong, c_int, c_int, c_void_p, c_int]
x11.XSetSelectionOwner.argtypes = [c_void_p, c_ulong, c_ulong, c_ulong]
x11.XSendEvent.argtypes = [c_void_p, c_ulong, c_int, c_long, c_void_p]
x11.XPending.argtypes = x11.XFlush.argtypes = x11.XCloseDisplay.argtypes = [c_void_p]
x11.XNextEvent.argtypes = [c_void_p, c_void_p]
x11.XFree.argtypes = [c_void_p]
x11.XTranslateCoordinates.argtypes = [c_void_p, c_ulong, c_ulong, c_int, c_int, POINTER(c_int), POINTER(c_int),
                                      POINTER(c_ulong)]
x11.XGetWindowProperty.argtypes = [c_void_p, c_ulong, c_ulong, c_long, c_long, c_int, c_ulong, POINTER(c_ulong),
                                   POINTER(c_int), POINTER(c_ulong), POINTER(c_ulong), POINTER(POINTER(c_ubyte))]
x11.XWarpPointer.argtypes = [c_void_p, c_ulong, c_ulong, c_int, c_int, c_uint, c_uint, c_int, c_int]


class DragSource:
    """A window of its own that nobody sees, which has a file to give."""

    def __init__(self, path: Path) -> None:
        self.display = x11.XOpenDisplay(None)
        assert self.display, "There is no X display."
        self.root = x11.XDefaultRootWindow(self.display)
        self.window = x11.XCreateSimpleWindow(self.display, self.root, 0, 0, 1, 1, 0, 0, 0)
        self.address = (path.resolve().as_uri() + "\r\n").encode()
        x11.XSetSelectionOwner(self.display, self.atom("XdndSelection"), self.window, 0)

    def atom(self, name: str) -> int:
        return x11.XInternAtom(self.display, name.encode(), 0)

    def target_at(self, x: int, y: int) -> int:
        """The window at a place of the screen that says it takes what is dropped."""
        below, child, left, top = self.root, c_ulong(), c_int(), c_int()
        while x11.XTranslateCoordinates(self.display, self.root, below, x, y, byref(left), byref(top), byref(child)):
            assert child.value, f"No window at {x}, {y} takes what is dropped."
            below = child.value
            if self.takes_drops(below):
                return below
        raise AssertionError("The screens of the windows differ.")

    def takes_drops(self, window: int) -> bool:
        kind, width, number, more, value = c_ulong(), c_int(), c_ulong(), c_ulong(), POINTER(c_ubyte)()
        x11.XGetWindowProperty(self.display, window, self.atom("XdndAware"), 0, 1, 0, 0, byref(kind), byref(width),
                               byref(number), byref(more), byref(value))
        x11.XFree(value)
        return bool(kind.value)

    def tell(self, target: int, what: str, *numbers: int) -> None:
        """Send a message; its first number is always who sends it."""
        event = Event(CLIENT_MESSAGE, 0, 1, self.display, target, self.atom(what), 32, self.window, *numbers)
        x11.XSendEvent(self.display, target, 0, 0, byref(event))
        x11.XFlush(self.display)

    def answered(self, what: str) -> list[int]:
        """Wait for a message; meanwhile tell the file's address to whoever asks for it."""
        end, event = time.monotonic() + LIMIT, Event()
        while time.monotonic() < end:
            if not x11.XPending(self.display):
                time.sleep(0.01)
                continue
            x11.XNextEvent(self.display, byref(event))
            kind = event[0] & 0xFFFFFFFF
            if kind == SELECTION_REQUEST:
                self.give(*event[5:10])
            elif kind == CLIENT_MESSAGE and event[5] == self.atom(what):
                return list(event[7:12])
        raise AssertionError(f"The window has not answered with {what} in {LIMIT:.0f} s.")

    def give(self, who: int, selection: int, kind: int, place: int, moment: int) -> None:
        data = ctypes.create_string_buffer(self.address, len(self.address))
        x11.XChangeProperty(self.display, who, place, kind, 8, 0, data, len(self.address))
        event = Event(SELECTION_NOTIFY, 0, 1, self.display, who, selection, kind, place, moment)
        x11.XSendEvent(self.display, who, 0, 0, byref(event))
        x11.XFlush(self.display)

    def drop(self, x: int, y: int) -> None:
        """Come from a little to the left, and let go."""
        target, copies = self.target_at(x, y), self.atom("XdndActionCopy")
        self.tell(target, "XdndEnter", VERSION << 24, self.atom(LIST), 0, 0)
        accepted = 0
        for step in range(20, -1, -1):
            x11.XWarpPointer(self.display, 0, self.root, 0, 0, 0, 0, x - 5 * step, y)
            self.tell(target, "XdndPosition", 0, (x - 5 * step) << 16 | y, 0, copies)
            accepted = self.answered("XdndStatus")[1] & 1
        assert accepted, "The window takes no files."
        self.tell(target, "XdndDrop", 0, 0, 0, 0)
        self.answered("XdndFinished")
        x11.XCloseDisplay(self.display)


if __name__ == "__main__":
    DragSource(Path(sys.argv[1])).drop(int(sys.argv[2]), int(sys.argv[3]))
