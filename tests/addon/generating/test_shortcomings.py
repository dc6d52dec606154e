"""What a result lacks is told, each cause in a sentence of its own that says what to do."""
import re
from types import SimpleNamespace

import bpy
import parts
import pytest

COUNTS = ("crowded", "overlaid", "pierced", "many_outlines", "unfollowed", "bounded", "coarse")


@pytest.fixture(scope="module")
def told(room):
    def told(**counts):
        result = SimpleNamespace(counts=counts, missing_share=12.3, positions=range(50))
        return room("addon.operators.shortcomings").shortcomings("Lake", result)
    return told


@pytest.mark.parametrize("count", COUNTS)
def test_each_count_has_a_sentence(told, count):
    (sentence,) = told(**{count: 7})
    assert re.fullmatch(r"Lake: [A-Z0-9][^.]+: [a-z][^.]+\.", sentence)
    assert "7" in sentence or count == "bounded"


def test_sentences_differ_and_a_good_result_has_none(told):
    assert len({one for count in COUNTS for one in told(**{count: 1})}) == len(COUNTS)
    assert told(**dict.fromkeys(COUNTS, 0), missed=0) == []
    assert told(missed=2) == [] and "About 12 %" in told(missed=3)[0]


@pytest.mark.parametrize("placement", ["LAYERED", "VIRTUAL"])
def test_what_a_render_blurs_otherwise_is_told(blank, capfd, placement):
    parts.select(parts.add("cube", "Box", size=1.0, location=(0.0, -1.5, 1.0)), parts.add_wall_mirror())

    def told() -> str:
        parts.generate(placement=placement)
        return "".join(capfd.readouterr())
    assert "blur" not in told()
    blank.scene.camera.data.dof.use_dof = blank.scene.render.use_motion_blur = True
    sentences = told()
    assert ("Depth of field: the camera focuses on the mirror" in sentences) == (placement == "LAYERED")
    assert "Motion blur: the reflection is that of one moment" in sentences


def subdivided(box, levels: int = 1, render: int = 2, name: str = "Rounder", **more):
    modifier = box.modifiers.new(name, "SUBSURF")
    modifier.levels, modifier.render_levels = levels, render
    for key, value in more.items():
        setattr(modifier, key, value)


def simplified(box) -> None:
    subdivided(box)
    bpy.context.scene.render.use_simplify = True
    bpy.context.scene.render.simplify_subdivision = bpy.context.scene.render.simplify_subdivision_render = 1


@pytest.mark.parametrize(("change", "told"), [
    (subdivided, True), (lambda box: subdivided(box, 2), False), (simplified, False),
    (lambda box: subdivided(box, 2, show_render=False), True),
    (lambda box: subdivided(box, 2, show_viewport=False), True),
    (lambda box: subdivided(box, show_render=False, show_viewport=False), False)])
def test_another_mesh_in_renders_is_told(blank, capfd, change, told):
    """Of that a reflection has the viewport's."""
    box, mirror = parts.add("cube", "Box", size=1.0, location=(0.0, -1.5, 1.0)), parts.add_wall_mirror()
    change(box)
    parts.select(box, mirror)
    parts.generate()
    assert ("another mesh of 'Box' than viewports do, by 'Rounder'" in "".join(capfd.readouterr())) == told
    other = parts.add("cube", "Other", size=1.0, location=(0.5, -2.5, 1.0))
    subdivided(other)
    parts.select(box, other, mirror)
    parts.generate()
    assert ("other meshes of 2 objects than viewports do, of 'Box'" in "".join(capfd.readouterr())) == told


def test_curves_and_metaballs_that_renders_make_finer_are_told(blank, room):
    otherwise = room("addon.reading").rendered_otherwise
    bpy.ops.object.metaball_add()
    ball = bpy.context.object
    bpy.ops.curve.primitive_bezier_circle_add()
    ring = bpy.context.object
    assert otherwise(blank.scene, ball) == ball.data.name and not otherwise(blank.scene, ring)
    ball.data.render_resolution, ring.data.render_resolution_u = ball.data.resolution, 40
    assert otherwise(blank.scene, ring) == ring.data.name and not otherwise(blank.scene, ball)


@pytest.mark.parametrize("hide", ["eye", "collection", "everywhere", "chosen"])
def test_what_the_viewport_alone_hides_is_told(blank, capfd, hide):
    """A mirror that shows all that is there lacks what renders show of it; where the user chose, it is meant."""
    box, kept, mirror = parts.add("cube", "Box"), parts.add("cube", "Kept", location=(1.5, -1.5, 1.0)), None
    mirror = parts.add_wall_mirror()
    mirror.data.materials.append(parts.material("Chrome", "GLOSSY"))
    if hide == "collection":
        cellar = bpy.data.collections.new("Cellar")
        blank.scene.collection.children.link(cellar)
        cellar.objects.link(box)
        blank.scene.collection.objects.unlink(box)
        blank.view_layer.layer_collection.children["Cellar"].hide_viewport = True
    else:
        box.hide_set(True)
    box.hide_render = hide == "everywhere"
    if hide == "chosen":
        parts.add("cube", "Left", location=(-1.5, -1.5, 1.0))
    parts.select(*([kept] if hide == "chosen" else []), mirror)
    parts.generate()
    told = "Renders show 'Box', which is hidden in the viewport" in "".join(capfd.readouterr())
    assert told == (hide in {"eye", "collection"})


def hairy(box):
    box.modifiers.new("Fur", "PARTICLE_SYSTEM")
    box.particle_systems[0].settings.type = "HAIR"


@pytest.mark.parametrize(("change", "told"), [
    (hairy, "Box"), (lambda box: bpy.ops.object.volume_add(), "Volume"), (lambda box: bpy.ops.object.empty_add(), "")])
def test_what_has_no_mesh_is_told(blank, capfd, change, told):
    """Renders show it in the mirror, and the reflection does not; where the user chose other things, it is meant."""
    box, other = parts.add("cube", "Box"), parts.add("cube", "Other", location=(1.5, -1.5, 1.0))
    mirror = parts.add_wall_mirror()
    mirror.data.materials.append(parts.material("Chrome", "GLOSSY"))
    change(box)
    parts.select(mirror)
    parts.generate()
    sentence = f"No reflection has hair, point clouds or volumes, as '{told}' has"
    assert (sentence in "".join(capfd.readouterr())) == bool(told)
    bpy.ops.reflection_mesh.clear()
    parts.select(other, mirror)
    parts.generate()
    assert "No reflection has hair" not in "".join(capfd.readouterr())
