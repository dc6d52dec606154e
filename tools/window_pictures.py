"""The documents' pictures of Blender's window: buttons, panels, menu, search and status bar as they are today.

    blender --enable-event-simulate --python tools/window_pictures.py [-- picture ...]

from the folder of this repository, on an X screen of 1600 x 900 with ImageMagick and xdotool, and without a window
manager (`make window-pictures` has one). It installs the extension as a zip, into preferences that are thrown away
(BLENDER_USER_RESOURCES), opens samples, and leaves in docs/pictures

- `blender.jpg`: the sphere, its reflection active, in the sidebar and in Object properties;
- `settings.jpg`: the sidebar with a mirror, with its reflection, and in German, with settings of the mirror's own;
- `ways_in.jpg`: the menu, F3, and progress in the status bar;
- `stale.jpg`: what the sidebar says of a reflection that is stale, and while Live is on;
- `choices.jpg`: the roles, the presets, and the settings with *Limits* unfolded;
- `after_run.jpg`: the panels that F9 opens after Generate and after Light;
- `attributes.jpg`: the list of a reflection's attributes, with all of them and with those that are shown;
- `grey.jpg`: a grey button, and the tip that says why;
- `figures.jpg`: *Figures*, and *Compare and Print* after a comparison;
- `bake.jpg`: the file browser of Bake Reflection Frames, with its options;
- `mirror_uvs.jpg`: the panel that F9 opens after Write Mirror UVs, and the anamorphosis in its mirror.

How they are taken is in `tools/pictures/in_window`.
"""
import importlib
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests" / "window"))

import bpy
import hands

from tools.pictures.in_window import panels, runs


def steps():
    hands.SHOTS = Path(tempfile.mkdtemp())
    screen = hands.Screen()
    screen.point(**screen.centre)
    yield 1.0
    screen.press("ESC")
    bpy.ops.extensions.package_install_files(filepath=str(hands.built_zip()), repo="user_default",
                                             enable_on_install=True)
    yield 1.0
    bake = importlib.import_module("bl_ext.user_default.reflection_mesh.addon.operators.bake_frames.bake_operator")
    # those that Linux distributions build have none, and a grey button
    vars(bake)["writes_usd"] = lambda: True
    asked = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
    for name, take in PICTURES.items():
        if not asked or name in asked:
            yield from take()


PICTURES = {"blender": panels.whole_window, "settings": panels.settings, "ways_in": runs.ways_in,
            "stale": panels.stale, "choices": panels.choices, "after_run": runs.after_run,
            "attributes": panels.attributes, "grey": panels.grey, "figures": panels.figures, "bake": runs.bake,
            "mirror_uvs": runs.mirror_uvs}
hands.run(steps)
