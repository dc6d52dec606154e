"""The sentences that operators tell, as the sources write them down: with `{}` where names and numbers are put in."""
from __future__ import annotations

import ast
from collections.abc import Iterator

from interface_words import ROOT

# told in a terminal or on pages, drawn as words, or for whoever calls `core` with arrays
ELSEWHERE = ("addon/command_line", "addon/benchmark", "addon/report", "addon/comparison/compare_im",
             "addon/comparison/compare_page", "addon/comparison/light_page", "addon/interface",
             "addon/run_with_bpy", "core/rivals", "core/solver")
WHOLE = {"summary", "light_summary", "listed"}   # functions that put a sentence together: each of their parts counts
SHORTEST = 12


def told() -> set[str]:
    """Every sentence that may be told in a window."""
    return {text for text, room, function in _texts() if not room.startswith(ELSEWHERE)
            # arguments that are none
            and not (room.startswith("core") and " must " in text)
            and ((text.endswith(".") and " " in text and len(text) >= SHORTEST)
                 or (function in WHOLE and "{}" in text and any(map(str.isalpha, text))))}


def written() -> set[str]:
    """Every text in the sources."""
    return {text for text, room, _ in _texts() if not room.startswith("addon/interface/german")}


def reports() -> list[str]:
    """Where something is reported that no language sees."""
    return [f"{path.name}:{node.lineno}" for path in sorted((ROOT / "addon").rglob("*.py")) if path.name != "told.py"
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
            if isinstance(node, ast.Call) and getattr(node.func, "attr", "") == "report"]


def _texts() -> Iterator[tuple[str, str, str]]:
    for base in ("addon", "core"):
        for path in sorted((ROOT / base).rglob("*.py")):
            room = path.relative_to(ROOT).as_posix()
            yield from ((text, room, function)
                        for text, function in _of(ast.parse(path.read_text(encoding="utf-8")), ""))


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
    for child in ast.iter_child_nodes(node):
        yield from _of(child, function)
