"""Every poll of an operator or a panel answers, in every mode that there is without a window."""
from __future__ import annotations

import bpy
import parts
import pytest

from tests.window.polls import polls_of_the_extension

MODES = {"MESH": ("OBJECT", "EDIT", "SCULPT", "VERTEX_PAINT", "WEIGHT_PAINT", "TEXTURE_PAINT"),
         "CURVE": ("OBJECT", "EDIT"), "FONT": ("OBJECT", "EDIT"), "SURFACE": ("OBJECT", "EDIT"),
         "META": ("OBJECT", "EDIT"), "ARMATURE": ("OBJECT", "EDIT", "POSE"), "LATTICE": ("OBJECT", "EDIT"),
         "EMPTY": ("OBJECT",), "CURVES": ("OBJECT", "EDIT", "SCULPT_CURVES"), "PARTICLES": ("OBJECT", "PARTICLE_EDIT"),
         "GREASE PENCIL": ("OBJECT", *(("EDIT", "SCULPT_GREASE_PENCIL", "PAINT_GREASE_PENCIL", "WEIGHT_GREASE_PENCIL")
                                       if bpy.app.version >= (4, 3, 0) else
                                       ("EDIT_GPENCIL", "SCULPT_GPENCIL", "PAINT_GPENCIL", "WEIGHT_GPENCIL")))}
LEAST = 12  # classes that have one


def active_of(kind: str) -> None:
    if kind == "MESH":
        parts.add("cube", "Active")
    elif kind == "CURVE":
        bpy.ops.curve.primitive_bezier_circle_add()
    elif kind == "FONT":
        bpy.ops.object.text_add()
    elif kind == "SURFACE":
        bpy.ops.surface.primitive_nurbs_surface_sphere_add()
    elif kind == "META":
        bpy.ops.object.metaball_add()
    elif kind == "CURVES":
        parts.add("cube", "Skin")
        bpy.ops.object.curves_empty_hair_add()
    elif kind == "PARTICLES":
        head = parts.add("cube", "Head")
        head.modifiers.new("Hair", "PARTICLE_SYSTEM")
        head.particle_systems[0].settings.type = "HAIR"
        head.particle_systems[0].settings.count = 10
        bpy.context.view_layer.update()
    elif kind == "GREASE PENCIL":
        add = bpy.ops.object.grease_pencil_add if bpy.app.version >= (4, 3, 0) else bpy.ops.object.gpencil_add
        add(type="STROKE")
    else:
        bpy.ops.object.add(type=kind)
        if kind == "ARMATURE":
            bpy.ops.object.mode_set(mode="EDIT")
            bpy.ops.armature.bone_primitive_add()
            bpy.ops.object.mode_set(mode="OBJECT")


def answers(context: bpy.types.Context) -> dict:
    return {name: cls.poll(context) for name, cls in polls_of_the_extension().items()}


@pytest.mark.parametrize("kind, mode", [(kind, mode) for kind, modes in MODES.items() for mode in modes])
def test_polls_answer_in_every_mode(blank, kind, mode):
    cube, mirror = parts.add("cube", "Box", location=(0.0, -1.5, 1.0)), parts.add_wall_mirror()
    cube.reflection_mesh.role, mirror.reflection_mesh.role = "DIFFUSE", "MIRROR"
    active_of(kind)
    bpy.ops.object.mode_set(mode=mode)
    told = answers(blank)
    assert len(told) >= LEAST and all(answer is True or answer is False or answer is None for answer in told.values())
    assert bool(told["REFLECTION_MESH_OT_generate"]) == (mode == "OBJECT")


def test_polls_answer_where_there_is_nothing():
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    assert len(answers(bpy.context)) >= LEAST and not answers(bpy.context)["REFLECTION_MESH_OT_generate"]
    for obj in list(bpy.data.objects):
        bpy.data.objects.remove(obj)
    bpy.context.scene.world = None
    assert len(answers(bpy.context)) >= LEAST


def test_a_result_and_what_is_deleted_are_answered_too(blank):
    cube, mirror = parts.add("cube", "Box", location=(0.0, -1.5, 1.0)), parts.add_wall_mirror()
    cube.data.materials.append(parts.material("Paint"))
    parts.select(cube, mirror)
    result = parts.generate()
    blank.view_layer.objects.active = result
    assert answers(blank)["REFLECTION_MESH_OT_light"]
    bpy.data.objects.remove(mirror)
    assert len(answers(blank)) >= LEAST
