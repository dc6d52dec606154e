"""The core's door: a wrong argument gets one sentence that names it."""
import re
import warnings
from dataclasses import replace

import numpy as np
import pytest

from core import PointTree, SceneTree, Settings, TriangleMesh, View, project, reflect
from tests.inputs.small_scene import MIRROR, POSITIONS, SCENE, TRIANGLES, VIEW, looking

NAN, INF = float("nan"), float("inf")
PAIR = np.ones((1, 3, 3)), np.ones((1, 3, 3)), np.ones((1, 3))


def with_value(array, index, value):
    array = np.array(array, dtype=np.float64)
    array.flat[index] = value
    return array


def placed(axes, last=(0.0, 0.0, 0.0, 1.0)):
    matrix = VIEW.camera_to_world.copy()
    matrix[:3, :3], matrix[3] = axes, last
    return View(matrix, VIEW.projection, (64, 64))


def projecting(values):
    matrix = VIEW.projection.copy()
    for place, value in values.items():
        matrix[place] = value
    return View(VIEW.camera_to_world, matrix, (64, 64))


def cases(name, call, **values):
    """Wrong values of one argument, and what the sentence must name."""
    return [pytest.param(name, lambda value=value: call(value), id=f"{name}-{kind}") for kind, value in values.items()]


NO_NUMBERS = {"none": None, "text": "0.5", "bytes": b"5", "complex": 1j, "list": [1.0], "true": True,
              "numpy true": np.True_, "object": object()}
NO_ARRAYS = {"none": None, "scalar": 1.0, "text": "abc", "texts": [["a", "b", "c"]], "number texts": [["1", "2", "3"]],
             "complex": POSITIONS + 1j, "objects": np.full((4, 3), None), "ragged": [[0, 0, 0], [1, 1]],
             "bools": POSITIONS > 0, "dates": np.zeros((4, 3), "datetime64[s]"), "set": {1, 2, 3}, "mesh": MIRROR}
NO_MESHES = {"none": None, "arrays": (POSITIONS, TRIANGLES), "text": "mirror", "view": VIEW, "class": TriangleMesh}

MESHES = [
    *cases("positions", lambda given: TriangleMesh(given, TRIANGLES), **NO_ARRAYS, flat=POSITIONS.ravel(),
           pairs=POSITIONS[:, :2], fours=np.ones((3, 4)), turned=POSITIONS.T, deep=POSITIONS[None],
           six=POSITIONS[:3, :2]),
    *cases("vertex", lambda given: TriangleMesh(given, TRIANGLES), nan=with_value(POSITIONS, 4, NAN),
           inf=with_value(POSITIONS, 4, -INF), huge=with_value(POSITIONS, 4, 1e200), longdouble=np.longdouble(
               [["1e400", 0, 0]] * 3 + [[1, 1, 1]]), integers=[[10 ** 300, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 1]]),
    *cases("vertex", lambda given: TriangleMesh(given, []), huge_alone=with_value(POSITIONS, 4, 1e200)),
    *cases("triangles", lambda given: TriangleMesh(POSITIONS, given), **NO_ARRAYS, quads=[[0, 1, 2, 3]],
           three_quads=[[0, 1, 2, 3]] * 3, flat=[0, 1, 2], halves=TRIANGLES + 0.5, floats=TRIANGLES.astype(float),
           nan=with_value(TRIANGLES, 0, NAN), beyond_all=[[0, 1, 2 ** 70]]),
    *cases("triangle", lambda given: TriangleMesh(POSITIONS, given), beyond=TRIANGLES + 2, negative=TRIANGLES - 1,
           far=TRIANGLES + 2 ** 40, unsigned=TRIANGLES.astype(np.uint64) + np.uint64(2 ** 63)),
    *cases("triangle", lambda given: TriangleMesh([], given), of_nothing=TRIANGLES),
    *cases("corner_normals", lambda given: TriangleMesh(POSITIONS, TRIANGLES, given),
           **{kind: given for kind, given in NO_ARRAYS.items() if kind != "none"}, of_vertices=POSITIONS,
           of_triangles=np.ones((2, 3)), too_few=np.ones((1, 3, 3)), too_many=np.ones((3, 3, 3)), nothing=[]),
    *cases("normal", lambda given: TriangleMesh(POSITIONS, TRIANGLES, np.full((2, 3, 3), given)), nan=NAN, inf=INF),
    *cases("meshes to join", TriangleMesh.joined, none=None, number=1, one_none=[None],
           arrays=[(POSITIONS, TRIANGLES)]),
    *cases("mesh", SceneTree.build, **NO_MESHES, tree=PointTree.build(SCENE)),
    *cases("mesh", PointTree.build, **NO_MESHES, tree=SceneTree.build(SCENE)),
]
SETTINGS = [
    *cases("tolerance", lambda given: Settings(given), **NO_NUMBERS, zero=0.0, negative=-1, nan=NAN, inf=INF,
           array=np.ones(2), endless=10 ** 400, beyond=1e300),
    *cases("placement", lambda given: Settings(placement=given), none=None, lower="layered", number=0,
           list=["LAYERED"], array=np.array(["LAYERED", "SURFACE"])),
    *cases("method", lambda given: Settings(method=given), none=None, other="X", array=np.array(["GENERAL"] * 2)),
    *cases("depth", lambda given: Settings(depth=given), **NO_NUMBERS, negative=-3, half=1.5, float=2.0,
           nan=NAN, inf=INF, endless=10 ** 400),
    *cases("depth", lambda given: Settings(method="POINTS", depth=given), of_points=2),
    *cases("maximum_faces", lambda given: Settings(maximum_faces=given), **NO_NUMBERS, zero=0, float=1e6, nan=NAN,
           inf=INF, endless=10 ** 400),
    *cases("hidden_faces", lambda given: Settings(hidden_faces=given), none=None, one=1, text="no",
           array=np.array([True, False])),
    *cases("maximum_memory", lambda given: Settings(maximum_memory=given), **NO_NUMBERS, zero=0, negative=-1.0,
           nan=NAN),
]
VIEWS = [
    *cases("View.resolution", lambda given: looking(resolution=given), none=None, number=64, zero=(0, 5),
           negative=(-1, 5), one=(5,), three=(5, 5, 5), floats=(64.7, 64.2), whole_floats=(64.0, 64.0), nan=(NAN, 5),
           text="64", texts=("64", "64"), bools=(True, True), million=(10 ** 6, 10 ** 6),
           endless=(10 ** 30, 10 ** 30), beyond=(65537, 1)),
    *cases("View.resolution", lambda given: replace(VIEW, resolution=given), none=None, floats=(64.7, 64.2),
           huge=(10 ** 15, 10 ** 15)),
    *cases("eye", lambda given: looking(eye=given), **NO_ARRAYS, two=(0, 1), nan=(NAN, 0, 0), inf=(0, INF, 0),
           huge=(0, 0, 1e300), target=(0, 0, 0)),
    *cases("target", lambda given: looking(target=given), **NO_ARRAYS, two=(0, 1), nan=(NAN, 0, 0), eye=(0, -4, 3)),
    *cases("up direction", lambda given: looking(up=given), **NO_ARRAYS, two=(0, 1), nan=(NAN, 0, 0),
           huge=(0, 0, 1e300)),
    *cases("field_of_view", lambda given: looking(field_of_view=given), **NO_NUMBERS, zero=0.0, negative=-1, pi=np.pi,
           four=4.0, seven=7, degrees=40.0, nan=NAN, inf=INF, tiny=1e-320),
    *cases("orthographic_scale", lambda given: looking(orthographic_scale=given), **NO_NUMBERS, negative=-3, nan=NAN,
           inf=INF, huge=1e300, tiny=1e-320),
    *cases("View.camera_to_world", lambda given: View(given, VIEW.projection, (64, 64)), **NO_ARRAYS, three=np.eye(3),
           nan=np.full((4, 4), NAN), huge=np.full((4, 4), 1e300), zero=np.zeros((4, 4))),
    *cases("View.camera_to_world", placed, scaled=2.0 * np.eye(3), shrunk=1e-200 * np.eye(3),
           flat=np.diag((1.0, 1.0, 0.0)), in_a_plane=np.array([[1.0, 1.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 1.0]])),
    *cases("View.camera_to_world", lambda given: placed(np.eye(3), given), last=(0.0, 0.0, 0.5, 1.0)),
    *cases("View.projection", lambda given: View(VIEW.camera_to_world, given, (64, 64)), **NO_ARRAYS, three=np.eye(3),
           zero=np.zeros((4, 4)), inf=np.full((4, 4), INF), huge=np.diag((1e300, 1.0, 1.0, 1.0))),
    *cases("View.projection", projecting, neither={(3, 2): 0.0}, both={(3, 3): 1.0}, scaled={(3, 2): -2.0},
           behind={(3, 2): 1.0}, no_width={(0, 0): 0.0}, sheared={(0, 1): 0.3}, moved={(1, 3): 1.0}),
]
REFLECTED = [
    *cases("view", lambda given: reflect(given, MIRROR, SCENE), **NO_MESHES | {"view": MIRROR}),
    *cases("mirror", lambda given: reflect(VIEW, given, SCENE), **NO_MESHES, tree=SceneTree.build(MIRROR)),
    *cases("mirror", lambda given: reflect(VIEW, given, SCENE), empty=TriangleMesh([], []),
           tiny=TriangleMesh(POSITIONS * 1e-320, TRIANGLES), line=TriangleMesh(POSITIONS * (1, 0, 0), TRIANGLES)),
    *cases("scene", lambda given: reflect(VIEW, MIRROR, given), **NO_MESHES),
    *cases("reflected objects", lambda given: reflect(VIEW, MIRROR, given), empty=TriangleMesh([], []),
           points=TriangleMesh(POSITIONS, []), nothing=TriangleMesh.joined([])),
    *cases("settings", lambda given: reflect(VIEW, MIRROR, SCENE, given), none=None, number=0.5,
           dict={"tolerance": 0.5}),
    *cases("mirrors", lambda given: reflect(VIEW, MIRROR, SCENE, mirrors=given), arrays=(POSITIONS, TRIANGLES),
           list=[MIRROR, MIRROR], empty=TriangleMesh([], []), view=VIEW),
    *cases("eye", lambda given: reflect(View(with_value(np.eye(4), 3, given), VIEW.projection, (9, 9)), MIRROR, SCENE),
           far=1e200),
]
PROJECTED = [
    *cases("vertices", lambda given: project(given, *PAIR[1:]), **NO_ARRAYS, flat=np.ones((1, 9)),
           two=np.ones((2, 3, 3)), nan=np.full((1, 3, 3), NAN)),
    *cases("rays", lambda given: project(PAIR[0], given, PAIR[2]), **NO_ARRAYS, flat=np.ones(9),
           inf=np.full((1, 3, 3), INF)),
    *cases("points", lambda given: project(*PAIR[:2], given), **NO_ARRAYS, one=np.ones(3), two=np.ones((2, 3)),
           fours=np.ones((1, 4))),
]


@pytest.mark.parametrize(("name", "call"), [*MESHES, *SETTINGS, *VIEWS, *REFLECTED, *PROJECTED])
def test_a_wrong_argument_is_refused_in_one_sentence_that_names_it(name, call):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(ValueError) as caught:
            call()
    message = str(caught.value)
    # the dot of a field's name ends no sentence
    assert re.match(r"^[A-Z][^.!?\n]*\.$", message.replace("View.", "View "))
    assert name.lower() in message.lower() or name == "depth" in message
