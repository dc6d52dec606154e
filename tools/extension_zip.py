"""Builds the extension as a zip, with Blender's own builder, and installs it into a throw-away place.

    python -m tools.extension_zip [folder]
"""
from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from .manual_pages import manual_pages

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = "bl_ext.user_default.reflection_mesh"
MANUAL = "manual"  # the folder of its pages


def build(folder: Path) -> Path:
    """Build the zip, with the manual's pages, into `folder` and return its path.

    Raises
    ------
    RuntimeError
        With the builder's own words, where it refuses.
    """
    import bpy
    folder = folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    scripts = Path(bpy.utils.system_resource("SCRIPTS"))
    builder = next(scripts.glob("addons*/bl_pkg/cli/blender_ext.py"))
    for old in folder.glob("reflection_mesh-*.zip"):
        old.unlink()
    command = [sys.executable, str(builder), "build", "--source-dir", str(ROOT), "--output-dir", str(folder)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(f"The extension cannot be built: {done.stdout}{done.stderr}")
    made = next(folder.glob("reflection_mesh-*.zip"))
    with zipfile.ZipFile(made, "a", zipfile.ZIP_DEFLATED) as archive:
        for name, content in manual_pages(ROOT / "docs").items():
            archive.writestr(f"{MANUAL}/{name}", content)
    return made


def use_throw_away_preferences(folder: Path) -> None:
    """Keep preferences and extensions of this process in `folder`; must run before bpy is imported."""
    if "bpy" in sys.modules:
        raise RuntimeError("bpy has been imported already: choose the folder of the preferences first.")
    folder.mkdir(parents=True, exist_ok=True)
    os.environ["BLENDER_USER_RESOURCES"] = str(folder.resolve())


def install(path: Path) -> None:
    """Install the zip into the preferences of this process and switch it on.

    Raises
    ------
    RuntimeError
        Where Blender does not take it.
    """
    import bpy
    bpy.ops.extensions.package_install_files(filepath=str(path), repo="user_default", enable_on_install=True)
    if PACKAGE not in bpy.context.preferences.addons:
        raise RuntimeError(f"Blender did not install {path.name}: see the messages above.")


@contextmanager
def installed() -> Iterator[Path]:
    """The extension as users have it, built and installed into preferences that are thrown away; gives a folder to
    work in, which is thrown away too."""
    with tempfile.TemporaryDirectory(prefix="reflection_mesh_") as name:
        scratch = Path(name)
        use_throw_away_preferences(scratch / "preferences")
        install(build(scratch))
        yield scratch
        switch_off()


def switch_off() -> None:
    """Switch the extension off: bpy may crash at its end, and hide the exit status, where classes are registered."""
    import bpy
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    bpy.ops.preferences.addon_disable(module=PACKAGE)


if __name__ == "__main__":
    print(build(Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "dist")))
