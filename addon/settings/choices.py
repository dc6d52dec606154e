"""Entries of the enumerated settings, as artists read them. Files store the numbers."""

PLACEMENTS = (
    ("LAYERED", "Layered", "Just in front of the mirror, with near images in front of far ones",
     0),
    ("SURFACE", "Surface", "Exactly on the mirror. Overlapping images share a plane", 1),
    ("VIRTUAL", "Virtual", "Behind the mirror, where the reflection appears to be. The mirror is hidden from the "
                           "camera", 2),
)
METHODS = (
    ("GENERAL", "Faces", "Faces, for all scenes", 0),
    ("PARALLEL", "Faces, Parallel Cameras", "A simpler method for comparisons, with gaps between the mirror's "
                                            "triangles",
     1),
    ("POINTS", "Points", "A small disc for each vertex that the mirror shows, for dense scans with triangles smaller "
                         "than a pixel", 2),
)
WORLD_FACES = (
    ("NEVER", "Never", "None: the mirror itself shows the world, and has to be rendered", 0),
    ("LIT", "When Lit", "Light Reflection adds them, so that no engine has to trace the mirror", 1),
    ("ALWAYS", "Always", "Generate Reflection adds them too", 2),
)
ATTRIBUTES = (
    ("ALL", "All", "Position on the mirror and on the reflected object, path length and reflected face, for light on "
                   "objects, comparisons and shaders", 0),
    ("SHOWN", "Shown", "Only positions, materials and the attributes that materials use. About a third smaller", 1),
)
