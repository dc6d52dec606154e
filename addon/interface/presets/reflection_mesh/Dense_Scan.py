import bpy

settings = bpy.context.scene.reflection_mesh.shown(bpy.context)

settings.tolerance = 1.0
settings.placement = "LAYERED"
settings.method = "POINTS"
settings.depth = 1
settings.hidden_faces = False
settings.light_samples = 64
settings.light_kind = "PICTURE"
