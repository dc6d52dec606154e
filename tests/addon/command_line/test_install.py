"""The zip: what it carries, what Blender's own builder and policy checker say, and a life cycle in a fresh Blender."""
import json
import os
import subprocess
import sys
import zipfile
from pathlib import Path

import bpy
import pytest

ROOT = Path(__file__).resolve().parents[3]

LIFE = r"""
import json, os, sys
sys.path.insert(0, os.environ["ROOT"])
import bpy, addon_utils
from tools.extension_zip import PACKAGE, install
from pathlib import Path

def present():
    return [hasattr(bpy.types.Object, "reflection_mesh"), hasattr(bpy.types.Scene, "reflection_mesh"),
            hasattr(bpy.types, "REFLECTION_MESH_OT_generate"), hasattr(bpy.types, "REFLECTION_MESH_OT_clear"),
            hasattr(bpy.types, "REFLECTION_MESH_OT_compare"), hasattr(bpy.types, "REFLECTION_MESH_PT_main")]

def entries():
    functions = getattr(bpy.types.VIEW3D_MT_object.draw, "_draw_funcs", ())
    return sum(function.__module__.startswith(PACKAGE) for function in functions)

path = list(sys.path)
told = {"before": present()}
install(Path(os.environ["ZIP"]))
told["installed"], told["entries"] = present(), entries()
bpy.ops.preferences.addon_disable(module=PACKAGE)
told["disabled"], told["entries_disabled"] = present(), entries()
bpy.ops.preferences.addon_enable(module=PACKAGE)
told["again"], told["entries_again"] = present(), entries()
bpy.ops.mesh.primitive_plane_add(size=20, location=(0, 0, -1.5))
mirror = bpy.context.object
bpy.data.objects["Cube"].select_set(True)
bpy.ops.reflection_mesh.generate()
told["faces"] = len(bpy.context.object.data.polygons)
told["warnings"] = addon_utils._extensions_warnings_get()
told["modules"] = sorted(name for name in sys.modules if name in {"core", "addon", "compat"})
told["path_grew"] = [entry for entry in sys.path if entry not in path and "extensions" in entry]
bpy.ops.preferences.addon_disable(module=PACKAGE)
print("TOLD" + json.dumps(told))
"""


def run_builder(*arguments: str) -> subprocess.CompletedProcess:
    builder = next(Path(bpy.utils.system_resource("SCRIPTS")).glob("addons*/bl_pkg/cli/blender_ext.py"))
    return subprocess.run([sys.executable, str(builder), *arguments], capture_output=True, text=True, check=False)


def test_the_zip_carries_only_what_runs(extension_archive):
    names = zipfile.ZipFile(extension_archive).namelist()
    assert {"blender_manifest.toml", "__init__.py", "addon/__init__.py", "core/__init__.py"} <= set(names)
    others = [name for name in names if not (name.startswith(("addon/", "core/", "manual/"))
                                             or name in {"blender_manifest.toml", "__init__.py", "LICENSE"})]
    assert others == []
    assert all(name.endswith((".py", "/")) for name in names if name.startswith(("addon/", "core/")))
    assert not any("__pycache__" in name for name in names)
    modules = {path.relative_to(ROOT).as_posix()
               for folder in ("addon", "core") for path in (ROOT / folder).rglob("*.py")}
    assert {name for name in names if "/" in name and name.endswith(".py")} == modules


def contents(path: Path) -> dict[str, bytes]:
    with zipfile.ZipFile(path) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def test_blenders_own_builder_packs_the_same(extension_archive, tmp_path):
    """The manual's pages are ours alone: Blender does not know how to make them."""
    done = run_builder("build", "--source-dir", str(ROOT), "--output-dir", str(tmp_path))
    assert done.returncode == 0, done.stdout + done.stderr
    ours = contents(extension_archive)
    assert contents(tmp_path / extension_archive.name) == {name: content for name, content in ours.items()
                                                           if not name.startswith("manual/")}


def test_the_zip_needs_python_alone(extension_archive, tmp_path):
    """Without any installed package: -S leaves out site-packages."""
    done = subprocess.run([sys.executable, "-S", "-m", "tools.extension_zip", str(tmp_path)], cwd=ROOT,
                          capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert contents(tmp_path / extension_archive.name) == contents(extension_archive)


def test_the_validator_is_silent(extension_archive):
    for target in (extension_archive, ROOT):
        done = run_builder("validate", str(target))
        assert done.returncode == 0 and "error" not in (done.stdout + done.stderr).lower()
        assert "warning" not in (done.stdout + done.stderr).lower()


@pytest.mark.feature("installation")
def test_life_cycle_in_a_fresh_blender(extension_archive, tmp_path):
    environment = {**os.environ, "BLENDER_USER_RESOURCES": str(tmp_path / "user"), "ROOT": str(ROOT),
                   "ZIP": str(extension_archive)}
    (tmp_path / "user").mkdir()
    done = subprocess.run([sys.executable, "-c", LIFE], env=environment, cwd=tmp_path, capture_output=True, text=True,
                          check=False)
    assert "Traceback" not in done.stdout + done.stderr, done.stdout + done.stderr
    assert done.returncode == 0, done.stdout + done.stderr
    told = json.loads(done.stdout.split("TOLD")[1].splitlines()[0])
    assert not any(told["before"] + told["disabled"])
    assert all(told["installed"] + told["again"])
    assert (told["entries"], told["entries_disabled"], told["entries_again"]) == (1, 0, 1)
    assert told["faces"] > 0
    assert told["warnings"] == {} and told["modules"] == [] and told["path_grew"] == []
