"""The verbs of the command line through PyPI's `bpy`, from a checkout, without a Blender installed:

    python addon/run_with_bpy.py scene.blend generate --tolerance 0.5 --output result.blend
    python addon/run_with_bpy.py one.blend two.blend benchmark --output folder
"""
import importlib.util
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
    # every .blend before the verb is a scene; only a benchmark takes several
    count = next((k for k, argument in enumerate(arguments) if not argument.endswith(".blend")), len(arguments))
    files, arguments = arguments[:max(count, 1)], arguments[max(count, 1):]
    if not arguments or (len(files) > 1 and arguments[0] != "benchmark"):
        print("Usage: python addon/run_with_bpy.py scene.blend "
              "generate|light|caustics|bake|mirror-uvs|compare|benchmark [options]", file=sys.stderr)
        return 2
    if len(files) > 1:
        arguments += ["--scenes", *files]
    try:
        return _run(arguments, files[0])
    except KeyboardInterrupt:
        print("Interrupted: nothing has been saved.", file=sys.stderr)
        return 130


def _run(arguments: list[str], scene: str) -> int:
    try:
        import bpy  # noqa: F401
    except ImportError:
        print("Error: Python has no module bpy: install it with 'pip install bpy', or use Blender's own command line.",
              file=sys.stderr)
        return 1
    extension = load_extension()
    try:
        return importlib.import_module(f"{PACKAGE}.addon.command_line").run(arguments, scene)
    finally:
        # bpy may crash at its end where classes are still registered
        extension.unregister()


if __name__ == "__main__":
    # Python puts this folder first, where Blender's own add-ons would find ours in place of theirs
    sys.path.pop(0)
    sys.exit(main(sys.argv[1:]))
