"""The samples whose mirrors throw light: what falls where, and how the pool's waves move."""
from __future__ import annotations

from pathlib import Path

import bpy
import numpy as np
import parts
import pytest
from mathutils import Vector

FOLDER = Path(__file__).resolve().parents[3] / "sample_blends"
SAMPLES = {"ring": ("Ring", {"Table"}), "pool": ("Water", {"Right Wall", "Lifebuoy"}),
           "sunlight": ("Round Mirror", {"Floor", "Shelf", "Bottle"}), "dish": ("Dish", {"Table"})}


def thrown(name: str) -> bpy.types.Object:
    """The light of a sample as it is opened."""
    bpy.ops.wm.open_mainfile(filepath=str(FOLDER / f"{name}.blend"))
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    made, = (obj for obj in bpy.data.objects if obj.reflection_mesh.role == "CAUSTICS")
    return made


def lit(result: bpy.types.Object) -> tuple:
    """Irradiance (m,), area (m,), and the name of what is lit, of each face."""
    corners = parts.attribute(result, "position").astype(np.float64)[parts.corners(result)]
    area = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    names = np.array([source.object.name for source in result.reflection_mesh.sources])
    return (parts.attribute(result, "irradiance").reshape(-1, 3).mean(axis=1), area,
            names[parts.attribute(result, "source_object")])


@pytest.mark.thorough
@pytest.mark.parametrize("name", SAMPLES)
def test_light_falls_where_it_is_to_be_seen(name):
    mirror, receivers = SAMPLES[name]
    result = thrown(name)
    assert (FOLDER / f"{name}.blend").stat().st_size < 300_000
    assert result.name == f"{mirror} Caustics"
    irradiance, area, where = lit(result)
    assert np.isfinite(irradiance).all() and (irradiance >= 0.0).all()
    bright = {receiver for receiver in receivers if (irradiance * area)[where == receiver].sum() > 0.0}
    assert bright == receivers


def test_a_flat_mirror_keeps_the_sun_as_bright_as_it_is(capfd):
    """On the floor, by the law: the sun's irradiance, the mirror's tint, the cosine."""
    irradiance, area, where = lit(thrown("sunlight"))
    # one layer of light alone
    assert "transparent layers" not in capfd.readouterr().out
    sun, tint = bpy.data.objects["Sun"], np.array((0.93, 0.94, 0.92))
    way = sun.matrix_world.to_3x3() @ Vector((0.0, 0.0, 1.0))
    # a metal is whiter the more it is met from the side
    tint += (1.0 - tint) * (1.0 - abs(way.y)) ** 5
    expected = way.z * (np.array(sun.data.color) * sun.data.energy * tint).mean()
    floor = where == "Floor"
    # all of the patch, whatever the faces at its border are
    assert np.average(irradiance[floor], weights=area[floor]) == pytest.approx(expected, rel=2e-4)
    even = np.abs(irradiance[floor] / expected - 1.0) < 1e-3
    assert area[floor][even].sum() > 0.98 * area[floor].sum()


def test_the_pools_waves_move_and_come_back():
    bpy.ops.wm.open_mainfile(filepath=str(FOLDER / "pool.blend"))
    scene, water = bpy.context.scene, bpy.data.objects["Water"]

    def heights(frame: int) -> np.ndarray:
        scene.frame_set(frame)
        mesh = water.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
        places = np.empty(3 * len(mesh.vertices), dtype=np.float32)
        mesh.vertices.foreach_get("co", places)
        return places[2::3]
    first = heights(1)
    assert 0.003 < np.ptp(first) < 0.05
    assert np.abs(heights(2) - first).max() > 1e-4
    assert (scene.frame_start, scene.frame_end) == (1, 48) and np.abs(heights(49) - first).max() < 1e-6


def test_slivers_between_layers_shine_no_more_than_falls_on_them():
    """They stand between the heights of two layers, where these meet on the curve, and had shone like sparks."""
    made = thrown("dish")
    _, area, names = lit(made)
    own = names == "Table"
    corners = parts.attribute(made, "position").astype(np.float64)[parts.corners(made)][own]
    x, y = np.moveaxis((corners - corners[:, :1])[:, 1:, :2], 2, 0)
    # the table is level
    level = 0.5 * np.abs(x[:, 0] * y[:, 1] - x[:, 1] * y[:, 0])
    given = level * parts.attribute(made, "irradiance").reshape(-1, 3)[own].mean(axis=1)
    shown = area[own] * parts.attribute(made, "caustic_light").reshape(-1, 9)[own].mean(axis=1)
    assert (shown - given).max() < 1e-5 * given.sum() and abs(shown.sum() / given.sum() - 1.0) < 1e-4
