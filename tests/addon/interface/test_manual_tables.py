"""The tables of the documents: every setting and option is told of as it is, and nothing else."""
from __future__ import annotations

import re
from pathlib import Path

import bpy
import parts
import pytest

DOCS = Path(__file__).parents[3] / "docs"
OPERATORS = {"Generate": "generate", "Light": "light", "Caustics": "caustics", "Bake": "bake", "Compare": "compare",
             "Mirror UVs": "mirror_uvs", "Print": "print_sheet"}
VERBS = {"Print": "mirror-uvs", "Mirror UVs": "mirror-uvs"}
UNTOLD = {"rna_type", "filter_glob"}


def rows(page: str, *heads: str) -> list[list[str]]:
    """The rows of the tables that begin with these heads."""
    found, inside = [], False
    for line in (DOCS / page).read_text(encoding="utf-8").splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")] if line.startswith("|") else []
        inside = cells[:len(heads)] == list(heads) or (inside and bool(cells))
        if inside and cells[:len(heads)] != list(heads) and not cells[0].startswith("---"):
            found.append(cells)
    return found


def words(entry: bpy.types.Property) -> str:
    """The default of a property as the manual writes it."""
    if entry.type == "ENUM":
        return entry.enum_items[entry.default].name
    return ("on" if entry.default else "off") if entry.type == "BOOLEAN" else f"{entry.default:g}"


def properties(operator: str) -> dict:
    return {entry.identifier: entry for entry in getattr(bpy.ops.reflection_mesh, operator).get_rna_type().properties
            if entry.identifier not in UNTOLD}


def settings(room) -> tuple[str, ...]:
    place = room("addon.settings")
    return place.SETTINGS + place.LIGHT_SETTINGS + place.WRITTEN_SETTINGS


def test_the_manual_tells_of_every_setting_and_what_it_is_at_first(room):
    known = bpy.context.scene.reflection_mesh.bl_rna.properties
    told = rows("manual.md", "Setting", "At first")
    assert sorted(row[3].strip("`") for row in told) == sorted(settings(room))
    for name, first, _, identifier in told:
        entry = known[identifier.strip("`")]
        assert (name, first.removesuffix(" pixels").removesuffix(" per pixel")) == (entry.name, words(entry))


def test_the_manual_tells_of_every_option(room):
    """By its name, of the operators that have it."""
    told = {(OPERATORS[of], python.strip("`")): name for name, ofs, _, python, _ in rows("manual.md", "Option", "Of")
            for of in ofs.split(", ")}
    there = {(operator, identifier): entry.name for operator in OPERATORS.values()
             for identifier, entry in properties(operator).items() if identifier not in settings(room)}
    assert told == there


def test_the_manual_names_all_that_there_is_to_choose(blank):
    told = set(re.findall(r"`([A-Z]+)`", (DOCS / "manual.md").read_text(encoding="utf-8")))
    kept = list(bpy.context.scene.reflection_mesh.bl_rna.properties)
    roles = bpy.data.objects.new("Any", None).reflection_mesh.bl_rna.properties["role"]
    asked = [entry for operator in OPERATORS.values() for entry in properties(operator).values()]
    assert {item.identifier for entry in [*kept, *asked, roles] if entry.type == "ENUM"
            for item in entry.enum_items} - told == set()


def test_the_command_line_has_what_the_manual_says(room, capsys):
    run = room("addon.command_line").run
    for name, ofs, _, _, options in rows("manual.md", "Option", "Of"):
        for of in ofs.split(", ")[:1] if name == "What" else ofs.split(", "):
            assert run([VERBS.get(of, of.lower()), "--help"]) == 0
            helped = capsys.readouterr().out
            asked = [option for option in re.findall(r"`(--[\w-]+)", options.partition("; of *Generate*")[0])]
            assert all(re.search(rf"{option}\b", helped) for option in asked), (name, of)


@pytest.mark.parametrize("method", ["GENERAL", "POINTS"])
def test_a_result_carries_what_the_documents_say(blank, method):
    cube = parts.add("cube", "Box", size=1.0, location=(0.0, -1.5, 1.0))
    cube.data.materials.append(parts.material("Plain"))
    mirror = parts.add_wall_mirror("Mirror")
    parts.select(cube, mirror)
    parts.generate(method=method)
    carried = bpy.data.objects["Mirror Reflection"].data.attributes
    kinds = {"vector": "FLOAT_VECTOR", "float": "FLOAT", "integer": "INT"}
    told = rows("results.md", "attribute", "domain")
    assert len(told) == 8
    for name, domain, kind, _ in told:
        name = name.strip("`")
        if method == "POINTS" and name == "bounces":
            assert name not in carried and "radius" in carried
            continue
        wanted = "POINT" if method == "POINTS" else domain.upper()
        assert (carried[name].domain, carried[name].data_type) == (wanted, kinds[kind]), name


def test_faces_name_the_triangle_that_they_show(blank):
    """As the documents say: by its number in the evaluated mesh of a source."""
    cube = parts.add("cube", "Box", size=1.0, location=(0.0, -1.5, 1.0))
    mirror = parts.add_wall_mirror("Mirror")
    parts.select(cube, mirror)
    parts.generate()
    result = bpy.data.objects["Mirror Reflection"]
    known = result.data.attributes
    source = result.reflection_mesh.sources[known["source_object"].data[0].value].object
    shown = source.evaluated_get(bpy.context.evaluated_depsgraph_get())
    shown.data.calc_loop_triangles()
    for face in result.data.polygons:
        triangle = shown.data.loop_triangles[known["source_face"].data[face.index].value]
        place = shown.matrix_world @ shown.data.vertices[triangle.vertices[0]].co
        for vertex in face.vertices:
            away = known["reflected_position"].data[vertex].vector - place
            assert abs(away @ (shown.matrix_world.to_3x3() @ triangle.normal)) < 1e-5
            way = known["reflected_position"].data[vertex].vector - known["mirror_position"].data[vertex].vector
            assert known["path_length"].data[vertex].value == pytest.approx(way.length, rel=1e-5)
