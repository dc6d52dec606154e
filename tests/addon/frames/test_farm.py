"""The same command on a farm's machines: tasks in any order, twice, and one of them killed, give the same files."""
from __future__ import annotations

import json
import os
import re
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import bpy
import faults
import parts
import pytest

FARM = faults.ROOT / "farm"
OPENJD = shutil.which("openjd", path=os.pathsep.join((str(Path(sys.executable).parent), os.environ["PATH"])))
NODE = shutil.which("node")
FRAMES = range(1, 6)
needs_openjd = pytest.mark.skipif(OPENJD is None, reason="openjd-cli is not installed")
needs_node = pytest.mark.skipif(NODE is None, reason="there is no JavaScript without Node.js")

# what Flamenco Manager gives to a job type, https://flamenco.blender.org/usage/job-types/
MANAGER = """
const author = { Task: (name, type) => ({ name, type, commands: [], after: [],
                   addCommand(command) { this.commands.push(command); },
                   addDependency(task) { this.after.push(task.name); } }),
                 Command: (name, parameters) => ({ name, parameters }) };
function frameChunker(frames, size) {
    const [first, last] = frames.split("-").map(Number), chunks = [];
    for (let at = first; at <= last; at += size) chunks.push(`${at}-${Math.min(at + size - 1, last)}`);
    return chunks;
}
%s
const tasks = [];
compileJob({ settings: %s, addTask: (task) => tasks.push(task) });
console.log(JSON.stringify({ tasks, settings: JOB_TYPE.settings, label: JOB_TYPE.label }));
"""


@pytest.fixture
def scene(saved_scene) -> Path:
    """The saved scene with a cube that moves, and with settings that jobs need not give."""
    settings = bpy.context.scene.reflection_mesh
    settings.tolerance, settings.light_samples = 2.0, 4
    cube = bpy.data.objects["Box"]
    for frame, place in ((1, (0.0, -1.5, 1.0)), (5, (1.0, -1.0, 1.0))):
        cube.location = place
        cube.keyframe_insert("location", frame=frame)
    for slot in cube.material_slots:
        slot.material = parts.material("Grey", "DIFFUSE")
    bpy.context.scene.frame_set(1)
    bpy.ops.wm.save_mainfile()
    return saved_scene


@pytest.fixture
def blender(tmp_path) -> Path:
    """A program that takes what a farm gives to Blender, and goes by the module: there is no Blender to install in."""
    path = tmp_path / "bin" / "blender"
    path.parent.mkdir()
    path.write_text(f"""#!{sys.executable}
import subprocess, sys
assert sys.argv[1] == "-b" and sys.argv[3:5] == ["--command", "reflection_mesh"], sys.argv
program = {str(faults.ROOT / "addon" / "run_with_bpy.py")!r}
sys.exit(subprocess.call([sys.executable, program, sys.argv[2], *sys.argv[5:]]))
""")
    path.chmod(0o755)
    return path


@pytest.fixture
def wanted(scene, room, tmp_path) -> dict:
    """The files of all frames, baked at once."""
    out = tmp_path / "wanted"
    assert room("addon.command_line").run(["bake", "--frames", "1-5", "--light", "4", "--output", str(out),
                                           "--frames-only"]) == 0
    assert len(files := faults.contents(out)) == 3 * len(FRAMES)
    return files


def frames_in(out: Path) -> dict:
    """The files of frames, without the one that plays them and what a killed process has left."""
    return {name: content for name, content in faults.contents(out).items()
            if not name.endswith(".blend") and not name.startswith("reflection_mesh_")}


def openjd(scene: Path, blender: Path, out: Path, *arguments: str) -> dict:
    parameters = {"SceneFile": scene, "OutputFolder": out, "Frames": "1-5", "FramesPerTask": 2,
                  "Blender": blender}
    asked = [text for name, value in parameters.items() for text in ("-p", f"{name}={value}")]
    return {"args": [OPENJD, "run", str(FARM / "openjd_bake.yaml"), *asked, *arguments], "stdout": subprocess.PIPE,
            "stderr": subprocess.STDOUT, "text": True, "env": {**os.environ, "PYTHONDONTWRITEBYTECODE": "1"}}


@needs_openjd
def test_the_template_is_valid():
    done = subprocess.run([OPENJD, "check", str(FARM / "openjd_bake.yaml")], capture_output=True, text=True,
                          check=False)
    assert done.returncode == 0, done.stdout + done.stderr


@needs_openjd
@pytest.mark.slow
def test_a_job_of_open_job_description(scene, blender, wanted, tmp_path):
    """One task alone and out of order, one twice, one killed half way, and then the job."""
    out = tmp_path / "frames"
    for chunk in ("4-5", "2", "4-5"):
        done = subprocess.run(**openjd(scene, blender, out, "--step", "Bake", "--tasks",
                                       json.dumps([{"Frame": chunk}])), check=False)
        assert done.returncode == 0, done.stdout[-3000:]
    assert frames_in(out) == {name: content for name, content in wanted.items() if re.search("000[245]", name)}
    shutil.rmtree(out)
    direct = [str(blender), "-b", str(scene), "--command", "reflection_mesh", "bake", "--frames", "1-5", "--light", "4",
              "--output", str(out), "--frames-only", "--progress", "OPENJD"]
    with faults.running(args=direct, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                        start_new_session=True) as process:
        assert any(re.match("Saved: '.*0002.usdc'", line) for line in process.stdout)
        os.killpg(process.pid, signal.SIGKILL)
    assert 0 < len(frames_in(out)) < len(wanted)
    done = subprocess.run(**openjd(scene, blender, out, "--step", "Play", "--run-dependencies"), check=False)
    assert done.returncode == 0, done.stdout[-3000:]
    assert frames_in(out) == wanted and (out / "scene reflections.blend").exists()
    progress = [float(found) for found in re.findall(r"openjd_progress: ([\d.]+)$", done.stdout, re.MULTILINE)]
    assert progress and all(0.0 <= percent <= 100.0 for percent in progress)
    assert "openjd_status: " in done.stdout


@pytest.mark.thorough
@needs_openjd
def test_a_job_for_a_camera_and_a_view_layer(scene, blender, room, tmp_path):
    """As the command line bakes by their names."""
    camera = bpy.data.objects["Camera"].copy()
    camera.name, camera.location.x = "Second", camera.location.x + 0.5
    bpy.context.scene.collection.objects.link(camera)
    bpy.context.scene.view_layers.new("Other")
    bpy.ops.wm.save_mainfile()
    wanted, out = tmp_path / "wanted", tmp_path / "frames"
    assert room("addon.command_line").run(["bake", "--frames", "1", "--light", "0", "--output", str(wanted), "--camera",
                                           "Second", "--view-layer", "Other", "--frames-only"]) == 0
    done = subprocess.run(**openjd(scene, blender, out, "-p", "Camera=Second", "-p", "ViewLayer=Other", "-p",
                                   "Samples=0", "--step", "Bake", "--tasks", json.dumps([{"Frame": "1"}])), check=False)
    assert done.returncode == 0, done.stdout[-3000:]
    assert frames_in(out) == faults.contents(wanted)


@pytest.mark.thorough
@needs_openjd
@pytest.mark.parametrize("name", ["Other", "Scene"])
def test_a_job_of_a_scene_that_is_not_the_files_own(scene, blender, room, tmp_path, name):
    """The other scene has no mirror, and a job for it fails; that of the first, which is not the open one, is done."""
    bpy.context.window.scene = bpy.data.scenes.new("Other")
    bpy.ops.wm.save_mainfile()
    done = subprocess.run(**openjd(scene, blender, tmp_path / "frames", "-p", f"Scene={name}", "-p", "Samples=0",
                                   "--step", "Bake", "--tasks", json.dumps([{"Frame": "1"}])), check=False)
    assert (done.returncode == 0) == (name == "Scene"), done.stdout[-3000:]


@pytest.mark.thorough
@needs_openjd
def test_a_job_that_fails_says_so(scene, blender, tmp_path):
    (tmp_path / "frames").write_text("a file, no folder")
    done = subprocess.run(**openjd(scene, blender, tmp_path / "frames", "--step", "Bake"), check=False)
    assert done.returncode != 0 and "cannot be" in done.stdout


@pytest.mark.slow
@needs_node
def test_a_job_of_flamenco(scene, blender, wanted, tmp_path):
    """The tasks that the job type makes, out of order, one twice and one killed half way, and its lines as the worker
    reads them."""
    out = tmp_path / "frames"
    settings = {"frames": "1-5", "chunk_size": 2, "samples": "", "tolerance": "2", "output_folder": str(out),
                "blendfile": str(scene), "scene": "Scene", "view_layer": "", "camera": "", "what": "REFLECTIONS",
                "eyes": ""}
    script = MANAGER % ((FARM / "reflection_mesh_bake.js").read_text(), json.dumps(settings))
    told = json.loads(subprocess.run([NODE, "-e", script], capture_output=True, text=True, check=True).stdout)
    assert {setting["key"] for setting in told["settings"]} == set(settings)
    tasks = {task["name"]: task for task in told["tasks"]}
    assert list(tasks) == ["bake-1-2", "bake-3-4", "bake-5-5", "play"]
    assert tasks["play"]["after"] == ["bake-1-2", "bake-3-4", "bake-5-5"]
    killed = tasks["bake-3-4"]["commands"][0]["parameters"]
    with faults.running(args=[str(blender), "-b", killed["blendfile"], *killed["args"]], stdout=subprocess.PIPE,
                        stderr=subprocess.STDOUT, text=True, start_new_session=True) as process:
        assert any(re.match("Saved: '.*0003.usdc'", line) for line in process.stdout)
        os.killpg(process.pid, signal.SIGKILL)
    assert 0 < len(frames_in(out)) < len(wanted)
    for name in ("bake-5-5", "bake-1-2", "bake-1-2", "bake-3-4", "play"):
        command, = tasks[name]["commands"]
        asked = command["parameters"]
        assert (command["name"], asked["exe"], asked["exeArgs"]) == ("blender-render", "{blender}", "{blenderArgs}")
        done = subprocess.run([str(blender), "-b", *asked["argsBefore"], asked["blendfile"], *asked["args"]],
                              capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        # flamenco/internal/worker/command_blender.go: regexpFileSaved
        saved = {Path(path).name for path in re.findall(r"Saved: '(.*)'", done.stdout) if Path(path).parent == out}
        if name == "bake-5-5":
            assert saved == {file for file in wanted if "0005" in file and not file.endswith(".json")}
    assert frames_in(out) == wanted and saved == {"scene reflections.blend"}


@pytest.mark.slow
@needs_openjd
@needs_node
def test_jobs_of_light_that_mirrors_throw(scene, blender, room, tmp_path):
    """Both templates, with what they are told alone."""
    lamp = bpy.data.objects.new("Lamp", bpy.data.lights.new("Lamp", "POINT"))
    lamp.location, lamp.data.energy = (1.0, -4.0, 2.0), 100.0
    bpy.context.scene.collection.objects.link(lamp)
    bpy.ops.wm.save_mainfile()
    wanted, outs = tmp_path / "wanted", [tmp_path / "one", tmp_path / "other"]
    assert room("addon.command_line").run(["bake", "--what", "CAUSTICS", "--frames", "1-3", "--eyes", "2", "--output",
                                           str(wanted), "--frames-only"]) == 0
    assert len(faults.contents(wanted)) == 6
    done = subprocess.run(**openjd(scene, blender, outs[0], "-p", "Frames=1-3", "-p", "What=CAUSTICS", "-p", "Eyes=2",
                                   "--step", "Play", "--run-dependencies"), check=False)
    assert done.returncode == 0, done.stdout[-3000:]
    settings = {"frames": "1-3", "chunk_size": 2, "samples": "", "tolerance": "", "output_folder": str(outs[1]),
                "blendfile": str(scene), "scene": "Scene", "view_layer": "", "camera": "", "what": "CAUSTICS",
                "eyes": "2"}
    script = MANAGER % ((FARM / "reflection_mesh_bake.js").read_text(), json.dumps(settings))
    for task in json.loads(subprocess.run([NODE, "-e", script], capture_output=True, text=True,
                                          check=True).stdout)["tasks"]:
        command, = task["commands"]
        asked = command["parameters"]
        done = subprocess.run([str(blender), "-b", *asked["argsBefore"], asked["blendfile"], *asked["args"]],
                              capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
    for out in outs:
        assert frames_in(out) == faults.contents(wanted) and (out / "scene caustics.blend").exists()
