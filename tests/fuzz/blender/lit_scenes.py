"""Lit scenes: a mirror among lit, textured objects, lamps and a world, and how results are lit, drawn from one seed.

Unlike those of `scenes`, they are as an artist would build them, so that a picture of Cycles says what is right.
"""
from __future__ import annotations

from collections.abc import Callable

import bpy
import bmesh
import numpy as np
from mathutils import Euler, Vector

from tests.fuzz.blender.lit_materials import MIRRORS as MATERIALS
from tests.fuzz.blender.lit_materials import SHADE, colour, mirror_material, node, object_material
from tests.fuzz.blender.lit_variations import varied
from tests.fuzz.blender.scene_shapes import chosen
from tests.fuzz.blender.scenes import Scene, select

SIZE = 80      # pixels
SAMPLES = 256  # of its pictures
UNKNOWN = ("blurred",)  # a reflection is sharp
ROOM = 1.2     # the least distance of an object's middle from the way that the camera looks along


def lit_scene(seed: int) -> Scene:
    """Build the scene of a seed, the same every time, in a new empty file."""
    rng = np.random.default_rng((seed, 13))
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    chosen(rng, ["", ""])  # what is drawn after it stays what it is
    shape, mirror = added_object(rng, "Mirror", MIRRORS)
    of, material = mirror_material(rng, UNKNOWN)
    mirror.data.materials.append(material)
    mirror.reflection_mesh.role = "MIRROR"
    names = [str(seed), f"{shape} of {of}"]
    if shape in FLAT:
        mirror.rotation_euler = Euler((np.pi / 2 + rng.uniform(-0.3, 0.2), 0.0, rng.uniform(-0.4, 0.4)))
    mirrors = [mirror]
    if rng.random() < 0.25:
        mirrors.append(_beside(rng))
        names.append("beside a mirror")
    eye = Vector((rng.uniform(-2.0, 2.0), -6.5, rng.uniform(0.3, 2.5)))
    names += [_placed(rng, number, eye, UNKNOWN) for number in range(chosen(rng, [2, 3, 5]))]
    if rng.random() < 0.7:
        names.append("on a floor of " + added_floor(rng, UNKNOWN))
    names += [_lamp(rng, number) for number in range(chosen(rng, [1, 1, 2]))] + [_world(rng), _camera(rng, eye)]
    _rendered(rng)
    options = {"samples": SAMPLES}
    placement = chosen(rng, ["LAYERED", "LAYERED", "SURFACE"])
    rng = np.random.default_rng((seed, 14))  # of what came later: the scenes of all seeds else stay what they are
    if rng.random() < 0.2:
        names.append("in part of " + _second_material(rng, mirror, UNKNOWN))
    if len(mirrors) > 1 and rng.random() < 0.7:
        of, mirrors[1].data.materials[0] = mirror_material(rng, UNKNOWN)
        names.append(f"the other one of {of}")
    names += varied(np.random.default_rng((seed, 15)), mirror, MODIFIERS)
    bpy.context.view_layer.update()
    select(list(bpy.context.scene.objects), mirror)
    return Scene(", ".join([*names, placement]),
                 {"light": options, "generate": {"placement": placement, "depth": len(mirrors)}}, mirrors)


def added_object(rng: np.random.Generator, name: str, kinds: dict) -> tuple[str, bpy.types.Object]:
    """An object of one of some kinds, by what adds each, with colours at its corners; and which kind."""
    kind = chosen(rng, list(kinds))
    kinds[kind](rng)
    obj = bpy.context.object
    obj.name = name
    if obj.type == "MESH":
        if rng.random() < 0.7 and kind not in ANGULAR:
            obj.data.shade_smooth()
        shades = obj.data.color_attributes.new(SHADE, chosen(rng, ["FLOAT_COLOR", "BYTE_COLOR"]),
                                               chosen(rng, ["POINT", "CORNER"]))
        values = np.ones((len(shades.data), 4), dtype=np.float32)
        values[:, :3] = rng.uniform(0.3, 1.0, (len(values), 3))
        shades.data.foreach_set("color", values.ravel())
    return kind, obj


def _second_material(rng: np.random.Generator, mirror: bpy.types.Object, without: tuple[str, ...]) -> str:
    """On the half of the faces that lies to one side."""
    of, material = mirror_material(rng, without)
    mirror.data.materials.append(material)
    middles = np.empty(3 * len(mirror.data.polygons), dtype=np.float32)
    mirror.data.polygons.foreach_get("center", middles)
    along = middles.reshape(-1, 3) @ rng.normal(size=3)
    mirror.data.polygons.foreach_set("material_index", (along > np.median(along)).astype(np.int32))
    return of


def _beside(rng: np.random.Generator) -> bpy.types.Object:
    """A flat mirror of metal, turned to the first one, which shows it."""
    side = chosen(rng, [-1.0, 1.0])
    bpy.ops.mesh.primitive_plane_add(size=2.0, location=(2.6 * side, -0.4, 0.3),
                                     rotation=(np.pi / 2, 0.0, side * rng.uniform(-1.4, -0.9)))
    other = bpy.context.object
    other.name = "Other Mirror"
    other.data.materials.append(mirror_material(rng, tuple(kind for kind in MATERIALS if kind != "metal"))[1])
    other.reflection_mesh.role = "MIRROR"
    return other


def _placed(rng: np.random.Generator, number: int, eye: Vector, without: tuple[str, ...]) -> str:
    """One object before the mirror, beside what the camera sees of that; some of them stand for themselves alone."""
    kind, obj = added_object(rng, f"Object{number}", OBJECTS)
    while True:
        place = Vector((rng.uniform(-3.0, 3.0), rng.uniform(-4.5, 0.0), rng.uniform(-0.8, 2.0)))
        along = eye * max(0.0, min(1.0, place.dot(eye) / eye.dot(eye)))
        if place.length > 1.5 * ROOM and (place - along).length > ROOM:
            break
    obj.location, obj.rotation_euler = place, rng.uniform(-1.5, 1.5, 3).tolist()
    obj.scale = [chosen(rng, [0.5, 0.7, 0.7]) * chosen(rng, [1.0, 1.0, 1.0, -1.0]) for _ in range(3)]
    of, material = object_material(rng, without)
    obj.data.materials.append(material)
    if obj.type == "MESH" and rng.random() < 0.15:
        of, more = f"{of} and ", object_material(rng, without)
        obj.data.materials.append(more[1])
        obj.data.polygons.foreach_set("material_index", rng.integers(0, 2, len(obj.data.polygons)).astype(np.int32))
        of += more[0]
    changed = MODIFIERS[chosen(rng, list(MODIFIERS))](obj) if obj.type == "MESH" and rng.random() < 0.3 else ""
    many = _instanced(rng, obj) if rng.random() < 0.15 else ""
    return " ".join(word for word in (many, changed, kind, "of", of) if word)


def _instanced(rng: np.random.Generator, obj: bpy.types.Object) -> str:
    """Twice, as instances of a collection."""
    place, kit = obj.location.copy(), bpy.data.collections.new("Kit")
    obj.location = (0.0, 0.0, 0.0)
    kit.objects.link(obj)
    bpy.context.scene.collection.objects.unlink(obj)
    for shift in (-0.4, 0.5):
        empty = bpy.data.objects.new("Instance", None)
        empty.instance_type, empty.instance_collection = "COLLECTION", kit
        empty.location = place + Vector((0.0, 0.3 * shift, shift))
        empty.rotation_euler, empty.scale = rng.uniform(-1.0, 1.0, 3).tolist(), 3 * (0.7,)
        bpy.context.scene.collection.objects.link(empty)
    return "instances of"


def added_floor(rng: np.random.Generator, without: tuple[str, ...]) -> str:
    """A wide plane below the mirror; what it is made of."""
    bpy.ops.mesh.primitive_plane_add(size=16.0, location=(0.0, 0.0, -1.6))
    floor = bpy.context.object
    floor.name = "Floor"
    of, material = object_material(rng, without)
    floor.data.materials.append(material)
    return of


def _lamp(rng: np.random.Generator, number: int) -> str:
    kind = chosen(rng, ["POINT", "AREA", "SPOT", "SUN"])
    data = bpy.data.lights.new(f"Lamp{number}", kind)
    data.color = rng.uniform(0.6, 1.0, 3).tolist()
    data.energy = float(rng.uniform(1.0, 3.0)) if kind == "SUN" else float(rng.uniform(150.0, 500.0))
    if kind == "SUN":
        data.angle = 0.05
    elif kind == "AREA":
        data.size = float(rng.uniform(0.5, 2.0))
    else:
        data.shadow_soft_size = float(rng.uniform(0.1, 0.4))
    if kind == "SPOT":
        data.spot_size, data.energy = 1.2, 3.0 * data.energy
    lamp = bpy.data.objects.new(f"Lamp{number}", data)
    bpy.context.scene.collection.objects.link(lamp)
    # before the mirror, above all else, and out of the picture
    lamp.location = (rng.uniform(-4.0, 4.0), rng.uniform(-6.0, -2.0), rng.uniform(4.0, 6.0))
    towards = Vector((rng.uniform(-1.0, 1.0), rng.uniform(-2.0, 0.0), 0.0)) - lamp.location
    lamp.rotation_euler = towards.to_track_quat("-Z", "Y").to_euler()
    return kind.lower() + " lamp"


def _world(rng: np.random.Generator) -> str:
    kind = chosen(rng, ["no world", "a grey world", "a coloured world", "a sky by direction"])
    if kind == "no world":
        return kind
    world = bpy.context.scene.world = bpy.data.worlds.new("World")
    if bpy.app.version < (5, 0, 0):
        world.use_nodes = True
    tree = world.node_tree
    background = next(one for one in tree.nodes if one.type == "BACKGROUND")
    background.inputs["Strength"].default_value = float(rng.uniform(0.2, 0.8))
    background.inputs["Color"].default_value = (0.5, 0.5, 0.5, 1.0) if kind == "a grey world" else colour(rng)
    if kind == "a sky by direction":
        place = tree.nodes.new("ShaderNodeTexCoord").outputs["Generated"]
        share = node(tree, "TexGradient", Vector=place).outputs[0]
        ramp = node(tree, "ValToRGB", Fac=share)
        for stop in ramp.color_ramp.elements:
            stop.color = colour(rng)
        tree.links.new(ramp.outputs[0], background.inputs["Color"])
    return kind


def _camera(rng: np.random.Generator, eye: Vector) -> str:
    data, kind = bpy.data.cameras.new("Camera"), chosen(rng, [*4 * ["perspective"], "orthographic", "shifted"])
    camera = bpy.data.objects.new("Camera", data)
    bpy.context.scene.collection.objects.link(camera)
    bpy.context.scene.camera = camera
    camera.location = eye
    camera.rotation_euler = (-eye).to_track_quat("-Z", "Y").to_euler()
    data.lens = 60.0
    if kind == "orthographic":
        data.type, data.ortho_scale = "ORTHO", 4.0
    elif kind == "shifted":
        data.shift_x, data.shift_y = rng.uniform(-0.1, 0.1, 2).tolist()
    return kind + " camera"


def _rendered(rng: np.random.Generator) -> None:
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
    scene.view_settings.view_transform = "Standard"
    cycles = scene.cycles
    cycles.samples, cycles.use_denoising, cycles.use_adaptive_sampling = SAMPLES, False, False
    # what mirrors throw is noise, behind which all else could hide
    cycles.caustics_reflective = bool(rng.random() < 0.2)


def _subdivided(obj: bpy.types.Object) -> str:
    modifier = obj.modifiers.new("Subdivided", "SUBSURF")
    modifier.levels = modifier.render_levels = 2
    return "subdivided"


def _thick(obj: bpy.types.Object) -> str:
    obj.modifiers.new("Thick", "SOLIDIFY").thickness = 0.2
    return "thick"


def _bevelled(obj: bpy.types.Object) -> str:
    obj.modifiers.new("Bevel", "BEVEL").width = 0.1
    return "bevelled"


def _repeated(obj: bpy.types.Object) -> str:
    obj.modifiers.new("Row", "ARRAY").count = 2
    return "two in a row of"


def _symmetric(obj: bpy.types.Object) -> str:
    obj.modifiers.new("Half", "MIRROR").use_clip = False
    return "mirrored"


def _added(operator: Callable, **options) -> Callable:
    return lambda rng: operator(**options)


def _bowl(rng: np.random.Generator) -> None:
    """Half a ball, seen from inside."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24, radius=1.5)
    obj = bpy.context.object
    mesh = obj.data
    places = np.empty(3 * len(mesh.polygons), dtype=np.float32)
    mesh.polygons.foreach_get("center", places)
    _without(obj, np.flatnonzero(places.reshape(-1, 3)[:, 1] < 0.3))


def _without(obj: bpy.types.Object, faces: np.ndarray) -> None:
    room = bmesh.new()
    room.from_mesh(obj.data)
    room.faces.ensure_lookup_table()
    bmesh.ops.delete(room, geom=[room.faces[number] for number in faces], context="FACES")
    room.to_mesh(obj.data)
    room.free()


def _waves(rng: np.random.Generator) -> None:
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=24, y_subdivisions=24, size=3.2)
    mesh = bpy.context.object.data
    places = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.vertices.foreach_get("co", places)
    x, y, z = places.reshape(-1, 3).T
    z += 0.05 * np.sin(3.0 * x + 1.0) * np.cos(2.5 * y)
    mesh.vertices.foreach_set("co", places)


def _text(rng: np.random.Generator) -> None:
    bpy.ops.object.text_add()
    text = bpy.context.object.data
    text.body, text.extrude, text.size, text.align_x = "Ab", 0.15, 1.5, "CENTER"


def _curve(rng: np.random.Generator) -> None:
    bpy.ops.curve.primitive_bezier_circle_add(radius=0.9)
    bpy.context.object.data.bevel_depth = 0.2


def _metaball(rng: np.random.Generator) -> None:
    bpy.ops.object.metaball_add(radius=1.2)
    balls = bpy.context.object.data
    # renders would show another surface than viewports do, which Generate says
    balls.resolution = balls.render_resolution = 0.2


MESH = bpy.ops.mesh
MIRRORS: dict[str, Callable] = {
    "wall": _added(MESH.primitive_plane_add, size=3.2),
    "disc": _added(MESH.primitive_circle_add, radius=1.6, fill_type="NGON"),
    "waves": _waves,
    "cube": _added(MESH.primitive_cube_add, size=1.8, rotation=(0.2, 0.1, 0.6)),
    "ball": _added(MESH.primitive_uv_sphere_add, segments=48, ring_count=24, radius=1.3),
    "pipe": _added(MESH.primitive_cylinder_add, vertices=48, radius=1.0, depth=2.6),
    "bowl": _bowl,
    "ring": _added(MESH.primitive_torus_add, major_radius=1.0, minor_radius=0.4, major_segments=48, minor_segments=20,
                   rotation=(1.0, 0.3, 0.0)),
    "monkey": _added(MESH.primitive_monkey_add, size=2.4),
}
FLAT = ("wall", "disc", "waves")
OBJECTS: dict[str, Callable] = {
    "cube": _added(MESH.primitive_cube_add, size=1.6),
    "plane": _added(MESH.primitive_plane_add, size=1.8),
    "ball": _added(MESH.primitive_uv_sphere_add, segments=24, ring_count=12),
    "ico ball": _added(MESH.primitive_ico_sphere_add, subdivisions=3),
    "tube": _added(MESH.primitive_cylinder_add, radius=0.7, depth=1.5, end_fill_type="NOTHING"),
    "cone": _added(MESH.primitive_cone_add, vertices=24),
    "ring": _added(MESH.primitive_torus_add, major_radius=0.9, minor_radius=0.35, major_segments=24, minor_segments=10),
    "monkey": _added(MESH.primitive_monkey_add, size=1.6),
    "text": _text, "curve": _curve, "metaball": _metaball,
}
ANGULAR = ("cube", "wall", "disc", "plane")
MODIFIERS: dict[str, Callable] = {"subdivided": _subdivided, "thick": _thick, "bevelled": _bevelled,
                                  "repeated": _repeated, "symmetric": _symmetric}
