"""Mirrors in mirrors in Blender: against Cycles that follows as many reflections."""
import json

import bpy
import numpy as np
import pytest
from parts import add, attribute, generate, material, refusal, select

SIZE = 256


@pytest.fixture
def corner(blank):
    """Two mirrors that meet in a corner before the camera, a box and a ball between them; (mirrors, diffuse)."""
    scene = bpy.context.scene
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    glossy = material("Glossy", "GLOSSY")
    back = add("plane", "Back", size=4.0, location=(0.0, 2.0, 1.2), rotation=(np.pi / 2, 0.0, 0.0))
    side = add("plane", "Side", size=4.0, location=(2.0, 0.0, 1.2), rotation=(0.0, -np.pi / 2, 0.0))
    for mirror in (back, side):
        mirror.data.materials.append(glossy)
    box = add("cube", "Box", size=0.8, location=(0.4, -0.2, 0.6), rotation=(0.0, 0.0, 0.4))
    ball = add("uv_sphere", "Ball", radius=0.4, location=(-0.7, 0.4, 0.9))
    for number, obj in enumerate((box, ball)):
        obj.data.materials.append(material(f"Diffuse {number}"))
    scene.camera.location = (-1.8, -5.0, 2.2)
    scene.camera.rotation_euler = (1.35, 0.0, -0.38)
    bpy.context.view_layer.update()
    return [back, side], [box, ball]


def compared(folder) -> dict:
    assert bpy.ops.reflection_mesh.compare("EXEC_DEFAULT", filepath=str(folder), samples=1) == {"FINISHED"}
    return json.loads((folder / "report.json").read_text(encoding="utf-8"))


@pytest.mark.feature("several bounces")
def test_two_bounces_are_what_cycles_shows(corner, tmp_path):
    mirrors, diffuse = corner
    left_out = {}
    for depth in (1, 2):
        select(*diffuse, *mirrors)
        generate(depth=depth)
        report = compared(tmp_path / str(depth))
        left_out[depth] = report["left_out_mirror_in_mirror"]
        assert report["displacement_px"]["p99"] < 0.5
        assert report["coverage_percent"]["all"] < 0.4
    # what was a mirror in a mirror is judged at the second bounce
    assert left_out[2] < 0.2 * left_out[1]
    results = [obj for obj in bpy.context.scene.objects if obj.reflection_mesh.role == "REFLECTION"]
    assert len(results) == 2
    for result in results:
        bounces = attribute(result, "bounces")
        assert set(np.unique(bounces)) == {1, 2}
        assert (attribute(result, "source_object") >= 0).all()


def test_mirrors_hide_the_scene_behind_them(corner, tmp_path):
    mirrors, diffuse = corner
    # a third ball behind the mirror at the side can be seen in the other mirror only through it
    behind = add("uv_sphere", "Behind", radius=0.5, location=(3.2, 0.2, 1.0))
    behind.data.materials.append(material("Diffuse Behind"))
    select(behind, *diffuse, *mirrors)
    generate()
    report = compared(tmp_path)
    assert report["coverage_percent"]["all"] < 0.4
    back = next(obj for obj in bpy.context.scene.objects if obj.reflection_mesh.mirror == mirrors[0])
    names = [source.object.name for source in back.reflection_mesh.sources]
    assert names.index("Behind") not in attribute(back, "source_object")


def test_points_follow_one_bounce_and_say_so(corner):
    mirrors, diffuse = corner
    select(*diffuse, *mirrors)
    assert "one bounce" in refusal(method="POINTS", depth=2)
