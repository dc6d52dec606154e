"""What can be chosen: the entries of lists, as artists read them. The numbers are those that files hold."""

PLACEMENTS = (
    ("LAYERED", "Layered", "In front of the mirror, near images before far ones, so that they hide each other rightly",
     0),
    ("SURFACE", "Surface", "Exactly on the mirror, where images over one another share a plane: for light of the "
     "picture", 1),
    ("VIRTUAL", "Virtual", "Behind the mirror, where its picture seems to be; the mirror, now a window, is hidden from "
     "the camera", 2),
)
METHODS = (
    ("GENERAL", "Faces", "Faces that show what the mirror shows, for all scenes", 0),
    ("PARALLEL", "Faces, Parallel Cameras", "A simpler way, to compare with: it tears between the mirror's triangles",
     1),
    ("POINTS", "Points", "A small disc for each point that the mirror shows: for dense scans, with triangles smaller "
     "than a pixel", 2),
)
ATTRIBUTES = (
    ("ALL", "All", "Where each point lies on the mirror and on what it shows, how long its path is, which face it "
     "shows: for light on objects, comparisons and shaders", 0),
    ("SHOWN", "Shown", "Only what is seen: positions, materials, and what these read: about a third smaller", 1),
)
LIGHTS = (
    ("AUTO", "Automatic", "On the objects where the camera or a mirror is animated and few objects are reflected, else "
     "in the picture", 0),
    ("PICTURE", "Picture", "As the mirrors show it from here: everything that Cycles knows, for this view alone", 1),
    ("OBJECTS", "Objects", "Baked once and kept with the reflected objects, so that camera and mirrors may move; gloss "
     "stays as it is seen from here", 2),
)
