"""Fog in the world, and fog that mirrors stand in: what is seen through it is seen through it once."""
from __future__ import annotations

import bpy
import parts
import pytest
from lamp_scenes import lit_state, outdated, picture, psnr, scene_of, shader_of


def filled(owner, node: str = "ShaderNodeVolumeScatter", density: float = 0.1) -> None:
    """Fill a world, or what a material bounds."""
    if bpy.app.version < (5, 0, 0):
        owner.use_nodes = True
    tree = owner.node_tree
    fog = tree.nodes.new(node)
    fog.inputs["Density"].default_value = density
    tree.links.new(fog.outputs[0], tree.get_output_node("ALL").inputs["Volume"])


def room_of_fog(name: str = "Fog") -> bpy.types.Object:
    """A cube of fog from before the box to behind the mirror; the camera stands before it."""
    cube = parts.add("cube", name, size=6.0, location=(0.0, 0.5, 1.0))
    made = bpy.data.materials.new(name)
    filled(made, density=0.12)
    tree = made.node_tree
    for link in list(tree.get_output_node("ALL").inputs["Surface"].links):
        tree.links.remove(link)
    cube.data.materials.append(made)
    return cube


def in_a_collection(cube: bpy.types.Object) -> None:
    branch = bpy.data.collections.new("Air")
    bpy.context.scene.collection.children.link(branch)
    branch.objects.link(cube)
    bpy.context.scene.collection.objects.unlink(cube)


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "measured"), [
    ("world", 43.0), ("absorbing world", 42.4), ("cube", 43.2), ("cube in a collection", 43.2), ("half open", 41.2)])
def test_fog_before_a_mirror_is_seen_once(blank, room, kind, measured):
    """Cycles against itself has 38.6 to 40.8 dB: a denoised picture is better."""
    mirror = scene_of(blank)
    if "world" in kind:
        filled(blank.scene.world, "ShaderNodeVolumeAbsorption" if "absorbing" in kind else "ShaderNodeVolumeScatter")
    else:
        cube = room_of_fog()
        if "collection" in kind:
            in_a_collection(cube)
        cube.select_set(True)
    if kind == "half open":
        shader_of(mirror.data.materials[0]).inputs["Alpha"].default_value = 0.7
    reference = picture(room)
    result = parts.generate()
    before = lit_state()
    assert bpy.ops.reflection_mesh.light(samples=64) == {"FINISHED"}
    blank.view_layer.update()
    assert not outdated(room, result)
    assert psnr(picture(room), reference) > measured - 2.5
    after = lit_state()
    assert all(after[name] == before[name] for name in ("rays", "worlds", "cycles"))


def test_fog_is_no_object_that_is_reflected(blank, capfd):
    """Its faces would hide what stands in it."""
    mirror = scene_of(blank)
    room_of_fog()
    parts.select(mirror)
    result = parts.generate()
    assert {source.object.name for source in result.reflection_mesh.sources} == {"Box", "Floor"}
    assert "No reflection has hair, point clouds or volumes, as 'Fog' has" in "".join(capfd.readouterr())
