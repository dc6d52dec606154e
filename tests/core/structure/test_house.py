"""How the house stands: one direction of flow, floors with one door each, no crooked rooms. Only the source is read."""
import ast
import re
from collections import defaultdict
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
FILES = sorted(path for house in ("core", "addon") for path in (ROOT / house).rglob("*.py"))
LINES, PARAMETERS = 50, 6
BY_NAME = (("addon", "operators"), ("addon", "writing", "nodes"))  # floors whose rooms are asked for by their names too
ON_THE_DOOR = ("caustics", "rivals")  # floors that stand on the house itself


@cache
def tree_of(path: Path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"))


@cache
def imported(path: Path) -> list[tuple[str, ...]]:
    """The modules that a file imports, as parts of their names: relative ones from the project's root."""
    package, found = path.relative_to(ROOT).parts[:-1], []
    for node in ast.walk(tree_of(path)):
        if isinstance(node, ast.Import):
            found += [tuple(name.name.split(".")) for name in node.names]
        elif isinstance(node, ast.ImportFrom):
            base = package[:len(package) - node.level + 1] if node.level else ()
            module = base + tuple(node.module.split(".") if node.module else ())
            found += [module] if node.module else [(*module, name.name) for name in node.names]
    return found


@cache
def floor(parts: tuple[str, ...]) -> str:
    """The package of a house that a module lies in; of a room beside the house's door the room itself, and of the door
    nothing."""
    if len(parts) < 2 or parts[1] == "__init__.py":
        return ""
    return parts[1] if (ROOT / parts[0] / parts[1]).is_dir() else parts[1].removesuffix(".py")


def floors_under(house: str) -> dict[str, set[str]]:
    """What each floor of a house, and each room beside its door, imports of the others."""
    under = defaultdict(set)
    for path in FILES:
        own = path.relative_to(ROOT).parts
        if own[0] == house and floor(own):
            under[floor(own)] |= {floor(module) for module in imported(path)
                                  if module[0] == house and floor(module) not in ("", floor(own))}
    return under


def test_the_core_knows_of_no_blender():
    inside = [path for path in FILES if path.is_relative_to(ROOT / "core")]
    assert len(inside) > 100
    assert not [(path.name, module) for path in inside for module in imported(path)
                if module[0] in ("bpy", "mathutils", "addon")]


@pytest.mark.parametrize("house", ["core", "addon"])
def test_no_arrow_runs_back_up(house):
    left = floors_under(house)
    while ready := [name for name, below in left.items() if not below & left.keys()]:
        for name in ready:
            del left[name]
    assert not left


def test_floors_are_entered_by_their_door():
    beside = []
    for path in FILES:
        own = path.relative_to(ROOT).parts
        for module in imported(path):
            # what has rooms itself is a floor of its own
            if module[0] in ("core", "addon") and len(module) > 2 and not ROOT.joinpath(*module).is_dir() \
                    and (module[0] != own[0] or floor(module) != floor(own)) and module[:-1] not in BY_NAME:
                beside.append(("/".join(own), ".".join(module)))
    assert not beside


def test_the_map_of_the_house_is_true():
    """CONTRIBUTING.md names every floor of both houses, and what each of the core stands on, at last."""
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines() if line[:2] == "| "]
    named = {house: {name for row in rows if len(row) == columns for name in re.findall(r"`(\w+)`", row[0])}
             for house, columns in (("core", 3), ("addon", 2))}
    for house, names in named.items():
        assert names == {path.name for path in (ROOT / house).iterdir() if (path / "__init__.py").exists()}
    stands_on = {name: set(re.findall(r"`(\w+)`", row[2])) for row in rows if len(row) == 3
                 for name in re.findall(r"`(\w+)`", row[0])}
    under = floors_under("core")
    for name, below in stands_on.items():
        while wider := {lower for floor_ in below for lower in stands_on[floor_]} - below:
            below |= wider
        if name not in ON_THE_DOOR:
            assert under[name] <= below, name


def test_no_function_is_long_or_asks_for_much():
    found = []
    for path in FILES:
        for node in ast.walk(tree_of(path)):
            if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
                told = ast.get_docstring(node) is not None and len(node.body) > 1
                lines = node.end_lineno - (node.body[1] if told else node).lineno + 1
                asked = [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs]
                count = len(asked) - (bool(asked) and asked[0].arg in ("self", "cls"))
                if lines > LINES or count > PARAMETERS:
                    found.append((path.relative_to(ROOT).as_posix(), node.name, lines, count))
    assert not found
