"""The extension as users have it: built as a zip, installed into preferences of its own, tested from there."""
from __future__ import annotations

import importlib
import os
import shutil
import sys
import tempfile
from pathlib import Path
from types import ModuleType

import pytest

from tools import extension_zip

USER_FOLDER = Path(tempfile.mkdtemp(prefix="reflection_mesh_tests_"))
# before anything imports bpy: it reads the place of its preferences once
extension_zip.use_throw_away_preferences(USER_FOLDER)
import bpy  # noqa: E402
import every_feature  # noqa: E402
import live_scene  # noqa: E402
import numpy as np  # noqa: E402
import parts  # noqa: E402

STATUS = pytest.StashKey[int]()
ZIP = extension_zip.build(USER_FOLDER / "zip")
extension_zip.install(ZIP)


def imported(name: str) -> ModuleType:
    """Import a module of the installed extension."""
    return importlib.import_module(f"{extension_zip.PACKAGE}.{name}")


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--every-feature", action="store_true",
                     help="fail if no test uses an operator, a verb or a feature")


def pytest_configure(config: pytest.Config) -> None:
    if config.getoption("--every-feature"):
        config.pluginmanager.register(every_feature.EveryFeature(imported("addon.command_line"),
                                                                 imported("addon.command_line.verbs")))


@pytest.hookimpl(trylast=True)
def pytest_sessionfinish(session: pytest.Session) -> None:
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    bpy.ops.preferences.addon_disable(module=extension_zip.PACKAGE)
    shutil.rmtree(USER_FOLDER, ignore_errors=True)
    session.config.stash[STATUS] = int(session.exitstatus)


@pytest.hookimpl(trylast=True)
def pytest_unconfigure(config: pytest.Config) -> None:
    # bpy may crash at its end, that of 4.2 after any export to glTF, and hide the tests' own exit status
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(config.stash.get(STATUS, 1))


@pytest.fixture(scope="session")
def extension_archive() -> Path:
    """The zip that was installed."""
    return ZIP


@pytest.fixture(scope="session")
def room():
    """Import a module of the installed extension: room("addon.reading.read_view")."""
    return imported


@pytest.fixture
def blank() -> bpy.types.Context:
    """An empty file with a camera at (0, -6, 1) that looks along +Y, 256 x 192 pixels."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    bpy.ops.object.camera_add(location=(0.0, -6.0, 1.0), rotation=(1.45, 0.0, 0.0))
    scene = bpy.context.scene
    scene.camera = bpy.context.object
    scene.render.resolution_x, scene.render.resolution_y = 256, 192
    bpy.ops.object.select_all(action="DESELECT")
    return bpy.context


@pytest.fixture
def scene(blank):
    """A ball that reflects a leaf, and its result: what Live and staleness are tried on."""
    return live_scene.scene_of(blank)


@pytest.fixture
def clock(scene, room):
    """Live switched on in that scene, driven by a clock."""
    with live_scene.switched_on(room) as clock:
        yield clock


@pytest.fixture
def saved_scene(blank, tmp_path) -> Path:
    """A cube before a wall mirror, 96 x 72 pixels, saved in a folder of its own; roles choose who takes part."""
    cube = parts.add("cube", "Box", size=1.0, location=(0.0, -1.5, 1.0))
    cube.data.materials.append(parts.material("Plain"))
    cube.reflection_mesh.role, parts.add_wall_mirror().reflection_mesh.role = "DIFFUSE", "MIRROR"
    blank.scene.render.resolution_x, blank.scene.render.resolution_y = 96, 72
    blank.preferences.filepaths.save_version = 0
    path = tmp_path / "work" / "scene.blend"
    path.parent.mkdir()
    bpy.ops.wm.save_as_mainfile(filepath=str(path), compress=False)
    return path


@pytest.fixture
def moving(blank, tmp_path) -> Path:
    """A cube of two colours that moves before a wall mirror, with a UV map, colours and an attribute, 96 x 72 pixels,
    saved; the mirror moves too."""
    cube = parts.add("cube", "Box", size=1.0, location=(0.0, -1.5, 1.0))
    for name, colour in (("Plain", (0.8, 0.8, 0.8, 1.0)), ("Red one", (1.0, 0.0, 0.0, 1.0))):
        cube.data.materials.append(parts.material(name))
        cube.data.materials[-1].node_tree.nodes["Emission"].inputs[0].default_value = colour
    rng = np.random.default_rng(5)
    for face in cube.data.polygons:
        face.material_index = face.index % 2
    for name, kind, domain, width in (("My Colour", "FLOAT_COLOR", "POINT", 4), ("wet spots", "FLOAT", "FACE", 1),
                                      ("Zähler", "INT", "FACE", 1)):
        entry = cube.data.attributes.new(name, kind, domain)
        values = rng.uniform(-3.0, 1e6, width * len(entry.data))
        entry.data.foreach_set("color" if width == 4 else "value",
                               values.astype(np.int32 if kind == "INT" else np.float32))
    mirror = parts.add_wall_mirror()
    mirror.data.materials.append(parts.material("Glass", "GLOSSY"))
    cube.reflection_mesh.role, mirror.reflection_mesh.role = "DIFFUSE", "MIRROR"
    for obj, frame, place in ((cube, 1, (0.0, -1.5, 1.0)), (cube, 5, (1.2, -1.0, 1.3)),
                              (mirror, 1, (0.0, 1.0, 1.0)), (mirror, 5, (0.0, 1.5, 1.0))):
        obj.location = place
        obj.keyframe_insert("location", frame=frame)
    scene = blank.scene
    scene.render.resolution_x, scene.render.resolution_y = 96, 72
    scene.frame_start, scene.frame_end = 1, 4
    scene.frame_set(1)
    blank.preferences.filepaths.save_version = 0
    path = tmp_path / "work" / "scene.blend"
    path.parent.mkdir()
    bpy.ops.wm.save_as_mainfile(filepath=str(path), compress=False)
    return path
