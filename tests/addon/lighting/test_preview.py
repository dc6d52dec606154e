"""Results that are not lit yet: the colours of what they show, in the mirror's tint, whatever lamps there are."""
import bpy
import numpy as np
import parts
import pytest
from lamp_scenes import lit_state, outdated, picture, plain_scene, principled, scene_of, shader_of

MARK = "reflection_mesh_preview"
TINT = (0.95, 0.7, 0.35)


def previews() -> list:
    return [material for material in bpy.data.materials if MARK in material]


def facing_card(blank, colour=(0.2, 0.5, 0.8), **inputs) -> bpy.types.Object:
    """A card before a tinted mirror that the camera faces, which the mirror shows in its middle."""
    wall = scene_of(blank, "", "Tint")
    card = parts.add("plane", "Card", size=3.0, location=(0.0, -8.0, 1.0), rotation=(-np.pi / 2, 0.0, 0.0))
    card.data.materials.append(principled("Card", colour, **inputs))
    parts.select(card, wall)
    return wall


@pytest.mark.thorough
@pytest.mark.parametrize("energy", [0.0, 250.0])
def test_it_shows_colours_in_the_mirrors_tint_whatever_lamps_there_are(blank, room, energy):
    facing_card(blank)
    next(obj for obj in blank.scene.objects if obj.type == "LIGHT").data.energy = energy
    parts.generate(preview=True)
    shown = picture(room)[60:68, 44:52].mean(axis=(0, 1))
    linear = np.array((0.2, 0.5, 0.8)) * TINT
    expected = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    assert np.abs(shown - expected).max() < 0.01


def test_a_flat_mirror_shows_how_what_is_round_is_round(blank, room):
    """In closed form: a ball under a light at the eye's image in the mirror, which shows it far away."""
    wall = scene_of(blank)
    for name in ("Box", "Floor"):
        bpy.data.objects.remove(bpy.data.objects[name])
    ball = parts.add("uv_sphere", "Ball", radius=2.4, segments=96, ring_count=48, location=(0.0, -28.0, 1.0))
    ball.data.shade_smooth()
    ball.data.materials.append(principled("Paint", (0.8, 0.0, 0.0)))
    blank.scene.camera.data.lens = 150.0
    blank.scene.camera.rotation_euler = (np.pi / 2, 0.0, 0.0)
    parts.select(ball, wall)
    parts.generate(preview=True)
    shown = picture(room)
    red = shown[..., 0] ** 2.2
    rows, columns = np.nonzero((shown[..., 1] < 0.02) & (red > 0.1))
    middle, radius = np.array((rows.mean(), columns.mean())), 0.5 * np.ptp(columns)
    off = np.hypot(rows - middle[0], columns - middle[1]) / radius
    inner = off < 0.9
    # the share of a ball's light that comes from the side is told where the preview is
    sideways = room("addon.lighting.preview").SIDEWAYS
    expected = 0.8 * (sideways + (1.0 - sideways) * np.sqrt(1.0 - off[inner] ** 2))
    assert radius > 15.0 and np.abs(red[rows, columns][inner] / expected - 1.0).max() < 0.1


@pytest.mark.thorough
@pytest.mark.parametrize("kind", [
    "Fresnel", "Tint", *(pytest.param(kind, marks=pytest.mark.slow) for kind in ("Layer weight", "Water", "Varnish"))])
@pytest.mark.parametrize("turned", [False, True])
def test_a_mirror_shows_as_much_of_what_shines_as_it_reflects(blank, room, kind, turned):
    """By the true angle, also where the backs of what is reflected are seen."""
    wall, black = scene_of(blank, "", "" if kind in {"Water", "Varnish"} else kind), (0.0, 0.0, 0.0, 1.0)
    if kind in {"Water", "Varnish"}:
        silver = shader_of(wall.data.materials[0])
        silver.inputs["Metallic"].default_value, silver.inputs["Base Color"].default_value = 0.0, black
    if kind == "Varnish":
        silver.inputs["Specular IOR Level"].default_value = silver.inputs["Coat Roughness"].default_value = 0.0
        silver.inputs["Roughness"].default_value = silver.inputs["Coat Weight"].default_value = 1.0
    for node in wall.data.materials[0].node_tree.nodes:
        if node.type == "BSDF_DIFFUSE":
            node.inputs["Color"].default_value = black
    # at a slant, so that much is reflected
    blank.scene.camera.location, blank.scene.camera.rotation_euler = (-5.0, -1.2, 1.0), (np.pi / 2, 0.0, -1.2)
    card = parts.add("plane", "Card", size=20.0, location=(6.0, -3.0, 1.0), rotation=(0.0, np.pi / 2, 0.0))
    if turned:
        card.rotation_euler.y = -np.pi / 2
    card.data.materials.append(parts.material("Card"))
    bpy.data.objects["Box"].hide_render = bpy.data.objects["Floor"].hide_render = True
    wall.scale.x = 2.0
    wall.reflection_mesh.role = "MIRROR"
    parts.select(card, wall)
    blank.view_layer.update()
    reference = picture(room)
    parts.generate(preview=True)
    result = bpy.data.objects["Mirror Reflection"]
    result.hide_render = True
    assert np.array_equal(picture(room), reference)
    result.hide_render = False
    inside = np.abs(picture(room) - reference)[30:-30, 30:-30]
    assert np.quantile(inside, 0.9) < 0.03


@pytest.mark.thorough
@pytest.mark.parametrize("coordinates", ["Object", "UV", ""])
@pytest.mark.parametrize("mixed", ["Principled", *(pytest.param(kind, marks=pytest.mark.slow)
                                                   for kind in ("", "Diffuse"))])
def test_a_tint_that_changes_over_the_mirror_is_shown_where_it_is(blank, room, coordinates, mixed):
    """Checkers on the whole mirror, or on the half of it that an even mix reflects: as Cycles shows them."""
    wall = scene_of(blank, "", "Tint")
    tree = wall.data.materials[0].node_tree
    shader = shader_of(wall.data.materials[0])
    if mixed:
        tree.nodes.clear()
        shader, mix = tree.nodes.new("ShaderNodeBsdfGlossy"), tree.nodes.new("ShaderNodeMixShader")
        ground, output = tree.nodes.new(f"ShaderNodeBsdf{mixed}"), tree.nodes.new("ShaderNodeOutputMaterial")
        shader.inputs["Roughness"].default_value, ground.inputs[0].default_value = 0.0, (0.0, 0.0, 0.0, 1.0)
        if mixed == "Principled":
            ground.inputs["Specular IOR Level"].default_value = 0.0
        for source, socket in ((ground, mix.inputs[1]), (shader, mix.inputs[2]), (mix, output.inputs["Surface"])):
            tree.links.new(source.outputs[0], socket)
    checks, reroute = tree.nodes.new("ShaderNodeTexChecker"), tree.nodes.new("NodeReroute")
    checks.inputs["Scale"].default_value = 3.0
    for socket, colour in zip(checks.inputs[1:3], (TINT, (0.2, 0.9, 0.6))):
        socket.default_value = (*colour, 1.0)
    tree.links.new(checks.outputs["Color"], reroute.inputs[0])
    tree.links.new(reroute.outputs[0], (shader.inputs.get("Base Color") or shader.inputs["Color"]))
    if coordinates:
        tree.links.new(tree.nodes.new("ShaderNodeTexCoord").outputs[coordinates], checks.inputs["Vector"])
    card = parts.add("plane", "Card", size=30.0, location=(0.0, -8.0, 1.0), rotation=(-np.pi / 2, 0.0, 0.0))
    card.data.materials.append(parts.material("Card"))
    bpy.data.objects["Box"].hide_render = bpy.data.objects["Floor"].hide_render = True
    wall.reflection_mesh.role = "MIRROR"
    parts.select(card, wall)
    blank.view_layer.update()
    reference = picture(room)
    parts.generate(preview=True)
    found = picture(room)
    assert len(previews()) == 1
    off = np.abs(found - reference).max(axis=2)
    seen = reference[..., 1] > 0.1
    assert seen.mean() > 0.1 and np.ptp(reference[seen], axis=0).min() > 0.15
    # along the sides of checks a pixel's samples fall otherwise
    assert np.quantile(off[seen], 0.8) < 0.02


def two_mirrors(context: bpy.types.Context, gold: bpy.types.Object, *shown: bpy.types.Object) -> None:
    """A gold mirror, a blue one at the right, and a ball that shines."""
    blue = parts.add("plane", "Blue", size=4.0, location=(2.0, 0.0, 1.2), rotation=(0.0, -np.pi / 2, 0.0))
    for mirror, colour in ((gold, (0.9, 0.6, 0.2)), (blue, (0.3, 0.5, 0.9))):
        gloss = parts.material(f"{mirror.name} gloss", "GLOSSY")
        gloss.node_tree.nodes[0].inputs["Color"].default_value = (*colour, 1.0)
        mirror.data.materials.append(gloss)
    ball = parts.add("uv_sphere", "Ball", radius=0.5, location=(0.4, -0.2, 1.0))
    ball.data.materials.append(parts.material("Shine"))
    context.scene.camera.location, context.scene.camera.rotation_euler = (-1.8, -5.0, 2.2), (1.35, 0.0, -0.38)
    context.scene.render.engine, context.scene.cycles.samples = "CYCLES", 32
    context.scene.cycles.use_denoising = context.scene.cycles.use_adaptive_sampling = False
    context.scene.render.resolution_x = context.scene.render.resolution_y = 96
    parts.select(ball, gold, blue, *shown)
    context.view_layer.update()


def wrong_pixels(room, depth: int, lit: bool) -> float:
    """The share of pixels in which previews, or light on the objects, of so many bounces differ from Cycles."""
    reference = picture(room)
    parts.generate(depth=depth, preview=True)
    if lit:
        parts.select(*(obj for obj in bpy.context.scene.objects if obj.reflection_mesh.role == "REFLECTION"))
        bpy.ops.reflection_mesh.light(samples=64)
    return float((np.abs(picture(room) - reference).max(axis=2) > 0.05).mean())


@pytest.mark.thorough
@pytest.mark.parametrize("lit", [False, True])
@pytest.mark.parametrize("body", [False, True])
def test_mirrors_in_mirrors_take_their_share(blank, room, body, lit):
    """A gold and a blue mirror that meet in a corner, by two mirrors, where the gold one is a wall, or a box, which
    does not see itself either: as Cycles shows them."""
    gold = parts.add("cube", "Gold", size=4.0, location=(0.0, 4.0, 1.2)) if body else \
        parts.add("plane", "Gold", size=4.0, location=(0.0, 2.0, 1.2), rotation=(np.pi / 2, 0.0, 0.0))
    two_mirrors(blank, gold)
    assert wrong_pixels(room, 2, lit) < 0.001


@pytest.mark.thorough
@pytest.mark.parametrize(("lit", "metal"), [(False, False), (True, False), (True, True)])
def test_each_of_several_mirrors_in_mirrors_takes_its_own_share(blank, room, lit, metal):
    """Three that meet in a corner, each of its own colour, by up to three mirrors: as Cycles shows them. Metals take
    less at grazing angles, as light has when it is low above the third one."""
    gold = parts.add("plane", "Gold", size=4.0, location=(0.0, 2.0, 1.2), rotation=(np.pi / 2, 0.0, 0.0))
    green = parts.add("plane", "Green", size=4.0, location=(0.0, 0.0, -0.8))
    two_mirrors(blank, gold, green)
    green.data.materials.append(parts.material("Green gloss", "GLOSSY"))
    green.data.materials[0].node_tree.nodes[0].inputs["Color"].default_value = (0.2, 0.7, 0.3, 1.0)
    for mirror in (gold, green, bpy.data.objects["Blue"]) if metal else ():
        colour = mirror.data.materials[0].node_tree.nodes[0].inputs["Color"].default_value[:3]
        mirror.data.materials[0] = principled(f"{mirror.name} metal", colour, Metallic=1.0, Roughness=0.0)
    blank.scene.camera.location, blank.scene.camera.rotation_euler = (-2.4, -5.0, 0.5), (1.5, 0.0, -0.45)
    blank.view_layer.update()
    # measured: 0.0021 and 0.0024 lit, at outlines, which light shows without anything between
    assert wrong_pixels(room, 3, lit) < (0.0027 if lit else 0.001)


@pytest.mark.thorough
@pytest.mark.parametrize("lit", [False, True])
def test_what_later_mirrors_show_beside_what_they_reflect_is_left_to_the_mirror(blank, room, lit):
    """The gold wall shows a pane over paint that shines, by Fresnel: what it reflects is a small part of what is seen
    there, in the pane's own result and behind that of the wall."""
    gold = parts.add("plane", "Gold", size=4.0, location=(0.0, 2.0, 1.2), rotation=(np.pi / 2, 0.0, 0.0))
    two_mirrors(blank, gold)
    blue = bpy.data.objects["Blue"]
    tree, blue.reflection_mesh.role = blue.data.materials[0].node_tree, "MIRROR"
    paint, mix, share = (tree.nodes.new(f"ShaderNode{kind}") for kind in ("Emission", "MixShader", "Fresnel"))
    paint.inputs["Color"].default_value = (0.1, 0.4, 0.6, 1.0)
    gloss, output = tree.nodes[0], next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
    for source, socket in ((share, mix.inputs[0]), (paint, mix.inputs[1]), (gloss, mix.inputs[2]),
                           (mix, output.inputs["Surface"])):
        tree.links.new(source.outputs[0], socket)
    reference = picture(room)
    parts.generate(depth=2, preview=True)
    wall = bpy.data.objects["Gold Reflection"]
    parts.select(wall)
    if lit:
        bpy.ops.reflection_mesh.light(samples=64)
    bpy.data.objects["Blue Reflection"].hide_render = True
    wrong = np.abs(picture(room) - reference).max(axis=2)
    assert (wrong > 0.05).mean() < 0.001
    assert (np.array([entry.value for entry in wall.data.attributes["later_unknown"].data]) > 0.5).any()


def test_mirrors_by_their_role_alone_show_previews_of_what_later_ones_show(blank):
    """Of white paint, they are no mirrors where they are seen themselves."""
    walls = [parts.add("plane", "Gold", size=4.0, location=(0.0, 2.0, 1.2), rotation=(np.pi / 2, 0.0, 0.0))]
    two_mirrors(blank, *walls)
    walls.append(bpy.data.objects["Blue"])
    for wall in walls:
        wall.reflection_mesh.role = "MIRROR"
        wall.data.materials[0] = parts.material("Paint", "DIFFUSE")
    parts.generate(depth=2, preview=True)
    wall = bpy.data.objects["Gold Reflection"]
    assert max(entry.value for entry in wall.data.attributes["bounces"].data) == 2
    assert not [node for material in previews() for node in material.node_tree.nodes
                if node.type == "ATTRIBUTE" and node.attribute_name == "later_unknown"]


def test_the_share_of_later_mirrors_follows_their_materials_when_lit_again(blank, room):
    """The result of the gold wall shows the blue one, which becomes red."""
    gold = parts.add("plane", "Gold", size=4.0, location=(0.0, 2.0, 1.2), rotation=(np.pi / 2, 0.0, 0.0))
    two_mirrors(blank, gold)
    parts.generate(depth=2)
    results = [obj for obj in blank.scene.objects if obj.reflection_mesh.role == "REFLECTION"]
    parts.select(*results)
    bpy.ops.reflection_mesh.light(samples=1)
    gloss = bpy.data.objects["Blue"].data.materials[0].node_tree.nodes[0]
    gloss.inputs["Color"].default_value = (0.9, 0.1, 0.1, 1.0)
    bpy.ops.reflection_mesh.light(samples=64)
    lit = picture(room)
    bpy.ops.reflection_mesh.clear()
    wrong = np.abs(lit - picture(room)).max(axis=2)
    assert (wrong > 0.05).mean() < 0.001


@pytest.mark.thorough
def test_what_is_open_leaves_the_mirror_s_ground_to_what_lies_behind(blank, room):
    """Half a card before another: as a picture of the two in a mirror that reflects half."""
    wall = scene_of(blank, "", "Fresnel")
    tree = wall.data.materials[0].node_tree
    both = next(node for node in tree.nodes if node.type == "MIX_SHADER")
    tree.links.remove(both.inputs[0].links[0])
    both.inputs[0].default_value = 0.5
    ground = tree.nodes.new("ShaderNodeEmission")
    ground.inputs["Color"].default_value = (0.4, 0.2, 0.1, 1.0)
    tree.links.new(ground.outputs[0], both.inputs[1])
    cards = []
    for name, place, alpha in (("Front", -7.0, 0.5), ("Behind", -9.0, 1.0)):
        card = parts.add("plane", name, size=9.0, location=(0.0, place, 1.0), rotation=(-np.pi / 2, 0.0, 0.0))
        paint = principled(name, (0.0, 0.0, 0.0), Alpha=alpha, **{"Emission Strength": 1.0})
        colour = (0.2, 0.4, 0.6, 1.0) if alpha < 1.0 else (0.8, 0.4, 0.2, 1.0)
        shader_of(paint).inputs["Emission Color"].default_value = colour
        card.data.materials.append(paint)
        cards.append(card)
    wall.reflection_mesh.role, wall.visible_camera = "MIRROR", False
    parts.select(*cards, wall)
    parts.generate(preview=True)
    shown = picture(room)[60:68, 44:52].mean(axis=(0, 1))
    linear = 0.5 * np.array((0.5, 0.4, 0.4)) + 0.5 * np.array((0.4, 0.2, 0.1))
    assert np.abs(shown - (1.055 * linear ** (1 / 2.4) - 0.055)).max() < 0.01


@pytest.mark.thorough
def test_what_emits_shines_in_it_and_what_is_open_is_open(blank, room):
    facing_card(blank, (0.0, 0.0, 0.0), Alpha=0.5, **{"Emission Color": (1.0, 0.5, 0.25, 1.0),
                                                      "Emission Strength": 0.5})
    bpy.data.objects["Mirror"].visible_camera = False
    blank.scene.world = None
    parts.generate(preview=True)
    shown = picture(room)[60:68, 44:52].mean(axis=(0, 1))
    linear = 0.25 * np.array((1.0, 0.5, 0.25)) * TINT
    assert np.abs(shown - (1.055 * linear ** (1 / 2.4) - 0.055)).max() < 0.01


def test_scripts_get_it_only_where_they_ask(blank):
    scene_of(blank)
    parts.generate()
    assert not previews()
    parts.generate(preview=True)
    assert len(previews()) == 2


def test_light_takes_its_place_and_clear_takes_it_away(blank):
    scene_of(blank)
    before = set(bpy.data.materials)
    result = parts.generate(preview=True)
    assert {slot.material for slot in result.material_slots} == set(previews())
    assert set(result.data.materials) <= before
    bpy.ops.reflection_mesh.light(samples=1)
    assert not previews() and {slot.material for slot in result.material_slots} == {
        result.reflection_mesh.light_material}
    parts.generate(preview=True)
    # its light still fits
    assert not previews()
    bpy.ops.reflection_mesh.clear()
    parts.generate(preview=True)
    bpy.ops.reflection_mesh.clear()
    assert set(bpy.data.materials) == before


@pytest.mark.thorough
def test_it_stays_and_follows_the_tint_when_generated_again(blank, room):
    wall = facing_card(blank)
    parts.generate(preview=True)
    tint = (0.3, 0.6, 0.9)
    shader_of(wall.data.materials[0]).inputs["Base Color"].default_value = (*tint, 1.0)
    result = parts.generate()
    assert len(previews()) == 1 and all(slot.link == "OBJECT" for slot in result.material_slots)
    shown = picture(room)[60:68, 44:52].mean(axis=(0, 1))
    linear = np.array((0.2, 0.5, 0.8)) * tint
    assert np.abs(shown - (1.055 * linear ** (1 / 2.4) - 0.055)).max() < 0.01


def test_what_it_adds_leaves_the_light_of_others_as_it_is(blank, room):
    wall = scene_of(blank)
    box = bpy.data.objects["Box"]
    result = parts.generate()
    small = wall.copy()
    blank.scene.collection.objects.link(small)
    small.scale = (0.4, 0.4, 0.4)
    small.location.y -= 0.2
    blank.view_layer.update()
    bpy.ops.reflection_mesh.light(samples=1)
    parts.select(box, small)
    parts.generate(preview=True)
    blank.view_layer.update()
    assert previews() and not outdated(room, result)
    # but mirrors show the light of others
    bpy.ops.reflection_mesh.caustics(leave_out=False)
    blank.view_layer.update()
    assert outdated(room, result)


@pytest.mark.thorough
@pytest.mark.parametrize("link", ["DATA", "OBJECT"])
def test_what_the_user_put_in_its_place_stays_and_outlasts_light(blank, link):
    scene_of(blank)
    result = parts.generate(preview=link == "OBJECT")
    mine = parts.material("Mine")
    assert result.material_slots[0].link == link
    result.material_slots[0].material = mine
    result = parts.generate(preview=True)
    assert result.material_slots[0].material == mine and len(previews()) == 1
    bpy.ops.reflection_mesh.light(samples=1)
    bpy.data.objects["Box"].location.x += 0.1
    for preview in (False, True):
        result = parts.generate(preview=preview)
        assert result.material_slots[0].material == mine
    assert len(previews()) == 1


def test_what_looks_right_as_it_is_needs_none(blank):
    plain_scene()
    parts.generate(preview=True)
    assert not previews()


def test_an_error_while_writing_leaves_none(blank, room, monkeypatch):
    scene_of(blank)
    before = lit_state()

    def fail(*_):
        raise ZeroDivisionError("a number is zero")
    preview = room("addon.lighting.preview")
    made, work = [], preview._preview

    def second_fails(*arguments):
        if made:
            fail()
        made.append(work(*arguments))
        return made[0]
    monkeypatch.setattr(preview, "_preview", second_fails)
    with pytest.raises(RuntimeError):
        parts.generate(preview=True)
    assert made and lit_state() == before


@pytest.mark.thorough
def test_a_source_without_material_is_grey(blank, room):
    facing_card(blank)
    bpy.data.objects["Card"].data.materials.clear()
    parts.generate(preview=True)
    shown = picture(room)[60:68, 44:52].mean(axis=(0, 1))
    linear = 0.8 * np.array(TINT)
    assert np.abs(shown - (1.055 * linear ** (1 / 2.4) - 0.055)).max() < 0.01

