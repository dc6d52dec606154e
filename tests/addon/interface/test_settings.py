"""Settings: every way in uses the file's, what is given wins, and they stay with the file whatever becomes of it."""
from __future__ import annotations

from pathlib import Path

import bpy
import parts
import pytest

from tools.extension_zip import PACKAGE

OTHERS = {"tolerance": 2.0, "placement": "SURFACE", "method": "PARALLEL", "depth": 3, "memory": 4.0,
          "hidden_faces": True, "light_samples": 7,
          "attributes": "SHOWN", "world_faces": "NEVER", "join_parts": False}


@pytest.fixture
def pair(blank) -> bpy.types.Context:
    """A cube before two wall mirrors, by role, 96 x 72 pixels."""
    cube = parts.add("cube", "Box", size=1.0, location=(0.0, -1.5, 1.0))
    cube.data.materials.append(parts.material("Plain"))
    cube.reflection_mesh.role = "DIFFUSE"
    for name, place in (("Left", -2.0), ("Right", 2.0)):
        mirror = parts.add_wall_mirror(name)
        mirror.location.x = place
        mirror.reflection_mesh.role = "MIRROR"
    blank.scene.render.resolution_x, blank.scene.render.resolution_y = 96, 72
    parts.select()
    return blank


@pytest.fixture
def seen(room, monkeypatch) -> list:
    """The settings of each mirror, by its name, whenever a generation is asked for; none takes place."""
    told: list = []

    def instead(context, chosen, settings, *_, **__):
        told.append({mirror.name: settings(mirror) for mirror in chosen.mirrors})
        raise room("core").ReflectionError("Not here.")
    for way in ("operators.generate", "operators.compare", "operators.bake_frames.bake", "command_line.verbs"):
        monkeypatch.setattr(room(f"addon.{way}"), "generation", instead)
    return told


def put(holder, values: dict) -> None:
    for name, value in values.items():
        setattr(holder, name, value)


def held(holder) -> dict:
    return {name: getattr(holder, name) for name in OTHERS}


def core_settings(room, values: dict):
    known = {name: value for name, value in values.items() if name in room("addon.settings").SETTINGS}
    return room("core").Settings(maximum_memory=known.pop("memory"), **known)


WAYS = {
    "generate": lambda room, path: bpy.ops.reflection_mesh.generate(),
    "invoked": lambda room, path: bpy.ops.reflection_mesh.generate("INVOKE_DEFAULT"),
    "compare": lambda room, path: bpy.ops.reflection_mesh.compare(filepath=path),
    "bake": lambda room, path: bpy.ops.reflection_mesh.bake(filepath=path, frames="1"),
    "verb generate": lambda room, path: room("addon.command_line").run(["generate", "--output", f"{path}.blend"]),
    "verb compare": lambda room, path: room("addon.command_line").run(["compare", "--output", path]),
    # as templates of farms do, where nothing is given
    "farm": lambda room, path: room("addon.command_line").run(
        ["bake", "--frames", "1", "--tolerance", "", "--light", "", "--output", path]),
    "verb bake": lambda room, path: room("addon.command_line").run(["bake", "--frames", "1", "--output", path]),
}


@pytest.mark.parametrize("way", WAYS)
def test_every_way_in_uses_the_files_settings(pair, room, seen, tmp_path, way):
    put(pair.scene.reflection_mesh, OTHERS)
    right = bpy.data.objects["Right"].reflection_mesh
    right.own_settings = True
    right.tolerance, right.method = 0.75, "GENERAL"
    try:
        WAYS[way](room, str(tmp_path / "out"))
    except RuntimeError as error:
        assert "Not here." in str(error)
    assert seen == [{"Left": core_settings(room, OTHERS),
                     "Right": core_settings(room, {**OTHERS, "tolerance": 0.75, "method": "GENERAL"})}]


def test_what_is_given_wins(pair, room, seen, tmp_path):
    put(pair.scene.reflection_mesh, OTHERS)
    right = bpy.data.objects["Right"].reflection_mesh
    right.own_settings, right.depth = True, 2
    parts.refusal(tolerance=0.5)
    assert room("addon.command_line").run(
        ["generate", "--tolerance", "0.5", "--no-hidden-faces", "--output", str(tmp_path / "x.blend")]) == 1
    operator, verb = seen
    # 0.5 is also the operator's default: given all the same
    assert [(one.tolerance, one.depth, one.hidden_faces) for one in operator.values()] == [(0.5, 3, True),
                                                                                          (0.5, 2, True)]
    assert [(one.tolerance, one.depth, one.hidden_faces) for one in verb.values()] == [(0.5, 3, False),
                                                                                      (0.5, 2, False)]


def test_each_mirror_is_made_by_its_own(pair):
    """Faces in one mirror and points in the other, in one run."""
    right = bpy.data.objects["Right"].reflection_mesh
    right.own_settings, right.method, right.placement = True, "POINTS", "SURFACE"
    parts.generate()
    left, right = (bpy.data.objects[f"{name} Reflection"].reflection_mesh for name in ("Left", "Right"))
    assert left.faces > 0 and left.points == 0 and right.points > 0 and right.faces == 0
    places = parts.attribute(bpy.data.objects["Right Reflection"], "mirror_position")
    assert abs(places[:, 1] - 1.0).max() < 1e-6


def test_own_settings_begin_as_the_scenes_and_are_kept(pair, room):
    put(pair.scene.reflection_mesh, OTHERS)
    record = bpy.data.objects["Left"].reflection_mesh
    record.own_settings = True
    assert held(record) == held(pair.scene.reflection_mesh)
    record.tolerance = 5.0
    record.own_settings = False
    pair.scene.reflection_mesh.tolerance = 1.0
    assert room("addon.settings").holder_of(bpy.data.objects["Left"], pair.scene).tolerance == 1.0
    record.own_settings = True
    assert record.tolerance == 5.0


def test_no_option_is_remembered_from_the_last_run():
    """Blender gives operators what their last run had, unless told not to; places of files are as Blender's own are."""
    asked = 0
    for name in dir(bpy.ops.reflection_mesh):
        properties = getattr(bpy.ops.reflection_mesh, name).get_rna_type().properties
        for known in properties:
            if known.identifier not in {"rna_type", "filepath", "filter_glob"}:
                assert known.is_skip_save, (name, known.identifier)
                asked += 1
    assert asked > 30


class Operator:
    """What a run leaves behind of an operator, to be run again with changes, as the panel after it does."""

    def __init__(self, room, kind: str):
        place = "addon.operators.bake_frames.bake_operator" if kind == "bake" else f"addon.operators.{kind}"
        self.cls = getattr(room(place), f"REFLECTION_MESH_OT_{kind}")
        self.values = {}
        self.used = {}

    @property
    def properties(self):
        return self

    def is_property_set(self, name):
        return name in self.values

    def __getattr__(self, name):
        if name in {"values", "cls"} or name.startswith("__"):
            raise AttributeError(name)
        if name in self.values:
            return self.values[name]
        entry = getattr(self.cls, name)
        return entry.__get__(self) if callable(entry) else entry

    def __setattr__(self, name, value):
        if name in {"values", "cls", "used"}:
            object.__setattr__(self, name, value)
        else:
            self.values[name] = value


def test_the_panel_after_a_run_shows_what_was_used_and_changes_that_alone(pair, room):
    put(pair.scene.reflection_mesh, OTHERS)
    left, right = (bpy.data.objects[name] for name in ("Left", "Right"))
    right.reflection_mesh.own_settings, right.reflection_mesh.depth = True, 2
    operator = Operator(room, "generate")
    operator.tolerance = 0.75
    wanted = operator.wanted(pair)
    operator.show_used(wanted, [left, right])
    assert operator.values == {**{name: OTHERS[name] for name in room("addon.settings").SETTINGS}, "tolerance": 0.75,
                               **{name: OTHERS[name] for name in room("addon.settings").WRITTEN_SETTINGS}}
    # run again without a change, and with one
    assert operator.wanted(pair).given == {"tolerance": 0.75}
    operator.method = "GENERAL"
    again = operator.wanted(pair)
    assert again.given == {"tolerance": 0.75, "method": "GENERAL"}
    assert [again(mirror).depth for mirror in (left, right)] == [3, 2]
    # run once more after the file has changed
    pair.scene.reflection_mesh.depth = 5
    assert operator.wanted(pair)(left).depth == 5


def test_light_uses_the_files_settings(pair, room, monkeypatch):
    parts.generate()
    pair.scene.reflection_mesh.light_samples = 3
    right = bpy.data.objects["Right"].reflection_mesh
    right.own_settings, right.light_samples = True, 9
    told: list = []

    def instead(context, groups, every=False):
        told.append([([obj.name for obj in results], samples) for results, samples in groups])
        return []
        yield
    for way in ("operators.light", "command_line.verbs"):
        monkeypatch.setattr(room(f"addon.{way}"), "lighting_groups", instead)
    bpy.ops.reflection_mesh.light()
    bpy.ops.reflection_mesh.light(samples=5)
    bpy.ops.reflection_mesh.light(samples=5)
    apart = [(["Left Reflection"], 3), (["Right Reflection"], 9)]
    both = ["Left Reflection", "Right Reflection"]
    assert told == [apart, [(both, 5)], [(both, 5)]]
    told.clear()
    run = room("addon.command_line.verbs").run
    parts.select()
    bpy.ops.wm.save_as_mainfile(filepath=str(Path(bpy.app.tempdir, "lit.blend")))
    run(["light"]), run(["generate", "--light"]), run(["generate", "--light", "5"]), run(["light", "--samples", "5"])
    assert told == [apart, apart, [(both, 5)], [(both, 5)]]


def test_two_groups_are_lit_or_none(pair, room):
    """Each mirror with samples of its own; closed before the end, neither is lit."""
    bpy.data.objects["Box"].data.materials[0] = parts.material("Matt", "DIFFUSE")
    parts.generate()
    results = [bpy.data.objects[f"{name} Reflection"] for name in ("Left", "Right")]
    groups, light = [([obj], 1) for obj in results], room("addon.operators.light").lighting_groups
    before = parts.state()
    steps = light(pair, groups)
    writing = 0
    while writing < 2:
        writing += next(steps)[1] == "Writing"
    steps.close()
    assert parts.state() == before
    assert room("addon.faults").finished(light(pair, groups)) == results
    materials = {obj.reflection_mesh.light_material for obj in results}
    assert len(materials) == 2 and None not in materials


def test_bakes_know_the_settings_of_mirrors_with_their_own(pair, room):
    bake, wanted = room("addon.operators.bake_frames.plan"), room("addon.settings").Wanted(pair.scene)
    mirrors = [bpy.data.objects[name] for name in ("Left", "Right")]
    plan = bake.Plan("folder", [1], wanted, 1)
    same = plan.made_with(pair, None, mirrors)
    # what was baked when settings were the scene's alone is still known
    assert same == bake.Plan("folder", [1], room("core").Settings(depth=0), 1).made_with(pair, None, mirrors)
    right = mirrors[1].reflection_mesh
    right.own_settings, right.placement, right.light_samples = True, "VIRTUAL", 99
    own = plan.made_with(pair, None, mirrors)
    assert own == {**same, "own": {"Right": {**own["own"]["Right"], "placement": "VIRTUAL"}}}
    assert bake.plan_of(pair, "folder", "1", wanted).samples == 99


def saved(tmp_path: Path) -> str:
    path = str(tmp_path / "file.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    return path


def with_own(obj) -> dict:
    obj.reflection_mesh.own_settings = True
    put(obj.reflection_mesh, OTHERS)
    return held(obj.reflection_mesh)


def test_they_survive_saving_appending_and_linking(pair, tmp_path):
    values = with_own(bpy.data.objects["Left"])
    pair.scene.reflection_mesh.tolerance = 3.0
    path = saved(tmp_path)
    bpy.ops.wm.open_mainfile(filepath=path)
    assert bpy.context.scene.reflection_mesh.tolerance == 3.0
    assert held(bpy.data.objects["Left"].reflection_mesh) == values
    for link in (False, True):
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
        with bpy.data.libraries.load(path, link=link) as (source, target):
            target.objects = ["Left", "Right"]
        left, right = target.objects
        assert left.reflection_mesh.own_settings and held(left.reflection_mesh) == values
        assert not right.reflection_mesh.own_settings and right.reflection_mesh.role == "MIRROR"


def test_overrides_keep_what_is_changed_in_them(pair, tmp_path):
    values = with_own(bpy.data.objects["Left"])
    path = saved(tmp_path)
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    with bpy.data.libraries.load(path, link=True) as (source, target):
        target.objects = ["Left", "Right"]
    scene = bpy.context.scene
    overrides = []
    for linked in target.objects:
        scene.collection.objects.link(linked)
        overrides.append(linked.override_create(remap_local_usages=True))
    left, right = overrides
    left.reflection_mesh.tolerance, left.reflection_mesh.role = 6.0, "IGNORE"
    right.reflection_mesh.own_settings = True
    right.reflection_mesh.method = "POINTS"
    user = str(tmp_path / "user.blend")
    bpy.ops.wm.save_as_mainfile(filepath=user)
    bpy.ops.wm.open_mainfile(filepath=user)
    left, right = (next(obj for obj in bpy.data.objects if obj.name == name and obj.override_library)
                   for name in ("Left", "Right"))
    assert held(left.reflection_mesh) == {**values, "tolerance": 6.0} and left.reflection_mesh.role == "IGNORE"
    assert right.reflection_mesh.own_settings and right.reflection_mesh.method == "POINTS"


def test_a_blender_without_the_extension_keeps_them(pair, tmp_path):
    values = with_own(bpy.data.objects["Left"])
    put(pair.scene.reflection_mesh, OTHERS)
    scenes = held(pair.scene.reflection_mesh)
    path = saved(tmp_path)
    bpy.ops.preferences.addon_disable(module=PACKAGE)
    try:
        bpy.ops.wm.open_mainfile(filepath=path)
        assert not hasattr(bpy.types.Object, "reflection_mesh")
        bpy.data.objects["Left"].location.z += 1.0
        bpy.ops.wm.save_as_mainfile(filepath=path)
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    finally:
        bpy.ops.preferences.addon_enable(module=PACKAGE)
    bpy.ops.wm.open_mainfile(filepath=path)
    assert held(bpy.context.scene.reflection_mesh) == scenes
    left = bpy.data.objects["Left"].reflection_mesh
    assert left.own_settings and left.role == "MIRROR" and held(left) == values


def stored(data, name: str, values: dict) -> None:
    """Write values as files hold them, without the extension's names: from Blender 5.0 on beside custom properties."""
    if bpy.app.version >= (5, 0, 0):
        data = data.bl_system_properties_get(do_create=True)
    data[name] = values


def test_old_files_settings_are_taken_over(pair, tmp_path):
    """A file as version 0.1 wrote it: choices by their numbers, for the scene alone."""
    bpy.ops.preferences.addon_disable(module=PACKAGE)
    try:
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
        mirror = bpy.data.objects.new("Old", None)
        bpy.context.scene.collection.objects.link(mirror)
        stored(bpy.context.scene, "reflection_mesh", {"tolerance": 4.0, "placement": 1, "method": 2, "depth": 3,
                                                      "memory": 8.0, "hidden_faces": 1, "comparison": "{}"})
        stored(mirror, "reflection_mesh", {"role": 1})
        for placement, method in ((0, 1), (2, 0)):
            other = bpy.data.scenes.new(f"{placement} {method}")
            stored(other, "reflection_mesh", {"placement": placement, "method": method})
        path = saved(tmp_path)
    finally:
        bpy.ops.preferences.addon_enable(module=PACKAGE)
    bpy.ops.wm.open_mainfile(filepath=path)
    settings = bpy.context.scene.reflection_mesh
    assert {name: getattr(settings, name) for name in list(OTHERS)[:6]} == {
        "tolerance": 4.0, "placement": "SURFACE", "method": "POINTS", "depth": 3, "memory": 8.0, "hidden_faces": True}
    assert (settings.light_samples, settings.comparison) == (64, "{}")
    assert [(scene.reflection_mesh.placement, scene.reflection_mesh.method)
            for scene in (bpy.data.scenes["0 1"], bpy.data.scenes["2 0"])] == [("LAYERED", "PARALLEL"),
                                                                               ("VIRTUAL", "GENERAL")]
    record = bpy.data.objects["Old"].reflection_mesh
    assert record.role == "MIRROR" and not record.own_settings
