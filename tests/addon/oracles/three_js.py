"""Pictures of glTF files by three.js in a headless Chromium: an engine that knows nothing of Blender."""
from __future__ import annotations

import json
import shutil
import struct
import subprocess
import threading
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import bpy
import numpy as np

VIEWER = Path(__file__).parent.parent / "exports" / "viewer"
THREE = Path(__file__).parents[3] / "build" / "viewer" / "node_modules" / "three"
FLAGS = ("--headless", "--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking",
         "--disable-component-update", "--disable-sync", "--disable-dev-shm-usage", "--ignore-gpu-blocklist",
         "--ozone-platform=headless", "--use-gl=angle", "--use-angle=gl-egl")
SECONDS = 240.0     # from which on it is taken to hang
TYPES = {".html": "text/html", ".js": "text/javascript", ".glb": "model/gltf-binary"}


def chromium() -> str | None:
    """Return the path of Chromium; None if there is none."""
    return shutil.which("chromium") or shutil.which("chromium-browser")


def lacks() -> str:
    """Return the reason that pictures cannot be made, in a sentence; an empty string if they can."""
    if chromium() is None:
        return "Chromium is not installed (on Debian: apt-get install chromium)."
    return "" if THREE.is_dir() else "three.js is not installed: run `make viewer`, which needs npm."


def shown(path: Path, size: tuple[int, int], folder: Path) -> np.ndarray:
    """Return what three.js shows of a binary glTF file through its first camera.

    Parameters
    ----------
    path : Path
        The file.
    size : (width, height) in pixels
        The picture is rendered at twice the size and averaged in linear light.
    folder : Path
        For Chromium's own files, and for the picture `three.png` at twice the size.

    Returns
    -------
    picture : (height, width, 4) float32
        Linear light and opacity, from the lowest row up.
    """
    server = _Server(path)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    width, height = (2 * side for side in size)
    address = f"http://127.0.0.1:{server.server_port}/page.html?width={width}&height={height}"
    # a browser that nobody watches ends when its picture is there
    browser = subprocess.Popen([chromium(), *FLAGS, f"--user-data-dir={folder / 'chromium'}", address],
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        assert server.answered.wait(SECONDS), "Chromium sent no picture."
    finally:
        browser.terminate()
        browser.wait()
        server.shutdown()
        server.server_close()
    assert not server.failure, server.failure
    picture = folder / "three.png"
    picture.write_bytes(server.picture)
    return halved(_read(picture))


def materials(path: Path) -> dict[str, dict]:
    """Return the materials in a binary glTF file by their names (Khronos glTF 2.0, 4.4)."""
    whole = path.read_bytes()
    length, = struct.unpack_from("<I", whole, 12)
    return {one["name"]: one for one in json.loads(whole[20:20 + length])["materials"]}


def _read(path: Path) -> np.ndarray:
    """Return a picture of 8 bits as linear light (height, width, 4)."""
    image = bpy.data.images.load(str(path))
    try:
        width, height = image.size
        values = np.empty(width * height * 4, dtype=np.float32)
        image.pixels.foreach_get(values)
    finally:
        bpy.data.images.remove(image)
    values = values.reshape(height, width, 4)
    values[..., :3] = linear(values[..., :3])
    return values


def linear(stored: np.ndarray) -> np.ndarray:
    """Return the light of sRGB values (IEC 61966-2-1)."""
    return np.where(stored <= 0.04045, stored / 12.92, ((stored + 0.055) / 1.055)**2.4)


def halved(picture: np.ndarray) -> np.ndarray:
    height, width, channels = picture.shape
    return picture.reshape(height // 2, 2, width // 2, 2, channels).mean(axis=(1, 3))


class _Server(ThreadingHTTPServer):
    """Gives a page, three.js and one file to a browser, and takes its picture."""

    def __init__(self, path: Path) -> None:
        super().__init__(("127.0.0.1", 0), _Requests)
        self.path, self.answered, self.picture, self.failure = path, threading.Event(), b"", ""


class _Requests(SimpleHTTPRequestHandler):
    server: _Server

    def do_GET(self) -> None:
        name = self.path.split("?")[0]
        file = self.server.path if name == "/scene.glb" else (
            THREE / name.removeprefix("/three/") if name.startswith("/three/") else VIEWER / name.lstrip("/"))
        if not file.is_file():
            self.send_error(404)
            return
        body = file.read_bytes()
        self.send_response(200)
        self.send_header("Content-Type", TYPES.get(file.suffix, "application/octet-stream"))
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def do_POST(self) -> None:
        body = self.rfile.read(int(self.headers["Content-Length"]))
        self.send_response(204)
        self.end_headers()
        if self.path == "/picture":
            self.server.picture = body
        else:
            self.server.failure = body.decode()
        self.server.answered.set()

    def log_message(self, *_) -> None:
        """Say nothing of requests."""
