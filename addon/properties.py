"""What a .blend file remembers: each object's role, what a result was made from, and the scene's settings."""
import bpy
from bpy.props import (BoolProperty, CollectionProperty, EnumProperty, FloatProperty, IntProperty,
                       IntVectorProperty, PointerProperty, StringProperty)

ROLES = (
    ("AUTO", "Automatic", "A mirror if its material is one; if no selected object is, the active object is the mirror"),
    ("MIRROR", "Mirror", "The scene is reflected in this object"),
    ("DIFFUSE", "Diffuse", "This object is reflected"),
    ("IGNORE", "Ignore", "This object takes no part"),
    ("REFLECTION", "Reflection", "This object is a reflection that was generated"),
)
PLACEMENTS = (
    ("LAYERED", "Layered", "In front of the mirror, in the order of path lengths, so that near images hide far ones"),
    ("SURFACE", "Surface", "Exactly on the mirror"),
    ("VIRTUAL", "Virtual", "At the depth of the virtual image; the mirror, now a window, is hidden from the camera"),
)
METHODS = (
    ("GENERAL", "General", "General three-ray cameras, continuous across the mirror's triangles"),
    ("PARALLEL", "Parallel", "Parallel three-ray cameras, to compare with: discontinuous between triangles"),
)


def tolerance_property() -> FloatProperty:
    return FloatProperty(name="Tolerance", description="Allowed displacement of the reflection, in pixels",
                         default=0.5, min=0.01, soft_max=8.0, max=1000.0, precision=2, options=set())


def placement_property() -> EnumProperty:
    return EnumProperty(name="Placement", description="Where the reflection lies", items=PLACEMENTS,
                        default="LAYERED", options=set())


def method_property() -> EnumProperty:
    return EnumProperty(name="Method", description="How the mirror's triangles project", items=METHODS,
                        default="GENERAL", options=set())


class ReflectionSource(bpy.types.PropertyGroup):
    """One diffuse object of a result."""

    object: PointerProperty(name="Object", type=bpy.types.Object)


class ReflectionObject(bpy.types.PropertyGroup):
    """`Object.reflection_mesh`: the role that an object plays and, for a result, where it came from."""

    role: EnumProperty(name="Role", description="The part that this object plays in a reflection", items=ROLES,
                       default="AUTO")
    mirror: PointerProperty(name="Mirror", description="The mirror of this reflection", type=bpy.types.Object)
    sources: CollectionProperty(name="Sources", description="The objects that this reflection shows",
                                type=ReflectionSource)
    estimated_error: FloatProperty(name="Estimated Error", description="99th percentile of the displacement, in pixels")
    counts: StringProperty(name="Counts", description="How much of each part of the method was needed, as JSON")
    resolution: IntVectorProperty(name="Resolution", size=2,
                                  description="Size in pixels of the picture that this reflection was made for")
    faces: IntProperty(name="Faces", description="Number of faces when it was generated")
    camera_hidden: BoolProperty(name="Hidden from the Camera",
                                description="This mirror is a window to its virtual image, until that is cleared")


class ReflectionScene(bpy.types.PropertyGroup):
    """`Scene.reflection_mesh`: what the panel hands to the operators."""

    tolerance: tolerance_property()
    placement: placement_property()
    method: method_property()


CLASSES = (ReflectionSource, ReflectionObject, ReflectionScene)


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Object.reflection_mesh = PointerProperty(name="Reflection Mesh", type=ReflectionObject)
    bpy.types.Scene.reflection_mesh = PointerProperty(name="Reflection Mesh", type=ReflectionScene)


def unregister() -> None:
    del bpy.types.Scene.reflection_mesh
    del bpy.types.Object.reflection_mesh
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
