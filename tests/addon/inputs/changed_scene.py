"""Changes of a scene, and what Generate makes of it: what may make stale what is kept."""
from __future__ import annotations

import bpy
import numpy as np
import parts

VALUES = {"FLOAT_VECTOR": ("vector", 3, np.float32), "FLOAT2": ("vector", 2, np.float32),
          "FLOAT_COLOR": ("color", 4, np.float32), "BYTE_COLOR": ("color", 4, np.float32),
          "FLOAT": ("value", 1, np.float32), "INT": ("value", 1, np.int32), "BOOLEAN": ("value", 1, bool),
          "INT32_2D": ("value", 2, np.int32), "INT16_2D": ("value", 2, np.int16)}


def whole(obj: bpy.types.Object) -> dict:
    """All attributes of a result, bit for bit, its materials, and where it is."""
    found: dict = {"place": tuple(obj.location), "materials": [getattr(one, "name", "") for one in obj.data.materials]}
    for attribute in obj.data.attributes:
        field, width, kind = VALUES[attribute.data_type]
        values = np.empty(width * len(attribute.data), dtype=kind)
        attribute.data.foreach_get(field, values)
        found[attribute.name] = values.tobytes()
    return found


def made() -> dict:
    """What Generate makes of the scene by its roles."""
    parts.select()
    return whole(parts.generate())


def obj(name: str) -> bpy.types.Object:
    return bpy.data.objects[name]


def in_edit_mode() -> None:
    parts.select(obj("Cone"))
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.transform.resize(value=(1.4, 1.4, 0.8))
    bpy.ops.object.mode_set(mode="OBJECT")


def vertices_written() -> None:
    mesh = obj("Cone").data
    places = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.vertices.foreach_get("co", places)
    mesh.vertices.foreach_set("co", places * 1.2)
    mesh.update()


def colours_written() -> None:
    data = obj("Box").data.color_attributes["Tone"].data
    data.foreach_set("color", np.linspace(0.0, 1.0, 4 * len(data)).astype(np.float32))
    obj("Box").data.update()


def uv_moved() -> None:
    layer = obj("Box").data.uv_layers[0]
    for loop in layer.data:
        loop.uv = loop.uv + type(loop.uv)((0.25, 0.5))


def replaced() -> None:
    bpy.data.objects.remove(obj("Cone"))
    parts.add("cone", "Cone", vertices=9, radius1=0.5, location=(-1.2, -2.0, 0.6)).reflection_mesh.role = "DIFFUSE"


def renamed() -> None:
    one, other = obj("Box"), obj("Cone")
    one.name, other.name = "Old", "Box"
    one.name = "Cone"
    one.data.name, other.data.name = other.data.name, one.data.name
    one.data, other.data = other.data, one.data


def hidden_meanwhile() -> None:
    cone = obj("Cone")
    cone.hide_viewport = True
    made()
    cone.data.vertices[0].co.x += 0.3
    bpy.context.view_layer.update()
    cone.hide_viewport = False


def away_meanwhile() -> None:
    cone, collection = obj("Cone"), bpy.context.scene.collection
    homes = list(cone.users_collection)
    for home in homes:
        home.objects.unlink(cone)
    made()
    cone.data.vertices[0].co.x += 0.3
    bpy.context.view_layer.update()
    (homes or [collection])[0].objects.link(cone)


def away_for_a_moment() -> None:
    cone = obj("Cone")
    homes = list(cone.users_collection)
    for home in homes:
        home.objects.unlink(cone)
    bpy.context.view_layer.update()
    cone.data.vertices[0].co.x += 0.3
    homes[0].objects.link(cone)


def another_attribute() -> dict:
    wet = obj("Box").data.attributes.new("wet", "FLOAT", "POINT")
    wet.data.foreach_set("value", np.arange(len(wet.data), dtype=np.float32))
    tree = bpy.data.materials["Plain"].node_tree
    node = tree.nodes.new("ShaderNodeAttribute")
    node.attribute_name = "nothing"
    bpy.context.view_layer.update()
    before = made()
    node.attribute_name = "wet"
    return before


def other_material() -> None:
    obj("Box").material_slots[0].material = parts.material("Other")


def gone_material() -> None:
    bpy.data.materials.remove(bpy.data.materials["Plain"])


def driven() -> dict:
    driver = obj("Ring").modifiers["Bend"].driver_add("angle").driver
    driver.type = "SUM"
    variable = driver.variables.new()
    variable.type = "TRANSFORMS"
    variable.targets[0].id, variable.targets[0].transform_type = bpy.context.scene.camera, "LOC_X"
    bpy.context.view_layer.update()
    before = made()
    bpy.context.scene.camera.location.x += 0.4
    return before


def other_frame() -> dict:
    bend = obj("Ring").modifiers["Bend"]
    for frame, angle in ((1, 0.5), (10, 2.5)):
        bend.angle = angle
        bend.keyframe_insert("angle", frame=frame)
    bpy.context.scene.frame_set(1)
    before = made()
    bpy.context.scene.frame_set(7)
    return before


def shape_key() -> dict:
    cone = obj("Cone")
    cone.shape_key_add(name="Basis")
    key = cone.shape_key_add(name="Wide")
    for point in key.data:
        point.co = point.co * 1.5
    bpy.context.view_layer.update()
    before = made()
    key.value = 0.7
    return before


def mirror_bent() -> None:
    for vertex in obj("Ball").data.vertices:
        vertex.co.z *= 1.05


def mirror_with_a_plain_part() -> dict:
    ball = obj("Ball")
    for material in (parts.material("Silver", "GLOSSY"), parts.material("Paint", "GLOSSY", roughness=0.5)):
        ball.data.materials.append(material)
    for face in ball.data.polygons:
        face.material_index = face.index % 3 == 0
    bpy.context.view_layer.update()
    partly = made()
    bpy.data.materials["Paint"].node_tree.nodes[0].inputs["Roughness"].default_value = 0.0
    return partly


def other_scale() -> None:
    obj("Box").scale = (-1.0, 1.3, 0.7)


def smooth() -> None:
    obj("Cone").data.shade_smooth()


def turned() -> None:
    obj("Cone").rotation_euler.x += 0.5  # which the ring's modifier follows


def modifier_added() -> None:
    obj("Cone").modifiers.new("Finer", "SUBSURF").levels = 1


def instanced() -> dict:
    collection = bpy.data.collections.new("Group")
    leaf = parts.add("cone", "Leaf", vertices=4, radius1=0.3)
    for home in list(leaf.users_collection):
        home.objects.unlink(leaf)
    collection.objects.link(leaf)
    empty = bpy.data.objects.new("Instance", None)
    empty.instance_type, empty.instance_collection, empty.location = "COLLECTION", collection, (0.9, -2.3, 0.3)
    bpy.context.scene.collection.objects.link(empty)
    empty.reflection_mesh.role = "DIFFUSE"
    bpy.context.view_layer.update()
    before = made()
    leaf.data.vertices[0].co.z += 0.3
    return before


def object_material() -> dict:
    slot = obj("Box").material_slots[0]
    slot.link, slot.material = "OBJECT", parts.material("Own")
    bpy.context.view_layer.update()
    before = made()
    slot.material = bpy.data.materials["Plain"]
    return before


def handlers_lost() -> None:
    kept = list(bpy.app.handlers.depsgraph_update_post)
    bpy.app.handlers.depsgraph_update_post.clear()
    try:
        obj("Cone").data.vertices[0].co.x += 0.3
        bpy.context.view_layer.update()
    finally:
        bpy.app.handlers.depsgraph_update_post.extend(
            function for function in kept if "standing" not in function.__module__)


CHANGES = [in_edit_mode, vertices_written, colours_written, uv_moved, replaced, renamed, hidden_meanwhile,
           away_meanwhile, away_for_a_moment, another_attribute, other_material, gone_material, driven, other_frame,
           shape_key, mirror_bent, mirror_with_a_plain_part, other_scale, smooth, turned, modifier_added,
           instanced, object_material]
