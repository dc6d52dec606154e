"""Every word that the interface shows, as Blender and the sources know them."""
from __future__ import annotations

import ast
from pathlib import Path

import bpy

from tools.extension_zip import PACKAGE

ROOT = Path(__file__).resolve().parents[3]
KINDS = (bpy.types.Operator, bpy.types.Panel, bpy.types.Menu)
# of the records that files hold, what panels draw
DRAWN = {"ReflectionScene", "ReflectionObject", "ReflectionLive"}
# rooms whose sentences are drawn, with the names of the functions that say them; all where none is named
TELLING = {"addon/faults/status_bar.py": set(), "addon/faults/stepped_operator.py": set(),
           "addon/lighting/lit_results.py": {"light_sentence"}, "addon/interface/prompts.py": set(),
           "addon/comparison/show_comparison.py": set(),
           "addon/freshness/made_from.py": {"why_stale", "_changed", "difference"},
           "addon/freshness/thrown_light.py": {"why_light_is_stale", "_changed", "_difference"},
           **{path.relative_to(ROOT).as_posix(): set() for path in (ROOT / "addon" / "interface").glob("draw_*.py")}}
SENTENCES = ("IN_OBJECT_MODE", "NOTHING_TO_LIGHT", "NOTHING_TO_CLEAR", "NO_SHEET", "NO_CAMERA", "NO_MIRROR", "NO_USD",
             "SIZE_DIFFERS", "WAITS", "NOTHING_YET", "LINKED_SCENE", "LINKED_TO_LIGHT", "LINKED_TO_CLEAR", "NO_RESULT",
             "NO_OBJECT", "LINKED_OBJECT")


def classes() -> list[type]:
    """The registered operators, panels, menus and drawn records of the extension."""
    found = [cls for kind in KINDS for cls in kind.__subclasses__() if cls.__module__.startswith(PACKAGE)]
    records = [cls for cls in bpy.types.PropertyGroup.__subclasses__() if cls.__module__.startswith(PACKAGE)]
    return found + [cls for cls in records if cls.__name__ in DRAWN]


def words(drawn: set) -> set[str]:
    """Names and descriptions of classes, options and choices, and all that is drawn as text or told by a grey button.

    Parameters
    ----------
    drawn : set
        Names of the records' properties that panels draw.
    """
    found = set()
    for cls in classes():
        rna = cls.bl_rna
        if issubclass(cls, bpy.types.Operator):
            rna = getattr(bpy.ops.reflection_mesh, cls.bl_idname.rpartition(".")[2]).get_rna_type()
        own = {name for base in cls.__mro__ if base.__module__.startswith(PACKAGE)
               for name in base.__dict__.get("__annotations__", {})}
        if cls.__name__ in DRAWN:
            own &= drawn
        else:
            found.add(getattr(cls, "bl_label", rna.name))
        if issubclass(cls, bpy.types.Operator):
            found.add(rna.description)
        for name in own:
            entry = rna.properties[name]
            if not entry.is_hidden:
                found |= {entry.name, entry.description}
                found |= {text for item in getattr(entry, "enum_items", ()) for text in (item.name, item.description)}
    for path, functions in TELLING.items():
        found |= _drawn_literals(ast.parse((ROOT / path).read_text(encoding="utf-8")), functions)
    for path in (ROOT / "addon").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") in SENTENCES:
                found.add(ast.literal_eval(node.value))
            if isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") == "DIFFERENT":
                found.update(ast.literal_eval(node.value).values())
    return found - {""}


def without_a_tip() -> list[str]:
    """Operators, and what they ask for, that say nothing where the mouse rests on them; a choice does in its items."""
    found = []
    for cls in (cls for cls in classes() if issubclass(cls, bpy.types.Operator) or cls.__name__ in DRAWN):
        rna = cls.bl_rna
        if issubclass(cls, bpy.types.Operator):
            rna = getattr(bpy.ops.reflection_mesh, cls.bl_idname.rpartition(".")[2]).get_rna_type()
            found += [] if rna.description else [cls.bl_idname]
        own = {name for base in cls.__mro__ if base.__module__.startswith(PACKAGE)
               for name in base.__dict__.get("__annotations__", {})}
        found += [f"{cls.__name__}.{name}" for name in own if not rna.properties[name].is_hidden
                  and not rna.properties[name].description]
    return found


def _drawn_literals(tree: ast.AST, functions: set) -> set[str]:
    """The literals of the functions that are named; of a whole room those that are labels or asked to be translated."""
    if functions:
        bodies = [node for node in ast.walk(tree) if getattr(node, "name", "") in functions]
        return {node.value for body in bodies for part in body.body[1:] for node in ast.walk(part)
                if isinstance(node, ast.Constant) and isinstance(node.value, str)}
    found = set()
    for call in ast.walk(tree):
        if not isinstance(call, ast.Call):
            continue
        name = getattr(call.func, "attr", getattr(call.func, "id", ""))
        texts = call.args[:1] if name.startswith("pgettext") else [entry.value for entry in call.keywords
                                                                   if entry.arg == "text"]
        # a choice between two texts holds both; what is formatted is translated as it stands before
        found |= {node.value for text in texts for branch in _branches(text) for node in [branch]
                  if isinstance(node, ast.Constant) and isinstance(node.value, str)}
    return found


def _branches(node: ast.AST) -> list:
    return [node.body, node.orelse] if isinstance(node, ast.IfExp) else [node]
