"""Bakes of several cameras, view layers and mirrors: each has a sequence of its own."""
from __future__ import annotations

import bpy
import faults
import numpy as np
import parts
import pytest
from baked_frames import FRAMES, add_camera, assert_same, bake, expected, names, operate
from played import generated, played


@pytest.mark.thorough
def test_markers_choose_the_camera(moving, room, tmp_path):
    scene = bpy.context.scene
    second = add_camera("Second", (2.0, -6.0, 1.0), (1.5, 0.0, 0.3))
    for frame, camera in ((1, scene.camera), (3, second)):
        scene.timeline_markers.new(camera.name, frame=frame).camera = camera
    bpy.ops.wm.save_mainfile()
    out = tmp_path / "out"
    assert bake(room, "--output", out, "--light", "0") == 0
    told = played(out / "scene reflections.blend", FRAMES, tmp_path / "played", ["Mirror Reflection"])
    for frame in FRAMES:
        bpy.ops.wm.open_mainfile(filepath=str(moving))
        bpy.context.scene.timeline_markers.clear()
        bpy.context.scene.camera = bpy.data.objects["Second" if frame > 2 else "Camera"]
        assert_same(told, frame, "Mirror Reflection", expected(frame))


@pytest.mark.slow
def test_several_cameras_have_a_sequence_each(moving, room, tmp_path):
    scene = bpy.context.scene
    add_camera("Second", (2.0, -6.0, 1.0), (1.5, 0.0, 0.3))
    for frame, name in ((1, "Camera"), (2, "Second")):
        scene.timeline_markers.new(name, frame=frame).camera = bpy.data.objects[name]
    # a still that is there would show itself besides
    parts.generate()
    parts.select()
    bpy.ops.wm.save_mainfile()
    out = tmp_path / "out"
    assert bake(room, "--output", out, "--light", "0", "--frames", "1-2", "--camera", "Camera", "Second") == 0
    results = ["Mirror Reflection Camera", "Mirror Reflection Second"]
    bpy.ops.wm.open_mainfile(filepath=str(out / "scene reflections.blend"))
    assert [obj.name for obj in bpy.data.objects if obj.reflection_mesh.role == "REFLECTION"] == results
    told = played(out / "scene reflections.blend", [1, 2], tmp_path / "played", results)
    # the markers cut to the second camera, and so to its sequence
    assert [[bool(told[f"{frame} {name} hidden"]) for name in results] for frame in (1, 2)] == [[False, True],
                                                                                               [True, False]]
    for frame, name, camera in zip((1, 2), results, ("Camera", "Second")):
        bpy.ops.wm.open_mainfile(filepath=str(moving))
        bpy.context.scene.timeline_markers.clear()
        bpy.context.scene.camera = bpy.data.objects[camera]
        assert_same(told, frame, name, expected(frame))
    # and each has both frames, whatever the markers say
    wholly = played(out / "scene reflections.blend", [1, 2], tmp_path / "played", results, every=True)
    for name, camera in zip(results, ("Camera", "Second")):
        for frame in (1, 2):
            bpy.ops.wm.open_mainfile(filepath=str(moving))
            bpy.context.scene.timeline_markers.clear()
            bpy.context.scene.camera = bpy.data.objects[camera]
            assert_same(wholly, frame, name, expected(frame))


@pytest.mark.thorough
def test_several_view_layers_have_a_sequence_each(moving, room, tmp_path, capsys):
    """Each shows what it sees, to itself alone; cameras may have theirs in each."""
    scene = bpy.context.scene
    other = parts.add("cube", "Other", size=0.6, location=(-1.0, -1.5, 1.0))
    other.reflection_mesh.role = "DIFFUSE"
    other.data.materials.append(parts.material("Green"))
    collection = bpy.data.collections.new("Others")
    scene.collection.children.link(collection)
    scene.collection.objects.unlink(other)
    collection.objects.link(other)
    scene.view_layers[0].name = "All"
    scene.view_layers.new("One").layer_collection.children["Others"].exclude = True
    add_camera("Second", (2.0, -6.0, 1.0), (1.5, 0.0, 0.3))
    parts.select()
    parts.generate()
    parts.select()
    bpy.ops.wm.save_mainfile()
    sources = {"All": ["Box", "Other"], "One": ["Box"]}
    for cameras in ((), ("Camera", "Second")):
        out = tmp_path / f"out{len(cameras)}"
        more = ("--camera", *cameras) if cameras else ()
        assert bake(room, "--output", out, "--light", "0", "--frames", "2,4", *more, "--view-layer", "All", "One") == 0
        assert "shows them too" not in capsys.readouterr().out
        bpy.ops.wm.open_mainfile(filepath=str(out / "scene reflections.blend"))
        scene = bpy.context.scene
        for frame, layer in ((frame, layer) for frame in (4, 2) for layer in scene.view_layers):
            scene.frame_set(frame)
            with bpy.context.temp_override(view_layer=layer):
                shown = [obj for obj in layer.objects if obj.reflection_mesh.role == "REFLECTION"]
                named = {f"Mirror Reflection {layer.name} {camera}".strip() for camera in cameras or ("",)}
                assert {obj.name for obj in shown} == named
                for obj in [obj for obj in shown if obj.visible_get()]:
                    assert obj.reflection_mesh.camera == (bpy.data.objects["Camera"] if cameras else None)
                    evaluated = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
                    plain = generated(evaluated)["places"]
                    assert {source.object.name for source in obj.reflection_mesh.sources} == set(sources[layer.name])
                    result = made_in(layer)
                    assert np.array_equal(generated(result)["places"], plain)
                    bpy.data.objects.remove(result)
        # cleared they leave nothing
        parts.select()
        bpy.ops.reflection_mesh.clear()
        assert not [item.name for item in bpy.data.collections if "Reflections" in item.name]
        bpy.ops.wm.open_mainfile(filepath=str(moving))
    assert bake(room, "--output", tmp_path / "one", "--light", "0", "--frames", "2", "--view-layer", "One") == 0
    assert "'All' shows them too" in capsys.readouterr().out


def test_the_operator_bakes_cameras_and_view_layers_too(moving, tmp_path):
    """As the command line does; what is open stays as it was."""
    scene, second = bpy.context.scene, add_camera("Second", (2.0, -6.0, 1.0), (1.5, 0.0, 0.3))
    scene.view_layers[0].name = "All"
    scene.view_layers.new("One")
    scene.view_layers.new("Never").use = False
    out, layer = tmp_path / "out", bpy.context.view_layer
    parts.select()
    assert "No camera is selected" in parts.refusal(bpy.ops.reflection_mesh.bake, filepath=str(out),
                                                    cameras="SELECTED")
    parts.select(scene.camera, second)
    operate(out, frames="2", samples=0, cameras="SELECTED", layers="RENDERED")
    assert bpy.context.view_layer == layer
    made = {obj.name: obj for obj in scene.objects if obj.reflection_mesh.role == "REFLECTION"}
    assert set(made) == {f"Mirror Reflection {one} {camera}"
                         for one in ("All", "One") for camera in ("Camera", "Second")}
    assert {name for name, obj in made.items() if obj.name in scene.view_layers["One"].objects} == {
        name for name in made if " One " in name}
    assert len({name for name in names(out) if name.endswith(".usdc")}) == 4


def made_in(layer: bpy.types.ViewLayer) -> bpy.types.Object:
    """What Generate makes of the open frame in a view layer, beside what plays there."""
    playing = [obj for obj in bpy.context.scene.objects if obj.reflection_mesh.role == "REFLECTION"]
    mirror = bpy.data.objects["Mirror"]
    for obj in playing:
        obj.reflection_mesh.mirror = None
    for obj in layer.objects:
        obj.select_set(obj.reflection_mesh.role in {"MIRROR", "DIFFUSE"})
    result = parts.generate()
    for obj in playing:
        obj.reflection_mesh.mirror = mirror
    return result


def test_scene_view_layer_camera_and_frame_of_a_verb(moving, room, tmp_path, capsys):
    """Those that are named, on every verb; what is not there is one sentence."""
    run = room("addon.command_line.verbs").run
    first = bpy.context.scene
    copy = first.copy()
    copy.name, copy.use_fake_user = "Copy", True
    layer = copy.view_layers.new("Other layer")
    add_camera("Second", (2.0, -6.0, 1.0), (1.5, 0.0, 0.3))
    copy.collection.objects.link(bpy.data.objects["Second"])
    for name in ("a", "b"):
        # of two cubes the layer sees one
        collection = bpy.data.collections.new(name)
        copy.collection.children.link(collection)
        cube = bpy.data.objects["Box"].copy()
        cube.name, cube.location = f"Box {name}", (1.0, -1.0, 1.0)
        cube.animation_data_clear()
        collection.objects.link(cube)
    layer.layer_collection.children["b"].exclude = True
    bpy.ops.wm.save_mainfile()
    output = tmp_path / "out.blend"
    assert run(["generate", "--scene", "Copy", "--view-layer", "Other layer", "--camera", "Second", "--frame", "3",
                "--output", str(output)]) == 0
    assert {scene.name: len(scene.objects) for scene in bpy.data.scenes} == {"Scene": 4, "Copy": 7}
    bpy.ops.wm.open_mainfile(filepath=str(output))
    scene, result = bpy.data.scenes["Copy"], bpy.data.objects["Mirror Reflection"]
    assert (scene.camera.name, scene.frame_current, bpy.data.scenes["Scene"].camera.name) == ("Second", 3, "Camera")
    assert {source.object.name for source in result.reflection_mesh.sources} == {"Box", "Box a"}
    for verb in ("generate", "light", "caustics", "compare", "bake", "mirror-uvs", "benchmark"):
        for option, words in (("--scene", "no scene 'None'"), ("--view-layer", "no view layer 'None'"),
                              ("--camera", "no camera 'None'")):
            capsys.readouterr()
            assert run([verb, option, "None", "--output", str(tmp_path / "none.blend")]) == 1
            assert words in faults.one_sentence(capsys.readouterr().err)
    assert run(["bake", "--camera", "Box"]) == 1 and "is no camera" in capsys.readouterr().err


def test_one_frame_by_the_option_that_other_verbs_have(moving, room, tmp_path):
    folder = tmp_path / "frames"
    assert room("addon.command_line").run(["bake", "--frame", "3", "--frames-only", "--output", str(folder)]) == 0
    assert [path.name for path in sorted(folder.glob("*.usdc"))] == ["Mirror_Reflection.0003.usdc"]


def test_names_that_would_be_one_in_files_are_told_apart(moving, room, tmp_path):
    """Spaces are no spaces in files, and some systems take small letters for capital ones."""
    mirror = bpy.data.objects["Mirror"]
    bpy.data.objects["Box"].scale = (6.0, 1.0, 4.0)
    mirror.animation_data_clear()
    mirror.scale, mirror.location = (0.25, 0.25, 1.0), (-1.5, 1.0, 1.0)
    for number, name in enumerate(("Mirror_A", "MIRROR A", "Mirror B")):
        other = mirror.copy()
        other.name, other.location = name, (number - 0.5, 1.2 + 0.3 * number, 1.0)
        bpy.context.scene.collection.objects.link(other)
    mirror.name = "Mirror A"
    cameras = [add_camera(name, (x, -6.0, 1.0), (1.45, 0.0, 0.0))
               for name, x in (("Left eye", -1.0), ("left_eye", 1.0))]
    bpy.ops.wm.save_mainfile()
    out = tmp_path / "out"
    assert bake(room, "--output", out, "--light", "0", "--frames", "1", "--camera",
                *(camera.name for camera in cameras)) == 0
    assert len({name.casefold() for name in names(out)}) == 4 * 2 + 2 + 1
    assert sum(name.startswith("Mirror_B_Reflection_Left_eye_") for name in names(out)) == 1
    bpy.ops.wm.open_mainfile(filepath=str(out / "scene reflections.blend"))
    for obj in bpy.context.scene.objects:
        # those of the camera that does not look too
        obj.hide_viewport = False
    bpy.context.scene.frame_set(1)
    depsgraph, places = bpy.context.evaluated_depsgraph_get(), set()
    for obj in bpy.context.scene.objects:
        if obj.reflection_mesh.role == "REFLECTION":
            mesh, mirror = obj.evaluated_get(depsgraph).data, obj.reflection_mesh.mirror
            at = np.empty(3 * len(mesh.vertices), dtype=np.float32)
            mesh.attributes["position"].data.foreach_get("vector", at)
            at = at.reshape(-1, 3) @ np.array(obj.matrix_world)[:3, :3].T + np.array(obj.matrix_world)[:3, 3]
            assert len(at) and (np.abs(at[:, 1] - mirror.matrix_world.translation.y) < 0.1).all()
            places.add(at.tobytes())
    assert len(places) == 8


def test_two_mirrors_of_one_name_are_refused(moving, tmp_path):
    """A linked one and one of the file's own: frames could not tell whose they are."""
    bpy.data.libraries.write(str(tmp_path / "library.blend"), {bpy.data.objects["Mirror"]})
    with bpy.data.libraries.load(str(tmp_path / "library.blend"), link=True) as (_, wanted):
        wanted.objects = ["Mirror"]
    bpy.context.scene.collection.objects.link(wanted.objects[0])
    bpy.context.view_layer.update()
    told = parts.refusal(bpy.ops.reflection_mesh.bake, filepath=str(tmp_path / "out"))
    assert told == "Two mirrors are called 'Mirror': rename one of them."
    assert not (tmp_path / "out").exists()
