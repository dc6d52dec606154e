"""What the user has joined to a result outlasts it."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from caustic_scene import scene_of


def places(obj: bpy.types.Object) -> np.ndarray:
    """Of an object's vertices, in the world, in one order for all."""
    found = np.array([obj.matrix_world @ vertex.co for vertex in obj.data.vertices])
    return found[np.lexsort(found.round(4).T)]


def join_a_cube(result: bpy.types.Object) -> np.ndarray:
    """A red cube, joined to a result; where its vertices are."""
    cube = parts.add("cube", "Precious", location=(3.0, 3.0, 3.0), rotation=(0.3, 0.0, 0.2))
    cube.data.materials.append(parts.material("Red", "DIFFUSE"))
    bpy.context.view_layer.update()
    where = places(cube)
    parts.select(cube, result)
    bpy.ops.object.join()
    bpy.context.view_layer.update()
    assert len(result.data.vertices) > 8 and "Precious" not in bpy.data.objects
    return where


def is_the_cube(obj: bpy.types.Object, where: np.ndarray) -> None:
    bpy.context.view_layer.update()
    assert np.allclose(places(obj), where, atol=1e-5)
    assert len(obj.data.polygons) == 6 and len(obj.data.edges) == 12
    assert [material.name for material in obj.data.materials] == ["Red"]
    assert obj.reflection_mesh.role == "AUTO" and obj.visible_get() and obj.visible_glossy
    assert "reflected_position" not in obj.data.attributes and not obj.data.validate()


@pytest.mark.parametrize("how", ["again", "lit before", "of points", "cleared"])
def test_it_is_an_object_again(scene, capfd, how):
    result, options = scene.result, {}
    if how == "of points":
        options["method"] = "POINTS"
        parts.select(result)
        assert parts.generate(**options) == result and result.reflection_mesh.points
    if how == "lit before":
        scene.leaf.data.materials.append(parts.material("Green", "DIFFUSE"))
        parts.select(result)
        parts.generate()
        assert bpy.ops.reflection_mesh.light(samples=1) == {"FINISHED"}
    faces = result.reflection_mesh.faces
    where = join_a_cube(result)
    capfd.readouterr()
    parts.select(result)
    if how == "cleared":
        bpy.ops.reflection_mesh.clear()
        assert "Ball Reflection" not in bpy.data.objects
    else:
        assert parts.generate(**options) == result and result.reflection_mesh.faces == faces
        assert ("What was joined to 'Ball Reflection' is an object of its own again: 'Ball Reflection Joined'."
                in capfd.readouterr().out)
    is_the_cube(bpy.data.objects["Ball Reflection Joined"], where)
    if how != "cleared":
        parts.select(result)
        parts.generate()
        assert [obj.name for obj in bpy.data.objects if "Joined" in obj.name] == ["Ball Reflection Joined"]


def join_wire(result: bpy.types.Object) -> np.ndarray:
    """A bent wire and a loose point, joined to a result; where their vertices are."""
    mesh = bpy.data.meshes.new("Wire")
    mesh.from_pydata([(3.0, 0.0, 1.0), (3.0, 1.0, 2.0), (2.0, 1.0, 2.5), (4.0, 4.0, 4.0)], [(0, 1), (1, 2)], [])
    wire = bpy.data.objects.new("Wire", mesh)
    bpy.context.scene.collection.objects.link(wire)
    wire.location.z = 0.5
    bpy.context.view_layer.update()
    where = places(wire)
    parts.select(wire, result)
    bpy.ops.object.join()
    bpy.context.view_layer.update()
    return where


@pytest.mark.parametrize("what", ["wire", "wire and faces"])
@pytest.mark.parametrize("method", ["GENERAL", "POINTS"])
def test_wire_and_loose_points_are_an_object_again(scene, capfd, what, method):
    result, faces = scene.result, 0
    parts.select(result)
    parts.generate(method=method)
    own = len(result.data.vertices), len(result.data.edges), len(result.data.polygons)
    where = join_wire(result)
    if what == "wire and faces":
        where, faces = np.concatenate((where, join_a_cube(result))), 6
        where = where[np.lexsort(where.round(4).T)]
    capfd.readouterr()
    parts.select(result)
    assert parts.generate(method=method) == result
    assert (len(result.data.vertices), len(result.data.edges), len(result.data.polygons)) == own
    assert "'Ball Reflection Joined'" in capfd.readouterr().out
    freed = bpy.data.objects["Ball Reflection Joined"]
    bpy.context.view_layer.update()
    assert np.allclose(places(freed), where, atol=1e-5)
    assert (len(freed.data.edges), len(freed.data.polygons)) == (2 + 2 * faces, faces)
    parts.select(result)
    parts.generate(method=method)
    assert [obj.name for obj in bpy.data.objects if "Joined" in obj.name] == ["Ball Reflection Joined"]


def test_what_was_drawn_out_of_a_result_is_no_object(scene):
    """It hangs on the result's own vertices, and goes with them."""
    result = scene.result
    result.data.vertices.add(1)
    result.data.edges.add(1)
    result.data.edges[-1].vertices = (0, len(result.data.vertices) - 1)
    result.data.update()
    parts.select(result)
    parts.generate()
    assert not [obj.name for obj in bpy.data.objects if "Joined" in obj.name]


def test_it_is_an_object_again_where_frames_are_baked(scene, capfd, tmp_path):
    where = join_a_cube(scene.result)
    parts.select(scene.result)
    capfd.readouterr()
    assert bpy.ops.reflection_mesh.bake(filepath=str(tmp_path), frames="1-2", samples=0) == {"FINISHED"}
    assert "'Ball Reflection Joined'" in capfd.readouterr().out
    is_the_cube(bpy.data.objects["Ball Reflection Joined"], where)


def test_a_generation_that_fails_leaves_the_join_as_it_was(scene, room, monkeypatch):
    join_a_cube(scene.result)

    def fails(*_):
        raise MemoryError
    monkeypatch.setattr(room("addon.operators.write_results"), "show_previews", fails)
    count = len(scene.result.data.polygons)
    parts.select(scene.result)
    parts.refusal()
    assert len(scene.result.data.polygons) == count


def test_faces_that_were_divided_are_no_object(scene):
    """They go with the faces that they were made of, as the docs say."""
    parts.select(scene.result)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.subdivide()
    bpy.ops.object.mode_set(mode="OBJECT")
    assert len(scene.result.data.polygons) > scene.result.reflection_mesh.faces
    parts.generate()
    assert not [obj.name for obj in bpy.data.objects if "Joined" in obj.name]


def test_points_that_were_made_a_mesh_are_no_join(scene):
    parts.select(scene.result)
    parts.generate(method="POINTS")
    bpy.ops.object.convert(target="MESH")
    assert len(scene.result.data.vertices) > scene.result.reflection_mesh.points
    parts.generate(method="POINTS")
    assert not [obj.name for obj in bpy.data.objects if "Joined" in obj.name]


@pytest.mark.parametrize("cleared", [False, True])
def test_what_was_joined_to_light_is_an_object_again(blank, capfd, cleared):
    floor, mirror, lamp = scene_of()
    parts.select(floor, lamp, mirror)
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    light = bpy.data.objects["Mirror Caustics"]
    faces, where = len(light.data.polygons), join_a_cube(light)
    parts.select(light)
    capfd.readouterr()
    if cleared:
        assert bpy.ops.reflection_mesh.clear() == {"FINISHED"}
        assert "Mirror Caustics" not in bpy.data.objects
    else:
        assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
        assert "'Mirror Caustics Joined'" in capfd.readouterr().out and len(light.data.polygons) == faces
    bpy.context.view_layer.update()
    freed = bpy.data.objects["Mirror Caustics Joined"]
    assert np.allclose(places(freed), where, atol=1e-5) and len(freed.data.polygons) == 6
    assert [material.name for material in freed.data.materials] == ["Red"]
