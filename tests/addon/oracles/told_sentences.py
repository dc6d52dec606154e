"""The sentences that operators tell, as the sources write them down: with `{}` where names and numbers are put in."""
from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

from interface_words import ROOT

# told in a terminal or on pages, drawn as words, or for whoever calls `core` with arrays
ELSEWHERE = ("addon/command_line", "addon/benchmark", "addon/report", "addon/comparison/compare_im",
             "addon/comparison/compare_page", "addon/comparison/light_page", "addon/interface",
             "addon/run_with_bpy", "core/rivals", "core/solver")
# functions that put a sentence together: each of their parts counts
WHOLE = {"summary", "light_summary", "frames_listed"}
COUNTED = "one_or_more"     # a call of which each text counts: what is said of one thing, and of more
SHORTEST = 12
UNSHOWN = ("addon/command_line", "addon/benchmark", "core/rivals", "core/solver")   # work that no status bar tells of


def told() -> set[str]:
    """Every sentence that may be told in a window."""
    return {text for text, room, function in _texts() if not room.startswith(ELSEWHERE)
            # arguments that are none
            and not (room.startswith("core") and " must " in text)
            and ((text.endswith(".") and " " in text and len(text) >= SHORTEST)
                 or (function in WHOLE and "{}" in text and any(map(str.isalpha, text)))
                 or (function == COUNTED and any(map(str.isalpha, text))))}


def written() -> set[str]:
    """Every text in the sources."""
    return {text for text, room, _ in _texts() if not room.startswith("addon/interface/german")}


def reports() -> list[str]:
    """Where something is reported that no language sees."""
    return [f"{path.name}:{node.lineno}" for path in sorted((ROOT / "addon").rglob("*.py")) if path.name != "told.py"
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
            if isinstance(node, ast.Call) and getattr(node.func, "attr", "") == "report"]


def stages() -> set[str]:
    """Every stage of work that a status bar shows, and what is put into those."""
    found: set[str] = set()
    for path, room in _rooms():
        if not room.startswith((*UNSHOWN, "addon/interface")):
            tree = ast.parse(path.read_text(encoding="utf-8"))
            names = {node.targets[0].id: node.value for node in tree.body
                     if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name)}
            for node in ast.walk(tree):
                for text in _stage_of(node):
                    found.update(_written_out(names.get(getattr(text, "id", ""), text)))
    return {text for text in found if any(map(str.isalpha, text))}


def _stage_of(node: ast.AST) -> list[ast.AST]:
    """Where a piece of source tells of a stage: the stage."""
    if isinstance(node, ast.Yield) and node.value is not None:
        return [node.value.elts[1] if isinstance(node.value, ast.Tuple) else node.value]
    if not isinstance(node, ast.Call):
        return []
    name = getattr(node.func, "attr", getattr(node.func, "id", ""))
    last = {"next": 2, "tell": 2, "part": 4, "taken": 3, "_named": 2, "shown_while": 3, "render_stage": 1}.get(name)
    return [node.args[-1]] if last == len(node.args) else []


def _written_out(text: ast.AST) -> list[str]:
    """A text with `{}` where something is put in; none of what is no text."""
    if isinstance(text, ast.IfExp):
        return _written_out(text.body) + _written_out(text.orelse)
    if isinstance(text, ast.Call):
        # Undivided("..."), or "...".strip()
        return _written_out(text.func.value if isinstance(text.func, ast.Attribute) else (text.args or [text.func])[0])
    return [found for found, _ in _of(text, "")][:1] if isinstance(text, ast.Constant | ast.JoinedStr) else []


def _texts() -> Iterator[tuple[str, str, str]]:
    for path, room in _rooms():
        yield from ((text, room, function) for text, function in _of(ast.parse(path.read_text(encoding="utf-8")), ""))


def _rooms() -> list[tuple[Path, str]]:
    return [(path, path.relative_to(ROOT).as_posix()) for base in ("addon", "core")
            for path in sorted((ROOT / base).rglob("*.py"))]


def _of(node: ast.AST, function: str) -> Iterator[tuple[str, str]]:
    """The texts of a piece of source, with the functions that they are in, without what describes it."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        yield node.value, function
    if isinstance(node, ast.JoinedStr):
        yield "".join(part.value if isinstance(part, ast.Constant) else "{}" for part in node.values), function
        # a text that is put into this one
        for part in (part for part in node.values if isinstance(part, ast.FormattedValue)):
            yield from _of(part.value, function)
        return
    if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
        return
    if isinstance(node, ast.keyword) and node.arg in {"description", "name", "help"}:
        return
    if isinstance(node, ast.FunctionDef):
        function = node.name
    if isinstance(node, ast.Call) and getattr(node.func, "id", "") == COUNTED:
        function = COUNTED
    for child in ast.iter_child_nodes(node):
        yield from _of(child, function)
