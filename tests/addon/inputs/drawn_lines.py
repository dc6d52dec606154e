"""What Line Art draws, mirrors to draw in, and where edges are seen in them."""
from __future__ import annotations

import bpy
import numpy as np
import parts

BESIDE = (2.0, -2.5, 1.0)  # its image is seen in the mirrors, itself not
INNER = -2
EDGES = [(0, 1), (2, 3), (4, 5), (6, 7), (0, 2), (1, 3), (4, 6), (5, 7), (0, 4), (1, 5), (2, 6), (3, 7)]


def add_line_art(source: bpy.types.Object) -> tuple[bpy.types.Object, bpy.types.Modifier]:
    """Line Art of an object, by its defaults: the object that draws it, and its modifier."""
    if bpy.app.version < (4, 3, 0):
        bpy.ops.object.gpencil_add(type="LINEART_OBJECT")
    else:
        bpy.ops.object.grease_pencil_add(type="LINEART_OBJECT")
    drawn = bpy.context.object
    modifier = (drawn.grease_pencil_modifiers if bpy.app.version < (4, 3, 0) else drawn.modifiers)[0]
    modifier.source_type, modifier.source_object = "OBJECT", source
    return drawn, modifier


def line_art(source: bpy.types.Object, *kinds: str) -> list:
    """The strokes that Line Art draws of an object in the render's pixels, (n, 2) each; by its defaults, or those
    `kinds` alone."""
    drawn, modifier = add_line_art(source)
    for kind in ("contour", "crease", "material", "edge_mark", "intersection", "loose") if kinds else ():
        setattr(modifier, f"use_{kind}", kind in kinds)
    evaluated = drawn.evaluated_get(bpy.context.evaluated_depsgraph_get())
    frames = [frame for layer in evaluated.data.layers for frame in layer.frames]
    if bpy.app.version < (4, 3, 0):
        strokes = [[point.co[:] for point in stroke.points] for frame in frames for stroke in frame.strokes]
    else:
        strokes = [[point.position[:] for point in stroke.points] for frame in frames
                   for stroke in frame.drawing.strokes]
    bpy.data.objects.remove(drawn)
    return [pixels(np.array(stroke)) for stroke in strokes]


def pixels(places: np.ndarray) -> np.ndarray:
    """Where the render shows places (n, 3) that lie before the camera, in pixels from the lower left corner."""
    scene, graph = bpy.context.scene, bpy.context.evaluated_depsgraph_get()
    size = np.array((scene.render.resolution_x, scene.render.resolution_y))
    matrix = scene.camera.calc_matrix_camera(graph, x=size[0], y=size[1]) @ scene.camera.matrix_world.inverted()
    clip = np.column_stack((places, np.ones(len(places)))) @ np.array(matrix).T
    return 0.5 * (clip[:, :2] / clip[:, 3:] + 1.0) * size


def off_lines(points: np.ndarray, lines: list) -> np.ndarray:
    """How far points (n, 2) are from the nearest of several polylines (m, 2)."""
    start, end = (np.concatenate([line[part] for line in lines]) for part in (slice(None, -1), slice(1, None)))
    along = end - start
    share = ((points[:, None] - start) * along).sum(axis=2) / np.maximum((along * along).sum(axis=1), 1e-12)
    foot = start + np.clip(share, 0.0, 1.0)[:, :, None] * along
    return np.linalg.norm(points[:, None] - foot, axis=2).min(axis=1)


def dense(lines: list) -> np.ndarray:
    """Points (n, 2) on polylines, twenty to each of their sides."""
    share = np.linspace(0.0, 1.0, 20)[:, None, None]
    return np.concatenate([(line[:-1] * (1.0 - share) + line[1:] * share).reshape(-1, 2) for line in lines])


def smooth(obj: bpy.types.Object) -> None:
    obj.data.polygons.foreach_set("use_smooth", np.ones(len(obj.data.polygons), dtype=bool))
    obj.data.update()


def add_mirror(kind: str) -> bpy.types.Object:
    """The wall, or a ball that is round to a thousandth."""
    if kind == "wall":
        return parts.add_wall_mirror()
    ball = parts.add("uv_sphere", "Mirror", radius=2.0, segments=256, ring_count=128, location=(0.0, 3.0, 1.0))
    smooth(ball)
    return ball


def seen_at(kind: str, points: np.ndarray) -> np.ndarray:
    """Where on the mirror the camera sees points (n, 3): the wall's plane, or the round ball, by bisection."""
    eye = np.array(bpy.context.scene.camera.location)
    if kind == "wall":
        mirrored = points * (1.0, -1.0, 1.0) + (0.0, 2.0, 0.0)
        return eye + (mirrored - eye) * ((1.0 - eye[1]) / (mirrored[:, 1:2] - eye[1]))
    centre = np.array((0.0, 3.0, 1.0))
    one = (eye - centre) / np.linalg.norm(eye - centre)
    across = points - centre - ((points - centre) @ one)[:, None] * one
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    low, high = np.zeros(len(points)), np.arctan2(((points - centre) * across).sum(axis=1), (points - centre) @ one)
    for _ in range(60):
        angle = 0.5 * (low + high)
        normal = np.cos(angle)[:, None] * one + np.sin(angle)[:, None] * across
        place = centre + 2.0 * normal
        back, on = (way / np.linalg.norm(way, axis=1, keepdims=True) for way in (eye - place, points - place))
        late = (back * normal).sum(axis=1) < (on * normal).sum(axis=1)
        low, high = np.where(late, low, angle), np.where(late, angle, high)
    return place


def cube_edges(box: bpy.types.Object, kind: str) -> tuple[list, list]:
    """The visible edges of a unit cube as the mirror shows them, in pixels, and which of the twelve they are."""
    corners = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
    matrix = np.array(box.matrix_world)
    share = np.linspace(0.0, 1.0, 60)[:, None]
    lines, seen = [], []
    for number, (first, second) in enumerate(EDGES):
        local = corners[first] * (1.0 - share) + corners[second] * share
        places = seen_at(kind, local @ matrix[:3, :3].T + matrix[:3, 3])
        from_mirror = (places - matrix[:3, 3]) @ matrix[:3, :3]  # in the cube's own space
        faces = [axis for axis in range(3) if corners[first][axis] == corners[second][axis]]
        fronts = [from_mirror[:, axis] * np.sign(corners[first][axis]) > 0.5 for axis in faces]
        if np.any(fronts):
            assert np.any(fronts, axis=0).all()
            lines.append(pixels(places))
            seen.append(number)
    return lines, seen


def meeting(box: bpy.types.Object, other: bpy.types.Object, kind: str) -> np.ndarray:
    """Points (n, 2), in pixels, of the curve where two cubes that pass through each other meet, as the mirror shows it:
    where steps along one cube's faces enter the other or leave it, and the mirror sees both faces from before."""
    matrix, inverse = np.array(other.matrix_world), np.array(box.matrix_world.inverted())
    half = 0.5 * other.dimensions.x / other.scale.x
    steps, found = half * np.linspace(-1.0, 1.0, 301), []
    for axis, side in ((axis, side) for axis in range(3) for side in (-1.0, 1.0)):
        grid = np.stack(np.meshgrid(steps, steps, [side * half], indexing="ij"), axis=-1)[:, :, 0]
        places = np.roll(grid, axis + 1, axis=-1) @ matrix[:3, :3].T + matrix[:3, 3]
        inside = np.abs(places @ inverse[:3, :3].T + inverse[:3, 3]).max(axis=-1) < 0.5
        for before, after in ((np.s_[:-1], np.s_[1:]), (np.s_[:, :-1], np.s_[:, 1:])):
            middle = 0.5 * (places[before] + places[after])[inside[before] != inside[after]]
            eye = seen_at(kind, middle)
            near = middle @ inverse[:3, :3].T + inverse[:3, 3]
            facing = np.abs(near).argmax(axis=1)
            outside = np.sign(np.take_along_axis(near, facing[:, None], axis=1)) * inverse[facing, :3]
            seen = (((eye - middle) @ (side * matrix[:3, axis]) > 0.0)
                    & (((eye - middle) * outside).sum(axis=1) > 0.0))
            found.append(eye[seen])
    return pixels(np.concatenate(found))


def apart(strokes: list, others: list) -> float:
    """The farthest that a point of strokes lies from the segments of others; light may cut faces, and lines with
    them."""
    starts, ends = (np.concatenate([stroke[part] for stroke in others]) for part in (slice(None, -1), slice(1, None)))
    points = np.concatenate(strokes)
    along = ends - starts
    part = np.einsum("pks,ks->pk", points[:, None] - starts, along) / np.maximum((along ** 2).sum(axis=1), 1e-12)
    nearest = starts + np.clip(part, 0.0, 1.0)[..., None] * along
    return float(np.linalg.norm(points[:, None] - nearest, axis=2).min(axis=1).max())
