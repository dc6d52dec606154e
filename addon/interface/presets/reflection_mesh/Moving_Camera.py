import bpy

settings = bpy.context.scene.reflection_mesh.shown(bpy.context)

settings.tolerance = 0.5
settings.placement = "LAYERED"
settings.method = "GENERAL"
settings.depth = 1
settings.hidden_faces = False
settings.light_samples = 128
settings.light_kind = "OBJECTS"
