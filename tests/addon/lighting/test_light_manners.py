"""Light leaves all else in the file as it is, says when it is stale, and is taken back; by operators and its verb."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from lamp_scenes import SIZE, leaves_no_trace, lit_state, outdated, picture, plain_scene, psnr, scene_of, shader_of


@pytest.mark.parametrize(("placement", "opaque"), [
    pytest.param("LAYERED", True, marks=pytest.mark.slow), ("VIRTUAL", True),
    pytest.param("LAYERED", False, marks=pytest.mark.slow)])
def test_stopped_after_any_step_it_leaves_no_trace(blank, room, placement, opaque):
    scene_of(blank, "UV", "" if opaque else "Half open")
    result = parts.generate(placement=placement)
    before, lighting = lit_state(), room("addon.operators.light").lighting
    stages = ["Reading the scene", "Writing", "Reading the reflection", "Rendering light"]
    # images are written in several steps
    for stage, times in [*((stage, 1) for stage in stages), *(("Writing", times) for times in (3, 5, 7))]:
        steps = lighting(blank, [result], 1)
        while times:
            times -= next(steps)[1] == stage
        steps.close()
        assert lit_state() == before
    told = [stage for _, stage in lighting(blank, [result], 1)]
    assert list(dict.fromkeys(told)) == stages and lit_state() != before


@pytest.mark.parametrize("failing", ["rendering", "new_material", "show_light", "unwrap"])
def test_an_error_leaves_no_trace(blank, room, monkeypatch, failing):
    where = "addon.lighting.path_sheet" if failing == "rendering" else "addon.operators.made_light"
    leaves_no_trace(blank, room, monkeypatch, (where, failing))


@pytest.mark.parametrize("inner", [False, pytest.param(True, marks=pytest.mark.slow)])
def test_particles_go_on_as_they_are(blank, room, inner):
    """Blender forgets those that are not baked where anything of their object is switched."""
    scene_of(blank)
    emitter, seed = parts.add("plane", "Emitter", size=1.0, location=(0.6, -1.5, 2.5)), bpy.data.objects["Box"]
    emitter.modifiers.new("Particles", "PARTICLE_SYSTEM")
    settings = emitter.particle_systems[0].settings
    settings.count, settings.frame_start, settings.frame_end = 12, 1.0, 6.0
    settings.render_type, settings.instance_object, settings.particle_size = "OBJECT", seed, 0.3
    if inner:
        outer, held = bpy.data.collections.new("Outer"), bpy.data.collections.new("Held")
        blank.scene.collection.children.link(outer)
        outer.children.link(held)
        for obj in (emitter, bpy.data.objects["Floor"]):
            outer.objects.link(obj)
            blank.scene.collection.objects.unlink(obj)
        held.objects.link(seed)
        blank.scene.collection.objects.unlink(seed)
    for frame in range(1, 13):
        blank.scene.frame_set(frame)
    fallen = _instances(blank)
    assert len(fallen) == 12 and np.ptp(fallen[:, 2]) > 0.1
    reference, other = picture(room), picture(room, seed=7)
    parts.select(emitter, seed, bpy.data.objects["Floor"], bpy.data.objects["Mirror"])
    parts.generate()
    bpy.ops.reflection_mesh.light(samples=64)
    assert np.array_equal(_instances(blank), fallen)
    assert psnr(picture(room), reference) > psnr(other, reference)


def _instances(context: bpy.types.Context) -> np.ndarray:
    """Where instances stand, (n, 3)."""
    return np.array([list(one.matrix_world.translation)
                     for one in context.evaluated_depsgraph_get().object_instances if one.is_instance]).reshape(-1, 3)


def test_what_is_lit_is_the_result_alone(blank):
    scene_of(blank)
    result = parts.generate()
    before, materials = parts.state(), [material.name for material in result.data.materials]
    bpy.ops.reflection_mesh.light(samples=1)
    after = parts.state()
    # the mesh keeps the materials of its sources under their names; the object shows the light
    assert [material.name for material in result.data.materials] == materials
    assert {(slot.link, slot.material) for slot in result.material_slots} == {
        ("OBJECT", result.reflection_mesh.light_material)}
    new = {kind: set(names) - set(before["data"][kind]) for kind, names in after["data"].items()}
    assert {kind: names for kind, names in new.items() if names} == {
        "materials": {"Reflection Light"}, "images": {"Reflection Light", "Reflection Light Export"},
        "node_groups": {"Reflection Light Unblurred"}}
    # what the mirror shows of the world is on faces of its own
    del after["objects"][result.name], before["objects"][result.name]
    assert {**after, "data": 0} == {**before, "data": 0}
    image = bpy.data.images["Reflection Light"]
    assert image.packed_file is not None and image.size[0] <= 2 * SIZE


def test_what_emits_in_a_plain_mirror_is_lit_if_asked(blank):
    mirror = plain_scene()
    result = parts.generate()
    assert bpy.ops.reflection_mesh.light(samples=1) == {"FINISHED"}
    assert result.reflection_mesh.light_material is not None
    mirror.data.materials[0].node_tree.nodes[0].inputs["Color"].default_value = (0.8, 0.9, 1.0, 1.0)
    bpy.ops.reflection_mesh.light(samples=1)
    assert result.reflection_mesh.light_material is not None


def into_collection(scene, name, objects):
    """Move objects of the scene to a collection of their own."""
    collection = bpy.data.collections.new(name)
    scene.collection.children.link(collection)
    for obj in objects:
        collection.objects.link(obj)
        scene.collection.objects.unlink(obj)


def layer_of(scene, name):
    return scene.view_layers[0].layer_collection.children[name]


@pytest.mark.parametrize(("change", "stale", "shown"), [
    (lambda scene: setattr(bpy.data.objects["Box"].location, "x", 0.5), True, False),
    (lambda scene: setattr(scene.camera.location, "x", 0.5), True, True),
    (lambda scene: setattr(scene.camera.data, "lens", 45.0), True, True),
    (lambda scene: setattr(next(iter(bpy.data.lights)), "energy", 10.0), True, False),
    (lambda scene: setattr(shader_of(bpy.data.materials["Source"]).inputs["Roughness"], "default_value", 0.2), True,
     False),
    (lambda scene: bpy.data.objects.remove(next(obj for obj in scene.objects if obj.type == "LIGHT")), True, False),
    (lambda scene: setattr(next(obj for obj in scene.objects if obj.type == "LIGHT"), "hide_render", True), True,
     False),
    (lambda scene: setattr(bpy.data.collections["Lamps"], "hide_render", True), True, False),
    (lambda scene: setattr(layer_of(scene, "Lamps"), "exclude", True), True, False),
    (lambda scene: scene.frame_set(scene.frame_current + 1), False, True),
    (lambda scene: bpy.data.objects["Box"].select_set(False), False, True),
])
def test_light_is_stale_when_the_scene_has_changed(blank, room, change, stale, shown):
    scene_of(blank)
    into_collection(blank.scene, "Lamps", [obj for obj in blank.scene.objects if obj.type == "LIGHT"])
    result = parts.generate(tolerance=4.0)
    bpy.ops.reflection_mesh.light(samples=1)
    light = result.reflection_mesh.light_material
    change(blank.scene)
    blank.view_layer.update()
    assert outdated(room, result) == stale
    parts.select(result)
    parts.generate(tolerance=2.0)
    # light of points that are seen from elsewhere stays; other light is not shown
    assert {slot.material == light for slot in result.material_slots} == {shown}
    assert outdated(room, result) == stale
    bpy.ops.reflection_mesh.light(samples=1)
    assert not outdated(room, result) and len(bpy.data.materials) == 4


def test_frames_are_lit_by_no_lamp_that_renders_leave_out(blank, room):
    """By its own switch or its collection's: either tells as much."""
    scene_of(blank)
    lamp = next(obj for obj in blank.scene.objects if obj.type == "LIGHT")
    into_collection(blank.scene, "Lamps", [lamp])
    digest = room("addon.freshness.lamps").lamps_of
    shown = digest(blank)
    told = []
    for what in (lamp, bpy.data.collections["Lamps"]):
        what.hide_render = True
        told.append(digest(blank))
        what.hide_render = False
    assert told[0] == told[1] != shown == digest(blank)


def test_light_that_was_kept_shows_the_same(blank, room):
    scene_of(blank, "UV", "Tint")
    result = parts.generate(tolerance=2.0)
    bpy.ops.reflection_mesh.light()
    first = picture(room)
    parts.select(result)
    parts.generate(tolerance=0.5)
    assert psnr(picture(room), first) > 80.0


def test_the_panel_tells_what_there_is_to_do(blank, room):
    scene_of(blank)
    told = room("addon.lighting").light_sentence
    result = parts.generate()
    assert told(result, False) == "Not lit yet. Click Light Reflection."
    bpy.ops.reflection_mesh.light(samples=1)
    assert told(result, outdated(room, result)) == "Lit."
    bpy.data.objects["Box"].location.x += 0.1
    assert told(result, outdated(room, result)) == (
        "The scene has changed since the reflection was lit. Click Light Reflection.")
    # light that no longer fits is not shown
    parts.select(result)
    parts.generate()
    assert told(result, outdated(room, result)) == "Not lit yet. Click Light Reflection."


def test_clear_takes_the_light_away(blank):
    scene_of(blank)
    before = parts.state()
    for lit in (True, False):
        parts.generate()
        if lit:
            bpy.ops.reflection_mesh.light(samples=1)
            parts.generate()
        bpy.ops.reflection_mesh.clear()
        after = parts.state()
        assert after["data"] == before["data"] and after["render"] == before["render"]
        parts.select(*(bpy.data.objects[name] for name in ("Box", "Floor", "Mirror")))


def test_the_verb_light(saved_scene, room, tmp_path, capsys):
    run = room("addon.command_line.verbs").run
    output = tmp_path / "lit.blend"
    assert run(["light", "--samples", "1"]) == 1
    assert "no reflection to light" in capsys.readouterr().err
    assert run(["generate", "--light", "2", "--output", str(output)]) == 0
    told = capsys.readouterr().out
    assert "lit in" in told and "not lit" not in told
    bpy.ops.wm.open_mainfile(filepath=str(output))
    result = bpy.data.objects["Mirror Reflection"]
    assert result.reflection_mesh.light_material is not None and not outdated(room, result)
    assert result.material_slots[0].material == result.reflection_mesh.light_material
    assert run(["light", "--samples", "0"]) == 1
    assert run(["light", "--samples", "1"]) == 0
