import bpy

settings = bpy.context.scene.reflection_mesh.shown(bpy.context)

settings.tolerance = 4.0
settings.placement = "LAYERED"
settings.method = "GENERAL"
settings.depth = 1
settings.hidden_faces = False
settings.light_samples = 16
settings.light_kind = "AUTO"
