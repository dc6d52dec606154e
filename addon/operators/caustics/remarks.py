"""Sentences for the user on what caustics lack."""
from __future__ import annotations

from collections import Counter
from functools import reduce
from operator import or_

import bpy
import numpy as np

from ....core import CausticMesh, TriangleMesh
from ...illumination import Caustic, is_bumped, is_sheared, let_through, light_of_nodes
from ...reading import DiffuseScene, MirrorSurface
from ..shortcomings import MISSED, MISSING, bounds_hit

COARSE = 15.0  # degrees between smooth normals and facets: at 23 a fifth of Cycles' light is missing, at 12 a thirtieth


def remarks_on(prepared: list[Caustic], unknown: list) -> list[str]:
    """Return sentences on approximations in the caustics `prepared`. `unknown` are materials of receivers whose colour
    is not fully known.
    """
    remarks = [f"The colour of '{material.name}' is not known all over, where it asks for what only its own "
               "object knows or its shaders send light back in another way than diffuse: its light may have "
               "another colour." for material in dict.fromkeys(unknown)]
    for lamp in dict.fromkeys(made.lamp for made in prepared):
        if lamp.type == "LIGHT" and not light_of_nodes(lamp.data)[1]:
            remarks.append(f"The nodes of '{lamp.name}' tell more than one colour and one strength: its light counts "
                           "as if the rest were unplugged.")
        if is_sheared(lamp):
            remarks.append(f"The lamp '{lamp.name}' is sheared: mirrors throw what they show of it, while Cycles "
                           "lights directly with more or less than that; apply the scale of its parent.")
    if not all(made.plain for made in prepared):
        remarks.append("A mirror's colour that changes over it in a way that only the mirror knows, or that light "
                       "meets after another mirror, counts as one colour: unplug it to choose which.")
    return remarks


def remarks_on_instances(instancers: list[bpy.types.Object]) -> list[str]:
    """Return sentences on objects that instance lamps."""
    return [f"No light is thrown of the lamps that '{obj.name}' instances: make them real (Object > Apply > Make "
            "Instances Real)." for obj in instancers]


def remarks_on_taking(scene: DiffuseScene, surfaces: dict[bpy.types.Object, MirrorSurface]) -> list[str]:
    """Return sentences on materials that stop light, and on mirrors (with their `surfaces`) that are coarse or have
    bumps or displacement.
    """
    return [*(f"Light ends at '{material.name}', though some of it would go through: give it an Alpha without a "
              "texture; of different ones no more than two count." for material in let_through(scene)),
            *(f"The mirror '{mirror.name}' is coarse and shaded smooth: Cycles bends its normals, and throws more "
              "light than is here; give it more faces, or shade it flat." for mirror, surface in surfaces.items()
              if _bends(surface.mesh) > COARSE),
            *(f"The material of '{mirror.name}' bends its normals or displaces it, which the light that it throws does "
              "not follow: model that, as by a Displace modifier." for mirror, surface in surfaces.items()
              if any(map(is_bumped, surface.materials)))]


def shortcomings_of_light(name: str, lit: list[CausticMesh]) -> list[str]:
    """Return sentences on the limits that the caustics `name` have reached and on what their probes have missed. `lit`
    holds the mesh of each part, for one point on the lamp each.
    """
    probes, missed = (sum(mesh.counts.get(what, 0) for mesh in lit) for what in ("probes", "missed"))
    share, told = 100.0 * missed / max(probes, 1), []
    if missed >= MISSED and share > MISSING:
        told.append(f"About {share:.0f} % of the light that the mirror throws is missing: give the mirror a clean "
                    "mesh, or move the lamp.")
    # each place sees about the same parts of the mirror
    most: Counter = reduce(or_, (Counter(mesh.counts) for mesh in lit))
    return [f"{name}: {sentence}" for sentence in told + bounds_hit(most)]


def _bends(mesh: TriangleMesh) -> float:
    """Return the mean angle in degrees between smooth normals and facets of a mesh; 0 if it is flat."""
    if mesh.corner_normals is None:
        return 0.0
    corners = mesh.positions[mesh.triangles]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    length = np.maximum(np.linalg.norm(mesh.corner_normals, axis=2), 1e-300)
    cosine = np.einsum("mkc,mc->mk", mesh.corner_normals, mesh.face_normals()) / length
    angle = np.degrees(np.arccos(np.clip(np.abs(cosine), 0.0, 1.0))).mean(axis=1)
    return float((angle * area).sum() / max(area.sum(), 1e-300))
