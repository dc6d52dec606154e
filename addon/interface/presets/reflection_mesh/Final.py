import bpy

active = bpy.context.view_layer.objects.active
made = active and active.reflection_mesh.role in {"REFLECTION", "CAUSTICS"}
mirror = active.reflection_mesh.mirror if made else active
settings = (mirror if mirror and mirror.reflection_mesh.own_settings else bpy.context.scene).reflection_mesh

settings.tolerance = 0.25
settings.placement = "LAYERED"
settings.method = "GENERAL"
settings.depth = 0
settings.hidden_faces = False
settings.light_samples = 256
settings.attributes = "ALL"
