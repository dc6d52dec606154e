"""Imports go one way, packages have one public interface, functions are short. Only the source is read."""
import ast
import re
from collections import defaultdict
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
FILES = sorted(path for root in ("core", "addon") for path in (ROOT / root).rglob("*.py"))
LINES, PARAMETERS = 50, 6
BY_NAME = (("addon", "operators"), ("addon", "writing", "nodes"))  # packages whose modules others import too
ON_TOP = ("caustics", "rivals")  # packages that import `core` itself


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
def package_of(parts: tuple[str, ...]) -> str:
    """Return the package of `core` or `addon` in which a module lies: itself if in none, and an empty string for
    `__init__`.
    """
    if len(parts) < 2 or parts[1] == "__init__.py":
        return ""
    return parts[1] if (ROOT / parts[0] / parts[1]).is_dir() else parts[1].removesuffix(".py")


def imports_of_packages(root: str) -> dict[str, set[str]]:
    """Return, for each package of `root` (`core` or `addon`), the other packages of it that it imports."""
    under = defaultdict(set)
    for path in FILES:
        own = path.relative_to(ROOT).parts
        if own[0] == root and package_of(own):
            under[package_of(own)] |= {package_of(module) for module in imported(path)
                                  if module[0] == root and package_of(module) not in ("", package_of(own))}
    return under


def test_the_core_knows_of_no_blender():
    inside = [path for path in FILES if path.is_relative_to(ROOT / "core")]
    assert len(inside) > 100
    assert not [(path.name, module) for path in inside for module in imported(path)
                if module[0] in ("bpy", "mathutils", "addon")]


@pytest.mark.parametrize("root", ["core", "addon"])
def test_imports_go_one_way(root):
    left = imports_of_packages(root)
    while ready := [name for name, below in left.items() if not below & left.keys()]:
        for name in ready:
            del left[name]
    assert not left


def test_packages_are_imported_by_their_public_interface():
    beside = []
    for path in FILES:
        own = path.relative_to(ROOT).parts
        for module in imported(path):
            # what has modules itself is a package of its own
            if module[0] in ("core", "addon") and len(module) > 2 and not ROOT.joinpath(*module).is_dir() \
                    and (module[0] != own[0] or package_of(module) != package_of(own)) and module[:-1] not in BY_NAME:
                beside.append(("/".join(own), ".".join(module)))
    assert not beside


def test_the_map_is_true():
    """CONTRIBUTING.md names every package, and what each of the core imports, directly or by others."""
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines() if line[:2] == "| "]
    named = {root: {name for row in rows if len(row) == columns for name in re.findall(r"`(\w+)`", row[0])}
             for root, columns in (("core", 3), ("addon", 2))}
    for root, names in named.items():
        assert names == {path.name for path in (ROOT / root).iterdir() if (path / "__init__.py").exists()}
    imports = {name: set(re.findall(r"`(\w+)`", row[2])) for row in rows if len(row) == 3
                 for name in re.findall(r"`(\w+)`", row[0])}
    found = imports_of_packages("core")
    for name, below in imports.items():
        while wider := {lower for one in below for lower in imports[one]} - below:
            below |= wider
        if name not in ON_TOP:
            assert found[name] <= below, name


def test_functions_are_short_and_have_few_parameters():
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
