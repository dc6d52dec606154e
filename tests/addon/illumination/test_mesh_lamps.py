"""Meshes that emit light as lamps: as bright as Cycles has them, whatever their shape."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from caustic_scene import AIM, GLOW, TINT, add_mesh_lamp, aim, glowing, inner, rendered, scene_of
from live_scene import switched_on


@pytest.fixture
def scene(blank):
    floor, mirror, lamp = scene_of()
    bpy.data.objects.remove(lamp)
    blank.scene.cycles.max_bounces = 0
    return floor, mirror


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "eyes"), [("panel", 1), ("panel", 48), ("ball", 1), ("ball", 48), ("box", 48)])
def test_it_is_as_bright_as_the_mesh_behind_a_flat_mirror(scene, tmp_path, kind, eyes):
    """One place is the whole mesh from afar: within a per cent; many are the mesh."""
    floor, mirror = scene
    lamp = add_mesh_lamp(kind)
    parts.select(floor, lamp, mirror)
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT", eyes=eyes) == {"FINISHED"}
    result = bpy.data.objects["Mirror Caustics"]
    record = result.reflection_mesh
    assert (record.lamp, record.eyes, [source.object for source in record.sources]) == (lamp, eyes, [floor])
    bpy.context.scene.cycles.transparent_max_bounces = 512
    lamp.hide_render = True
    light = rendered(tmp_path, 4)
    mirror.hide_render, lamp.hide_render, lamp.visible_camera, result.hide_render = True, False, False, True
    aim(lamp, (2.0 * AIM.x + 0.9, 0.1, 1.8))
    expected = rendered(tmp_path, 256) * TINT
    patch = inner(light)
    # away from where only a part of the lamp is seen in the mirror
    for _ in range(6 if eyes > 1 else 2):
        patch &= np.roll(patch, 1, 0) & np.roll(patch, -1, 0) & np.roll(patch, 1, 1) & np.roll(patch, -1, 1)
    assert patch.sum() > 60
    ratio = light[patch].sum(axis=0) / expected[patch].sum(axis=0)
    assert np.abs(ratio - 1.0).max() < (5e-3 if eyes > 1 else 0.02)


def test_many_places_carry_the_power_of_the_whole(scene, room):
    """From afar, in every direction, as one: what the triangles' areas say."""
    for kind in ("panel", "ball", "box"):
        lamp = add_mesh_lamp(kind)
        bpy.context.view_layer.update()
        depsgraph = bpy.context.evaluated_depsgraph_get()
        for far in np.random.default_rng(4).normal(size=(4, 3)):
            far = 1e4 * far / np.linalg.norm(far)
            eyes = room("addon.illumination").eyes_of(depsgraph, lamp, 400, far[None])
            # a way through a ball enters by one side and leaves by the other, where its own body is in the way
            out = [eye for eye in eyes if kind == "panel" or (eye.axes[:, 2] @ (eye.lamp.place - lamp.location)) < 0.0]
            many = sum(eye.power * eye.share(far[None])[0] for eye in out)
            normal = np.array(lamp.matrix_world.to_3x3().col[2])
            seen = {"panel": 0.09 * abs(far @ normal) / 1e4, "ball": 0.0225 * np.pi * 0.96,
                    "box": 0.09 * max(-(far @ normal) / 1e4, 0.0)}[kind]
            assert np.allclose(many, np.array(GLOW) * seen, rtol=0.04, atol=0.01)
        bpy.data.objects.remove(lamp)


def test_what_is_a_lamp_and_what_is_lit(scene, room):
    floor, mirror = scene
    panel, painted = add_mesh_lamp("panel"), parts.add("plane", "Painted", size=0.4, location=(0.2, 0.5, 0.2))
    painted.data.materials.append(glowing("Picture"))
    tree = painted.active_material.node_tree
    tree.links.new(tree.nodes.new("ShaderNodeTexChecker").outputs["Color"], tree.nodes["Emission"].inputs["Color"])
    parts.select(floor, painted, panel, mirror)
    lamps = room("addon.illumination").chosen_lamps
    assert lamps(bpy.context) == [panel]
    tree.links.new(tree.nodes.new("ShaderNodeBlackbody").outputs["Color"], tree.nodes["Emission"].inputs["Color"])
    assert set(lamps(bpy.context)) == {painted, panel}
    painted.reflection_mesh.role = panel.reflection_mesh.role = "DIFFUSE"
    with pytest.raises(room("core").ReflectionError, match="no lamp"):
        lamps(bpy.context)
    panel.reflection_mesh.role = "AUTO"
    painted.reflection_mesh.role = "AUTO"
    parts.select(panel, mirror)
    assert "nothing but lamps" in parts.refusal(bpy.ops.reflection_mesh.caustics)
    # and what has no role of a lamp is not lit by chance: unselected, it stands in the way alone
    parts.select(floor, mirror)
    assert "no lamp" in parts.refusal(bpy.ops.reflection_mesh.caustics)


def test_its_light_is_there_once_and_comes_back(scene, room):
    floor, mirror = scene
    lamp = add_mesh_lamp("panel")
    parts.select(floor, lamp, mirror)
    before = parts.state()
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    linked = lamp.light_linking.receiver_collection
    assert [child.light_linking.link_state for child in linked.collection_objects] == ["EXCLUDE"]
    assert bpy.ops.reflection_mesh.clear() == {"FINISHED"}
    assert lamp.light_linking.receiver_collection is None and parts.state() == before


def test_live_and_frames_take_them_too(scene, room, tmp_path):
    floor, mirror = scene
    lamp = add_mesh_lamp("panel")
    parts.select(floor, lamp, mirror)
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    result = bpy.data.objects["Mirror Caustics"]

    def light() -> bytes:
        return parts.attribute(result, "caustic_light").tobytes()
    with switched_on(room) as clock:
        for change in (lambda: setattr(lamp.location, "x", -1.0), lambda: setattr(
                lamp.active_material.node_tree.nodes["Emission"].inputs["Strength"], "default_value", 3.0)):
            before = light()
            change()
            assert "exact" in clock.rest() and light() != before
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "scene.blend"))
    out = str(tmp_path / "out")
    assert bpy.ops.reflection_mesh.bake("EXEC_DEFAULT", what="CAUSTICS", frames="1", filepath=out) == {"FINISHED"}
    shown = result.evaluated_get(bpy.context.evaluated_depsgraph_get())
    assert len(shown.data.polygons) and [source.object for source in result.reflection_mesh.sources] == [floor]
