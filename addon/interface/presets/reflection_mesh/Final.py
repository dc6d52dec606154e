import bpy

settings = bpy.context.scene.reflection_mesh.shown(bpy.context)

settings.tolerance = 0.25
settings.placement = "LAYERED"
settings.method = "GENERAL"
settings.depth = 2
settings.hidden_faces = False
settings.light_samples = 256
settings.light_kind = "AUTO"
