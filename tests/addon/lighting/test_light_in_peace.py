"""While light is made, nothing changes that the user sees: no object, no name, and no sentence in the panel."""
from __future__ import annotations

import bpy
import parts
import pytest
from lamp_scenes import lit_state, principled, scene_of, shader_of

pytestmark = pytest.mark.thorough

SEEN = ("name", "hide_render", "hide_viewport", "is_holdout", "is_shadow_catcher", "visible_camera", "visible_diffuse",
        "visible_glossy", "visible_shadow", "visible_transmission")


def shown() -> dict:
    """Return the state of objects, materials and view layer that viewports and the Outliner show."""
    scene = bpy.context.scene
    objects = {obj.session_uid: [getattr(obj, name) for name in SEEN] + [
        (slot.link, slot.material) for slot in obj.material_slots] + [tuple(map(tuple, obj.matrix_world))]
        for obj in scene.objects}
    layers = [(layer.name, layer.exclude, layer.holdout, layer.indirect_only)
              for layer in bpy.context.view_layer.layer_collection.children]
    return {"objects": objects, "layers": layers, "world": scene.world, "camera": scene.camera,
            "lamps": [(obj.data.energy, obj.data.cycles.max_bounces) for obj in scene.objects if obj.type == "LIGHT"]}


@pytest.mark.parametrize("how", ["plain", "window", "fog", "glass before it", "sunk in"])
def test_nothing_is_seen_of_it(blank, room, how):
    wall = scene_of(blank)
    box = bpy.data.objects["Box"]
    bpy.data.objects["Area"].visible_camera = True
    if how == "fog":
        fog = parts.add("cube", "Fog", size=9.0)
        material = bpy.data.materials.new("Fog")
        material.use_nodes = True
        tree = material.node_tree
        tree.nodes.clear()
        scatter, output = (tree.nodes.new(f"ShaderNode{name}") for name in ("VolumeScatter", "OutputMaterial"))
        tree.links.new(scatter.outputs[0], output.inputs["Volume"])
        fog.data.materials.append(material)
    elif how == "glass before it":
        shader_of(wall.data.materials[0]).inputs["Alpha"].default_value = 0.7
        pane = parts.add("plane", "Pane", size=1.0, location=(0.0, -2.0, 1.0), rotation=(1.5, 0.0, 0.0))
        pane.data.materials.append(principled("Pane", (1.0, 1.0, 1.0), **{"Transmission Weight": 1.0}))
    elif how == "sunk in":
        wall.location.z -= 0.1
    parts.select(box, bpy.data.objects["Floor"], wall)
    result = parts.generate(tolerance=8.0, placement="VIRTUAL" if how == "window" else "LAYERED")
    # of a shadow catcher nothing new is generated
    wall.is_shadow_catcher = how == "shadow catcher"
    blank.view_layer.update()
    before, state = shown(), lit_state()
    freshness = room("addon.freshness")
    stages = []
    for _, stage in room("addon.operators.light").lighting(blank, [result], 1):
        if stage == "Writing":
            continue
        stages.append(str(stage))
        # results are written at the end, in steps
        assert shown() == before, stage
        assert freshness.why_stale(blank, result) == "", stage
    assert "Rendering light" in stages
    assert {name: state[name] for name in ("rays", "worlds", "lights")} == {
        name: lit_state()[name] for name in ("rays", "worlds", "lights")}
    assert [scene.name for scene in bpy.data.scenes] == [blank.scene.name]
