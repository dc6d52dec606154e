"""Lamps that a mirror shows: seen where nothing stands before them, whatever shape they have, in light that stays with
the objects and in previews."""
from types import SimpleNamespace

import bpy
import numpy as np
import parts
import pytest
from lamp_scenes import picture, scene_of, shader_of
from mathutils import Matrix

LAMPS = {"Square": {"size": 0.8}, "Rectangle": {"shape": "RECTANGLE", "size": 1.0, "size_y": 0.4},
         "Disc": {"shape": "DISK", "size": 0.9}, "Ellipse": {"shape": "ELLIPSE", "size": 1.0, "size_y": 0.5},
         "Spread": {"size": 0.8, "spread": 1.2}, "Point": {"shadow_soft_size": 0.3, "use_soft_falloff": False},
         "Soft point": {"shadow_soft_size": 0.3, "use_soft_falloff": True},
         "Nodes": {"size": 0.8}, "Spot": {"shadow_soft_size": 0.3, "spot_size": 0.5, "spot_blend": 0.6},
         "Scaled spot": {"shadow_soft_size": 0.3, "spot_size": 0.5, "spot_blend": 0.6}, "Sheared": {"size": 0.7}}


def dim_lamp(kind: str, energy: float = 3.0, location=(0.3, -6.6, 1.3), turn=(1.5, 0.1, 0.05)) -> bpy.types.Object:
    """A lamp no brighter than white, behind the eye, that shines on the mirror."""
    bpy.ops.object.light_add(type={"Point": "POINT", "Soft point": "POINT", "Spot": "SPOT",
                                    "Scaled spot": "SPOT"}.get(kind, "AREA"),
                             location=location, rotation=turn)
    made = bpy.context.object
    made.name = "Dim"
    made.scale = (0.5, 2.0, 1.0) if kind == "Scaled spot" else (1.0, 1.0, 1.0)
    if kind == "Sheared":
        made.parent = bpy.data.objects.new("Parent", None)
        placed = made.matrix_basis.copy()
        made.matrix_parent_inverse = placed @ Matrix.Shear("XY", 4, (0.3, 0.2)) @ Matrix.Shear(
            "YZ", 4, (0.6, 0.0)) @ placed.inverted()
    for name, value in LAMPS[kind].items():
        setattr(made.data, name, value)
    made.data.energy, made.data.color = energy, (0.9, 0.6, 0.3)
    if kind == "Nodes":
        made.data.use_nodes = True
        shader = next(node for node in made.data.node_tree.nodes if node.type == "EMISSION")
        shader.inputs["Color"].default_value, shader.inputs["Strength"].default_value = (0.3, 0.6, 1.0, 1.0), 1.5
    return made


def scene_with(context, kind: str) -> bpy.types.Object:
    """The lamp behind the eye, before a dark wall and behind a post; what is reflected shines by itself."""
    wall = scene_of(context, "", "Tint")
    bpy.data.lights.remove(next(iter(bpy.data.lights)))
    back = parts.add("plane", "Back", size=16.0, location=(0.0, -8.0, 1.0), rotation=(-np.pi / 2, 0.0, 0.0))
    post = parts.add("cube", "Post", size=1.0, location=(0.35, -4.0, 1.0))
    post.scale = (0.1, 0.1, 6.0)
    sources = back, post, bpy.data.objects["Box"], bpy.data.objects["Floor"]
    for obj, colour in zip(sources, ((0.05, 0.08, 0.05), (0.1, 0.1, 0.3), (0.4, 0.1, 0.1), (0.2, 0.2, 0.2))):
        paint = parts.material(obj.name)
        paint.node_tree.nodes["Emission"].inputs["Color"].default_value = (*colour, 1.0)
        obj.data.materials.clear()
        obj.data.materials.append(paint)
    lamp = dim_lamp(kind)
    parts.select(*sources, wall)
    context.view_layer.update()
    return lamp


def seen_lamp(lamp: bpy.types.Object, room) -> tuple[np.ndarray, np.ndarray]:
    """What Cycles shows, and which pixels of it a lamp changes."""
    reference = picture(room)
    lamp.visible_glossy = False
    seen = difference(picture(room), reference) > 0.15
    lamp.visible_glossy = True
    assert seen.sum() > 20
    return reference, seen


def difference(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    return np.abs(one - other)[20:-20, 20:-20].max(axis=2)


@pytest.mark.thorough
@pytest.mark.parametrize("kind", LAMPS)
def test_a_preview_has_the_lamps_that_cycles_shows(blank, room, kind):
    reference, seen = seen_lamp(scene_with(blank, kind), room)
    parts.generate(preview=True)
    wrong = difference(picture(room), reference)
    # outlines of half a pixel
    assert np.median(wrong[seen]) < 0.01 and np.quantile(wrong, 0.98) < 0.05


@pytest.mark.thorough
def test_light_on_objects_has_them_too(blank, room):
    reference, seen = seen_lamp(scene_with(blank, "Rectangle"), room)
    parts.generate(tolerance=2.0)
    bpy.ops.reflection_mesh.light(samples=1)
    wrong = difference(picture(room), reference)
    assert np.median(wrong[seen]) < 0.01 and np.quantile(wrong, 0.98) < 0.05


@pytest.mark.thorough
def test_a_lamp_is_light_that_is_still_to_come(blank, room):
    """Where all that is reflected shines by itself, in a plain white mirror, too."""
    lamp = scene_with(blank, "Square")
    shader_of(bpy.data.materials["Silver"]).inputs["Base Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    reference, seen = seen_lamp(lamp, room)
    parts.generate()
    assert difference(picture(room), reference)[seen].min() > 0.1
    bpy.ops.reflection_mesh.light(samples=64)
    assert np.median(difference(picture(room), reference)[seen]) < 0.05


def test_a_blender_without_cycles_has_lamps_too(room):
    """The switches that it adds to lamps are not there then."""
    plain = SimpleNamespace(type="LIGHT", visible_glossy=True, data=SimpleNamespace(type="AREA"))
    assert room("addon.illumination").is_met(plain)


@pytest.mark.thorough
@pytest.mark.parametrize("name", ["visible_glossy", "multiple importance", "far"])
def test_what_the_mirror_does_not_show_is_not_there(blank, room, name):
    lamp = scene_with(blank, "Square")
    if name == "visible_glossy":
        lamp.visible_glossy = False
    elif name == "multiple importance":
        lamp.data.cycles.use_multiple_importance_sampling = False
    else:
        lamp.location.y = -12.0
    blank.view_layer.update()
    reference = picture(room)
    parts.generate(preview=True)
    assert np.quantile(difference(picture(room), reference), 0.98) < 0.05
    # nothing in the material is spent on it
    assert not any(node.type == "ATTRIBUTE" and node.attribute_name == "reflected_position"
                   for material in bpy.data.materials if material.node_tree for node in material.node_tree.nodes)


def test_lamps_that_stand_before_a_face_are_found_and_far_ones_are_not(blank, room):
    """Against points strewn on the faces' beams, from mirror to what they show."""
    rooms = room("addon.lamps.shown_lamps")
    scene_of(blank)
    result = parts.generate()
    rng = np.random.default_rng(8)
    start, end = (parts.attribute(result, name)[parts.corners(result)]
                  for name in ("mirror_position", "reflected_position"))
    weights, along = rng.dirichlet((1.0, 1.0, 1.0), size=(len(start), 200)), rng.random((len(start), 200, 1))
    strewn = (weights @ start * (1.0 - along) + weights @ end * along).reshape(-1, 3)
    near = strewn[rng.integers(len(strewn), size=60)] + rng.normal(scale=0.01, size=(60, 3))
    places = np.concatenate((near, rng.uniform((-6.0, -7.0, -2.0), (6.0, 2.0, 5.0), size=(240, 3))))
    lamps = [rooms.ShownLamp(place, np.eye(3), "BALL", (0.1, 0.1), (1.0, 1.0, 1.0), (-1.0, -1.0), False)
             for place in places]
    away = np.array([np.linalg.norm(strewn - lamp.place, axis=1).min() for lamp in lamps])
    found = set(map(id, rooms.lamps_before(result.data, lamps, [])))
    told = np.array([id(lamp) in found for lamp in lamps])
    assert (away < 0.05).sum() > 20 and told[away < 0.05].all()
    assert (away > 0.6).sum() > 20 and not told[away > 0.6].any()
