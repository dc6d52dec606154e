"""Light after the camera has moved: what is still right is copied, and looks as light made anew does."""
from __future__ import annotations

import bpy
import parts
import pytest
from lamp_scenes import picture, principled, psnr, scene_of

pytestmark = pytest.mark.slow


@pytest.fixture
def shares(room, monkeypatch) -> list[float]:
    """Shares of the texels whose light is rendered, of each lighting."""
    kept, found = room("addon.lighting").KeptLight, []
    missing = kept.missing

    def counted(self, paths):
        new = missing(self, paths)
        found.append(new.used.sum() / paths.used.sum())
        return new
    monkeypatch.setattr(kept, "missing", counted)
    return found


def light(samples: int = 64) -> None:
    assert bpy.ops.reflection_mesh.light(samples=samples) == {"FINISHED"}


def move(obj: bpy.types.Object, by: float) -> None:
    obj.location.x += by
    bpy.context.view_layer.update()
    parts.select(bpy.data.objects["Mirror Reflection"])
    parts.generate()


def scene(context: bpy.types.Context, roughness: float) -> None:
    """The box and the floor of `scene_of` before a wall, so that the world is seen nowhere."""
    scene_of(context)
    floor = bpy.data.objects["Floor"]
    floor.data.materials[0] = principled("Tiles", (0.5, 0.5, 0.6), Roughness=roughness)
    back = parts.add("plane", "Back", size=30.0, location=(0.0, -9.0, 1.0), rotation=(1.57, 0.0, 0.0))
    back.data.materials.append(principled("Paint", (0.2, 0.3, 0.2)))
    parts.select(floor, back, bpy.data.objects["Box"], bpy.data.objects["Mirror"])
    parts.generate()


# the glossy floor is what is new: its highlight moves with the camera
@pytest.mark.parametrize(("roughness", "least", "most"), [(0.5, 0.0, 0.2), (0.1, 0.3, 0.6)])
def test_light_of_another_view_is_kept_where_it_is_right(blank, room, shares, roughness, least, most):
    scene(blank, roughness)
    light()
    move(blank.scene.camera, 0.1)
    light()
    kept = picture(room)
    # nothing has changed since, so that Light makes all of it anew
    light()
    fresh = picture(room)
    bpy.data.objects["Mirror Reflection"].hide_render = True
    reference = picture(room)
    assert shares[0] == shares[2] == 1.0 and least < shares[1] < most
    # measured: the same within 0.1 dB
    assert psnr(kept, reference) > psnr(fresh, reference) - 0.5


def dimmed() -> None:
    next(obj for obj in bpy.data.objects if obj.type == "LIGHT").data.energy *= 0.5


@pytest.mark.parametrize("change", [dimmed, lambda: move(bpy.data.objects["Mirror"], 0.05), lambda: light(4)])
def test_light_that_may_have_changed_is_made_anew(blank, shares, change):
    """Dimmed lamps, a mirror that throws its shadow elsewhere, and light that has more noise than is asked for."""
    scene(blank, 0.5)
    light(8)
    change()
    move(blank.scene.camera, 0.1)
    light(8)
    assert shares[-1] == 1.0
