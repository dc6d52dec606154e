"""Mirrors of one object hierarchy are one mirror: one result, wherever a mirror is meant."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest


@pytest.fixture
def engine(blank) -> list:
    """Three mirrors under an empty, and a ball and a floor that they show."""
    root = bpy.data.objects.new("Engine", None)
    blank.scene.collection.objects.link(root)
    made = [parts.add("uv_sphere", "Tank", segments=16, ring_count=8, radius=0.6, location=(-0.9, 0.0, 1.0)),
            parts.add("cube", "Block", size=0.9, location=(0.3, 0.3, 0.8), rotation=(0.1, 0.2, 0.5)),
            parts.add("cylinder", "Pipe", vertices=16, radius=0.3, depth=1.5, location=(1.2, 0.0, 1.1))]
    made[0].data.shade_smooth()
    chrome = parts.material("Chrome", "GLOSSY")
    middle = bpy.data.objects.new("Rack", None)
    blank.scene.collection.objects.link(middle)
    middle.parent = root
    for obj in made:
        obj.data.materials.append(chrome)
        obj.parent = middle if obj.name == "Pipe" else root
    for obj in (parts.add("uv_sphere", "Ball", radius=0.5, location=(0.2, -2.6, 1.8)),
                parts.add("plane", "Floor", size=12.0)):
        obj.data.materials.append(parts.material(f"Paint {obj.name}"))
    parts.select()
    blank.view_layer.update()
    return made


def results() -> list[bpy.types.Object]:
    return [obj for obj in bpy.context.scene.objects if obj.reflection_mesh.role == "REFLECTION"]


def parts_of(result: bpy.types.Object) -> set:
    return {part.object for part in result.reflection_mesh.parts}


def shown(room) -> np.ndarray:
    """Return the source index that the results show in each pixel, or -1."""
    core, view = room("core"), room("addon.reading").read_view(bpy.context)
    corners, source = [], []
    for obj in results():
        assert obj.matrix_world.to_3x3() == obj.matrix_world.to_3x3().Identity(3)
        corners.append(parts.attribute(obj, "position")[parts.corners(obj)] + np.array(obj.location))
        source.append(parts.attribute(obj, "source_object"))
    corners = np.concatenate(corners)
    drawn = core.draw(view, corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3)).triangle
    return np.where(drawn >= 0, np.concatenate(source)[drawn], -1)


def test_one_hierarchy_has_one_result(engine, room):
    result = parts.generate()
    assert results() == [result] and result.name == "Engine Reflection"
    assert result.reflection_mesh.mirror == bpy.data.objects["Engine"] and parts_of(result) == set(engine)
    joined = shown(room)
    bpy.ops.reflection_mesh.clear()
    assert not results()
    parts.generate(join_parts=False)
    assert {obj.name for obj in results()} == {f"{obj.name} Reflection" for obj in engine}
    assert not any(map(parts_of, results()))
    apart = shown(room)
    assert (apart >= 0).sum() > 2000 and len(np.unique(apart)) == 3
    # the same picture, but for half a pixel at outlines: 8 of 3454
    assert (joined != apart).sum() < 0.004 * (apart >= 0).sum()


def test_who_has_a_result_or_settings_of_its_own_keeps_them(engine):
    tank, block, pipe = engine
    tank.reflection_mesh.own_settings = True
    parts.generate()
    assert {obj.name: parts_of(obj) for obj in results()} == {
        "Tank Reflection": set(), "Engine Reflection": {block, pipe}}
    # whatever the setting is now
    bpy.context.scene.reflection_mesh.join_parts = tank.reflection_mesh.own_settings = False
    parts.select()
    parts.generate()
    assert {obj.name: parts_of(obj) for obj in results()} == {
        "Tank Reflection": set(), "Engine Reflection": {block, pipe}}


def test_a_root_outside_of_the_scene_is_named_by_the_first_part(engine):
    bpy.context.scene.collection.objects.unlink(bpy.data.objects["Engine"])
    result = parts.generate()
    assert result.reflection_mesh.mirror in engine and parts_of(result) == set(engine)


def test_a_mirror_may_be_the_root(engine):
    tank, block, pipe = engine
    block.parent = pipe.parent = tank
    tank.parent = None
    bpy.context.view_layer.update()
    result = parts.generate()
    assert results() == [result] and result.name == "Tank Reflection" and parts_of(result) == set(engine)


@pytest.mark.thorough
@pytest.mark.parametrize("selected", ["Pipe", "Engine", "Engine Reflection", ""])
def test_each_part_means_all_of_it(engine, selected):
    result = parts.generate()
    before, number = len(result.data.vertices), result.session_uid
    tank, block, pipe = engine
    pipe.location.z += 0.2
    if selected:
        parts.select(bpy.data.objects[selected])
    else:
        # with what it is to show
        parts.select(bpy.data.objects["Ball"], bpy.data.objects["Floor"], pipe)
    result = parts.generate()
    assert results() == [result] and result.session_uid == number and len(result.data.vertices) != before
    parts.select(bpy.data.objects[selected] if selected else pipe)
    bpy.ops.reflection_mesh.clear()
    assert not results()


def test_a_part_that_changes_makes_it_stale(engine, room):
    why_stale = room("addon.freshness").why_stale
    result = parts.generate()
    context = bpy.context
    assert why_stale(context, result) == ""
    engine[2].location.x += 0.1
    context.view_layer.update()
    assert why_stale(context, result) == "the mirror has changed"
    bpy.ops.reflection_mesh.update()
    assert why_stale(context, result) == "" and parts_of(result) == set(engine)
    # a part less, and then all
    bpy.context.scene.collection.objects.unlink(engine[2])
    context.view_layer.update()
    assert why_stale(context, result) == "the mirror has changed"
    bpy.ops.reflection_mesh.update()
    assert why_stale(context, result) == ""
    bpy.context.scene.collection.objects.unlink(bpy.data.objects["Engine"])
    context.view_layer.update()
    assert why_stale(context, result) == ""
    for obj in engine[:2]:
        bpy.context.scene.collection.objects.unlink(obj)
    context.view_layer.update()
    assert "its mirror is gone" in why_stale(context, result)


def test_a_hidden_part_comes_back(engine):
    result = parts.generate()
    whole = len(result.data.polygons)
    engine[0].hide_viewport = True
    parts.select(result)
    result = parts.generate()
    assert len(result.data.polygons) < whole and parts_of(result) == set(engine)
    engine[0].hide_viewport = False
    parts.select(result)
    result = parts.generate()
    assert len(result.data.polygons) == whole and results() == [result]


def test_a_new_part_joins(engine):
    result = parts.generate()
    cap = parts.add("cube", "Cap", size=0.4, location=(0.3, -0.2, 1.7))
    cap.data.materials.append(bpy.data.materials["Chrome"])
    cap.parent = bpy.data.objects["Engine"]
    parts.select()
    bpy.context.view_layer.update()
    assert parts.generate() == result and results() == [result] and parts_of(result) == {*engine, cap}


def test_virtual_makes_windows_of_all_parts(engine):
    result = parts.generate(placement="VIRTUAL")
    assert results() == [result] and not any(obj.visible_camera for obj in engine)
    parts.select(engine[0])
    bpy.ops.reflection_mesh.clear()
    assert all(obj.visible_camera for obj in engine)


def test_a_failure_takes_back_what_the_parts_were(engine, room, monkeypatch):
    result = parts.generate()
    engine[2].location.z += 0.2
    bpy.context.view_layer.update()
    before = {obj.name: obj.visible_camera for obj in engine}
    module = room("addon.operators.write_results")

    def fails(*_):
        raise room("core").ReflectionError("No.")
    monkeypatch.setattr(module, "show_previews", fails)
    assert parts.refusal(placement="VIRTUAL") == "No."
    assert parts_of(result) == set(engine) and {obj.name: obj.visible_camera for obj in engine} == before


def test_it_is_judged_by_cycles(engine, tmp_path, room):
    bpy.context.scene.render.resolution_percentage = 50
    parts.generate()
    report = room("addon.faults").finished(room("addon.operators.compare").comparison(bpy.context, str(tmp_path), 1))
    assert report["results"] == ["Engine Reflection"] and set(report["mirrors"]) == {"Tank", "Block", "Pipe"}
    assert report["judged_pixels"] > 1000
    # silhouettes of a coarse ball, where Cycles bends normals, are left out
    assert report["coverage_percent"]["all"] < 0.3 and report["displacement_px"]["p99"] < 0.5


def test_live_follows_and_keeps_it(engine, room):
    import live_scene
    result = parts.generate()
    parts.select()
    with live_scene.switched_on(room) as clock:
        before = result.data.copy()
        engine[1].location.x += 0.15
        assert "exact" in clock.rest()
        assert results() == [result] and parts_of(result) == set(engine)
        assert len(before.vertices) != len(result.data.vertices)


@pytest.mark.thorough
def test_frames_are_baked_for_the_whole(engine, tmp_path):
    """Check that each frame of the one sequence equals the reflection generated there, mattes included."""
    ball, pipe, scene = bpy.data.objects["Ball"], engine[2], bpy.context.scene
    scene.render.resolution_percentage = 50
    for frame, place in ((1, 0.0), (2, 0.3)):
        pipe.location.z = 1.1 + place
        pipe.keyframe_insert("location", frame=frame)
    ball.reflection_mesh.matte = True
    wanted = []
    for frame in (1, 2):
        scene.frame_set(frame)
        result = parts.generate()
        bpy.ops.reflection_mesh.light(samples=1)
        wanted.append((len(result.data.polygons), parts.attribute(result, "Reflection Matte Ball").sum()))
    bpy.ops.reflection_mesh.clear()
    parts.select()
    out = tmp_path / "frames"
    assert bpy.ops.reflection_mesh.bake("EXEC_DEFAULT", filepath=str(out), frames="1-2", samples=1) == {"FINISHED"}
    result, = results()
    assert result.name == "Engine Reflection" and parts_of(result) == set(engine)
    assert len(list(out.glob("*.usdc"))) == 2
    assert "Reflection Matte Output" in result.reflection_mesh.light_material.node_tree.nodes
    shown = []
    for frame in (1, 2):
        scene.frame_set(frame)
        mesh = result.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
        values = np.empty(len(mesh.polygons), dtype=np.float32)
        mesh.attributes["Reflection Matte Ball"].data.foreach_get("value", values)
        shown.append((len(values), values.sum()))
    assert shown == wanted and wanted[0] != wanted[1] and wanted[0][1] > 20


@pytest.mark.slow
def test_each_part_is_lit_by_its_own_material(engine, room):
    """A tint, a texture by the object's own coordinates, and one by its bounds."""
    from lamp_scenes import picture, principled, psnr
    for obj, output in zip(engine, ("", "Object", "Generated")):
        made = principled(obj.name, (0.9, 0.6, 0.3), Metallic=1.0, Roughness=0.0)
        if output:
            tree = made.node_tree
            checks, where = (tree.nodes.new(f"ShaderNode{name}") for name in ("TexChecker", "TexCoord"))
            checks.inputs["Scale"].default_value = 4.0
            checks.inputs["Color1"].default_value = (1.0, 0.9, 0.5, 1.0)
            checks.inputs["Color2"].default_value = (0.2, 0.4, 0.9, 1.0)
            tree.links.new(where.outputs[output], checks.inputs["Vector"])
            shader = next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED")
            tree.links.new(checks.outputs["Color"], shader.inputs["Base Color"])
        obj.data.materials[0] = made
    bpy.context.scene.render.resolution_x, bpy.context.scene.render.resolution_y = 96, 72
    bpy.context.scene.reflection_mesh.depth = 3
    reference, other = picture(room), picture(room, seed=7)
    result = parts.generate()
    assert len(results()) == 1
    parts.select(result)
    bpy.ops.reflection_mesh.light(samples=64)
    # nothing is noisy here: what is left is a fraction of a pixel at outlines (42.5, 56.2 dB)
    assert psnr(other, reference) > 49.0
    assert psnr(picture(room), reference) > 41.0


def test_parts_that_are_shadow_catchers_are_named(engine, room):
    """Check that a part which joins a selected mirror is reported as Generate and Bake Frames leave it out."""
    reading, pipe = room("addon.reading"), engine[2]
    parts.generate()
    pipe.is_shadow_catcher = True
    parts.select(engine[0], bpy.data.objects["Ball"])
    assert reading.choose(bpy.context).caught == reading.shadow_catchers(bpy.context) == [pipe]
