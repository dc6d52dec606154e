"""Meshes with every defect, made in Blender: a mesh that Blender finds nothing to mend in, or one sentence."""
import bpy
import numpy as np
import parts
import pytest

from tests.inputs import hard_meshes

FAMILIES = 3  # seeds for each defect


def object_of(name: str, mesh, smooth: bool) -> bpy.types.Object:
    """The triangles as they are, with loose edges and vertices beside them."""
    made = bpy.data.meshes.new(name)
    finite = np.where(np.isfinite(mesh.positions), mesh.positions, 0.0)
    count = len(finite)
    made.from_pydata([*finite.tolist(), (3.0, 0.0, 3.0), (3.0, 0.1, 3.0)], [(count, count + 1)],
                     mesh.triangles.tolist(), shade_flat=not smooth)
    return linked(name, made)


def linked(name: str, mesh: bpy.types.Mesh) -> bpy.types.Object:
    obj = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(obj)
    return obj


def assert_sound(result: bpy.types.Object) -> None:
    """Blender mends nothing, no number is missing, and no two faces are one."""
    mesh = result.data
    for attribute in mesh.attributes:
        if attribute.data_type in {"FLOAT", "FLOAT_VECTOR", "FLOAT2"}:
            field, width = {"FLOAT": ("value", 1), "FLOAT_VECTOR": ("vector", 3), "FLOAT2": ("vector", 2)}[
                attribute.data_type]
            values = np.empty(len(attribute.data) * width, dtype=np.float32)
            attribute.data.foreach_get(field, values)
            assert np.isfinite(values).all(), attribute.name
    if mesh.polygons:
        corners = np.sort(parts.corners(result), axis=1)
        assert (corners[:, 1:] != corners[:, :-1]).all()
        assert len(np.unique(corners, axis=0)) == len(corners)
    assert not mesh.validate_material_indices()
    assert not mesh.validate(verbose=True)


def generated_or_refused(mirror, scene, **options) -> bool:
    """Whether there is a result, a sound one; else the operator must have refused with one sentence."""
    bpy.context.view_layer.update()
    parts.select(scene, mirror)
    try:
        bpy.ops.reflection_mesh.generate("EXEC_DEFAULT", tolerance=2.0, **options)
    except RuntimeError as error:
        message = str(error)
        assert message.startswith("Error: ") and "Traceback" not in message
        assert message.strip().endswith(".") and "\n" not in message.strip()
        return False
    assert_sound(bpy.context.view_layer.objects.active)
    return True


@pytest.mark.thorough
@pytest.mark.parametrize("defect", hard_meshes.DEFECTS)
def test_each_defect(blank, defect):
    """On the mirror and on the scene, flat and smooth, with each method and placement in turn."""
    random = np.random.default_rng(len(defect))
    found = 0
    for number in range(FAMILIES):
        shape = ("turned quad", "ball", "soup")[number]
        options = {"placement": ("LAYERED", "SURFACE", "VIRTUAL")[number], "method": ("GENERAL", "PARALLEL", "POINTS")[
            random.integers(3)]}
        seed = int(random.integers(1000))
        mirror = object_of("Mirror", hard_meshes.mesh(shape, (defect,), seed=seed), bool(number % 2))
        scene = object_of("Scene", hard_meshes.mesh("ball", (defect,), seed=seed, place="before"), False)
        mirror.location = scene.location = 0.0, 0.0, 1.0
        found += generated_or_refused(mirror, scene, **options)
    assert found > 0


@pytest.mark.thorough
def test_cases_at_random(blank):
    """As in the core's search, at the sizes that single precision holds; one result after another in one file."""
    random = np.random.default_rng(4)
    found = 0
    for number in range(40):
        case = hard_meshes.Case.drawn(random)
        mirror = object_of("Mirror", hard_meshes.mesh(case.mirror, case.mirror_defects, seed=case.seed),
                           number % 2 == 0)
        scene = object_of("Scene", hard_meshes.mesh(case.scene, case.scene_defects, seed=case.seed, place=case.place),
                          False)
        mirror.location = scene.location = 0.0, 0.0, 1.0
        scene.scale.x = (1.0, -1.0, 1e-6, 1e6)[number % 4]
        found += generated_or_refused(mirror, scene, depth=1 + number % 2)
        for obj in (mirror, scene):
            bpy.data.objects.remove(obj)
    assert found > 5


@pytest.mark.parametrize("shape", ["concave", "crossing", "with a hole's seam", "on a line"])
def test_faces_of_many_corners(blank, shape):
    angles = np.arange(10) * 0.2 * np.pi
    if shape == "crossing":
        angles = angles * 3.0
    radius = np.where(np.arange(10) % 2, 1.0, 0.3)
    points = np.stack([radius * np.cos(angles), np.zeros(10), radius * np.sin(angles)], axis=1)
    if shape == "with a hole's seam":
        points[[3, 7]] = points[[2, 6]]
    if shape == "on a line":
        points[2:8, 2] = 0.0
    faces = bpy.data.meshes.new("Star")
    faces.from_pydata(points.tolist(), [], [tuple(range(10)), (9, 8, 7), (0, 1, 2, 3)])
    mirror = linked("Mirror", faces)
    mirror.location = 0.0, 1.0, 1.0
    scene = linked("Scene", faces.copy())
    scene.location = 0.2, -1.0, 1.1
    for method in ("GENERAL", "POINTS"):
        assert generated_or_refused(mirror, scene, method=method)


def test_custom_normals_of_every_kind(blank):
    """Zero, sideways and opposite normals of single corners, as imported files have them."""
    mirror = parts.add("ico_sphere", "Mirror", subdivisions=2, location=(0.0, 0.5, 1.0))
    scene = parts.add("cube", "Scene", size=1.0, location=(0.3, -1.5, 1.0))
    mirror.data.shade_smooth()
    own = np.array([normal.vector for normal in mirror.data.corner_normals])
    random = np.random.default_rng(8)
    for normals in (-own, np.broadcast_to([1.0, 0.0, 0.0], own.shape), random.normal(size=own.shape),
                    own * random.choice([-1.0, 1.0], (len(own), 1))):
        mirror.data.normals_split_custom_set(normals / np.linalg.norm(normals, axis=1, keepdims=True))
        assert generated_or_refused(mirror, scene)


@pytest.mark.parametrize("scale", [1e-6, 1e-3, 1e3, 1e6])
def test_sizes_and_places(blank, scale):
    """The whole scene a million times smaller or larger, and a thousand of its sizes away."""
    mirror, scene = parts.add_wall_mirror(), parts.add("ico_sphere", "Scene", radius=0.5, location=(0.2, -1.5, 1.0))
    shift = np.array([1000.0, -700.0, 300.0]) * scale
    for offset in (np.zeros(3), shift):
        for obj in (mirror, scene, bpy.context.scene.camera):
            obj.location = np.array(obj.location) * (scale if not offset.any() else 1.0) + offset
            if obj.type == "MESH" and not offset.any():
                obj.scale = (scale, scale, scale)
        assert generated_or_refused(mirror, scene)


def test_materials_beyond_the_slots(blank):
    """Faces that name a slot that is not there, which Blender allows."""
    mirror, scene = parts.add_wall_mirror(), parts.add("cube", "Scene", size=1.0, location=(0.0, -1.5, 1.0))
    scene.data.materials.append(parts.material("One"))
    scene.data.attributes.new("material_index", "INT", "FACE").data.foreach_set("value", [0, 1, 7, -3, 32767, 2])
    assert generated_or_refused(mirror, scene)
