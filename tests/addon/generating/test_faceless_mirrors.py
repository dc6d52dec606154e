"""Mirrors of which some have no faces: metaballs that melt together, and curves that others follow."""
from __future__ import annotations

import bpy
import parts
import pytest
from reflected_box import results


@pytest.fixture
def balls(blank) -> list:
    """Two metaballs of one family, and a box."""
    parts.add("cube", "Box", size=1.0, location=(0.0, -2.5, 1.0))
    chrome, made = parts.material("Chrome", "GLOSSY"), []
    for x in (-0.4, 0.4):
        bpy.ops.object.metaball_add(radius=1.0, location=(x, 1.0, 1.0))
        made.append(bpy.context.object)
        made[-1].data.materials.append(chrome)
        if len(made) == 1:
            made[0].data.resolution = made[0].data.render_resolution = 0.3
    parts.select()
    return made


def told(capfd) -> list:
    return [line for line in capfd.readouterr().out.splitlines() if line.startswith("Warning: ")]


def test_metaballs_that_melt_are_one_mirror(balls, capfd):
    # what the basis says is what counts: Blender's own default is another for renders
    assert balls[1].data.resolution != balls[1].data.render_resolution
    capfd.readouterr()
    assert bpy.ops.reflection_mesh.generate("EXEC_DEFAULT") == {"FINISHED"}
    assert results() == [f"{balls[0].name} Reflection"] and told(capfd) == []
    parts.select(balls[1])
    assert parts.refusal() == (f"The mirror '{balls[1].name}' is a part of the metaball '{balls[0].name}': choose that "
                               "instead.")
    parts.select()
    balls[0].data.resolution = 0.2
    assert bpy.ops.reflection_mesh.generate("EXEC_DEFAULT") == {"FINISHED"}
    assert told(capfd) == [f"Warning: Renders show another mesh of '{balls[0].name}' than viewports do, by "
                           f"'{balls[0].data.name}', and what was generated has the viewport's: give both the same "
                           "levels."]


def test_mirrors_without_faces_are_left_out(balls, capfd):
    path = bpy.data.objects.new("Path", bpy.data.curves.new("Path", "CURVE"))
    path.data.materials.append(balls[0].data.materials[0])
    bpy.context.scene.collection.objects.link(path)
    capfd.readouterr()
    assert bpy.ops.reflection_mesh.generate("EXEC_DEFAULT") == {"FINISHED"}
    assert results() == [f"{balls[0].name} Reflection"]
    assert told(capfd) == ["Warning: Left out because it has no faces: 'Path'."]
    parts.select(path)
    assert parts.refusal() == "The mirror 'Path' has no faces: choose an object with faces."
