"""Build the extension as a zip, with Python's own modules alone, and install it into a throw-away place.

    python -m tools.extension_zip [folder]
"""
from __future__ import annotations

import os
import sys
import tempfile
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from fnmatch import fnmatch
from pathlib import Path
from typing import Any

from .manual_pages import manual_pages

ROOT = Path(__file__).resolve().parent.parent
MANIFEST = "blender_manifest.toml"
PACKAGE = "bl_ext.user_default.reflection_mesh"
MANUAL = "manual"  # the folder of its pages


def build(folder: Path) -> Path:
    """Build the zip into `folder` and return its path.

    It contains what Blender's `extension build` packs (a test compares them), and the manual's pages.
    """
    manifest = read_manifest()
    folder = folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.glob(f"{manifest['id']}-*.zip"):
        old.unlink()
    made = folder / f"{manifest['id']}-{manifest['version']}.zip"
    with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED) as archive:
        for path in packed_files(ROOT, manifest["build"]["paths_exclude_pattern"]):
            archive.write(path, path.relative_to(ROOT).as_posix())
        for name, content in manual_pages(ROOT / "docs").items():
            archive.writestr(f"{MANUAL}/{name}", content)
    return made


def read_manifest() -> dict[str, Any]:
    """Return the extension's manifest.

    Raises
    ------
    SystemExit
        If this Python cannot read it.
    """
    try:
        import tomllib
    except ImportError:
        sys.exit(f"Python {sys.version.split()[0]} cannot read {MANIFEST}: use Python 3.11 or newer.")
    return tomllib.loads((ROOT / MANIFEST).read_text(encoding="utf-8"))


def packed_files(folder: Path, patterns: list[str], root: Path | None = None) -> Iterator[Path]:
    """Yield the files below `folder` that no pattern excludes.

    A pattern follows .gitignore: with a slash in front it means paths below `root` alone, with one behind only folders.
    """
    root = root or folder
    for path in sorted(folder.iterdir()):
        if any(_excludes(pattern, path, root) for pattern in patterns):
            continue
        if path.is_dir():
            yield from packed_files(path, patterns, root)
        else:
            yield path


def _excludes(pattern: str, path: Path, root: Path) -> bool:
    if pattern.endswith("/") and not path.is_dir():
        return False
    name = path.relative_to(root).as_posix() if pattern.startswith("/") else path.name
    return fnmatch(name, pattern.strip("/"))


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
