"""The verbs of the command line through PyPI's `bpy`, from a checkout, without a Blender installed:

    python addon/run_with_bpy.py scene.blend generate --tolerance 0.5 --output result.blend
"""
import importlib.util
import os
import sys
from pathlib import Path

PACKAGE = "reflection_mesh"


def load_extension():
    """The checkout's root as the package `reflection_mesh`, registered."""
    if PACKAGE not in sys.modules:
        root = Path(__file__).resolve().parent.parent
        spec = importlib.util.spec_from_file_location(PACKAGE, root / "__init__.py",
                                                      submodule_search_locations=[str(root)])
        module = importlib.util.module_from_spec(spec)
        sys.modules[PACKAGE] = module
        spec.loader.exec_module(module)
        module.register()
    return sys.modules[PACKAGE]


def main(arguments: list[str]) -> int:
    if len(arguments) < 2:
        print("Usage: python addon/run_with_bpy.py scene.blend generate|compare [options]", file=sys.stderr)
        return 2
    try:
        import bpy
    except ImportError:
        print("Error: Python has no module bpy: install it with 'pip install bpy', or use Blender's own command line.",
              file=sys.stderr)
        return 1
    extension = load_extension()
    try:
        bpy.ops.wm.open_mainfile(filepath=os.path.abspath(arguments[0]), use_scripts=False)
        return importlib.import_module(f"{PACKAGE}.addon.command_line").run(arguments[1:])
    except RuntimeError as error:
        print(str(error).strip(), file=sys.stderr)
        return 1
    finally:
        # bpy may crash at its end where classes are still registered
        extension.unregister()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
