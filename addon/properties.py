"""What a .blend file remembers: each object's role, what a result was made from, and the scene's settings."""
import bpy
from bpy.props import (
    BoolProperty,
    BoolVectorProperty,
    CollectionProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    IntProperty,
    IntVectorProperty,
    PointerProperty,
    StringProperty,
)

from ..core import ReflectionError, Settings

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
    ("POINTS", "Points", "Every image of a vertex as a disc: for dense scans, with triangles smaller than a pixel"),
)

ATTRIBUTES = (
    ("ALL", "All", "Where each point lies on the mirror and on what it shows, how long its path is, which face it "
     "shows: for light on objects, comparisons and shaders"),
    ("SHOWN", "Shown", "Only what is seen: positions, materials, and what these read: about a third smaller"),
)
LIGHTS = (
    ("AUTO", "Automatic", "On the objects where the camera or a mirror is animated, else in the picture"),
    ("PICTURE", "Picture", "As the mirrors show it from here: everything that Cycles knows, for this view alone"),
    ("OBJECTS", "Objects", "Baked once and kept with the reflected objects, so that camera and mirrors may move; gloss "
     "stays as it is seen from here"),
)


def tolerance_property() -> FloatProperty:
    return FloatProperty(name="Tolerance", description="Allowed displacement of the reflection, in pixels",
                         default=0.5, min=0.01, soft_max=8.0, max=1000.0, precision=2, options=set())


def placement_property() -> EnumProperty:
    return EnumProperty(name="Placement", description="Where the reflection lies", items=PLACEMENTS,
                        default="LAYERED", options=set())


def method_property() -> EnumProperty:
    return EnumProperty(name="Method", description="How the reflection is computed", items=METHODS,
                        default="GENERAL", options=set())


def depth_property() -> IntProperty:
    return IntProperty(name="Depth", description="How many bounces from mirror to mirror are followed",
                       default=1, min=1, soft_max=4, max=16, options=set())


def memory_property() -> FloatProperty:
    return FloatProperty(name="Memory", description="Gigabytes that the work may take: what would need more is worked "
                         "out more coarsely, or refused", default=2.0, min=0.1, soft_max=64.0, precision=1,
                         options=set())


def hidden_property() -> BoolProperty:
    return BoolProperty(name="Hidden Faces", description="Also the faces that nearer ones hide whole, for objects that "
                        "are to be taken away later; what lets light through keeps them anyway", default=False,
                        options=set())


class SettingsProperties:
    """What operators, the scene and the command line have in common: a field for each of `SETTINGS`."""

    tolerance: tolerance_property()
    placement: placement_property()
    method: method_property()
    depth: depth_property()
    memory: memory_property()
    hidden_faces: hidden_property()


SETTINGS = tuple(SettingsProperties.__annotations__)


def settings_of(holder) -> Settings:
    """The settings that an operator, a scene's `reflection_mesh` or a command line's options hold.

    Raises
    ------
    ReflectionError
        Where one of them cannot be.
    """
    try:
        return Settings(tolerance=holder.tolerance, placement=holder.placement, method=holder.method,
                        depth=holder.depth, maximum_memory=holder.memory, hidden_faces=holder.hidden_faces)
    except ValueError as error:
        raise ReflectionError(str(error)) from error


class ReflectionSource(bpy.types.PropertyGroup):
    """One diffuse object of a result."""

    object: PointerProperty(name="Object", type=bpy.types.Object)


class ReflectionMaterial(bpy.types.PropertyGroup):
    """One material of a result, as it was generated."""

    material: PointerProperty(name="Material", type=bpy.types.Material)


class ReflectionObject(bpy.types.PropertyGroup):
    """`Object.reflection_mesh`: the role that an object plays and, for a result, where it came from."""

    role: EnumProperty(name="Role", description="The part that this object plays in a reflection", items=ROLES,
                       default="AUTO")
    mirror: PointerProperty(name="Mirror", description="The mirror of this reflection", type=bpy.types.Object)
    sources: CollectionProperty(name="Sources", description="The objects that this reflection shows",
                                type=ReflectionSource)
    camera: PointerProperty(name="Camera", description="The camera that this reflection is right for; none: the "
                            "scene's", type=bpy.types.Object)
    aside: BoolVectorProperty(name="Aside", size=2, description="Hidden in renders, and in the viewport, while another "
                              "camera looks that has reflections of its own")
    window: BoolProperty(name="Window", description="Its mirror is a window where this reflection's camera looks")
    origin: FloatVectorProperty(name="Origin", size=3, description="Where it was generated, in world space")
    basis: FloatVectorProperty(name="Basis", size=16, description="Its own transform when it was generated; zero where "
                               "that is not known")
    materials: CollectionProperty(name="Materials", type=ReflectionMaterial,
                                  description="The materials of its mesh when it was generated")
    attributes: EnumProperty(name="Attributes", description="What its points and faces know", items=ATTRIBUTES,
                             default="ALL")
    estimated_error: FloatProperty(name="Estimated Error", description="99th percentile of the displacement, in pixels")
    seconds: FloatProperty(name="Seconds", description="Time that it took to generate, this mirror's share")
    counts: StringProperty(name="Counts", description="How much of each part of the method was needed, as JSON")
    resolution: IntVectorProperty(name="Resolution", size=2,
                                  description="Size in pixels of the picture that this reflection was made for")
    faces: IntProperty(name="Faces", description="Number of faces when it was generated")
    points: IntProperty(name="Points", description="Number of points when it was generated by the method Points")
    light: StringProperty(name="Light", description="How the light that this reflection shows was made, as JSON; empty "
                          "where it has none")
    light_material: PointerProperty(name="Light Material", description="What shows this reflection its light",
                                    type=bpy.types.Material)
    light_map: PointerProperty(name="Light Map", description="Where the triangles of the objects lie in light that "
                               "stays with them; none where this reflection shows light of a picture",
                               type=bpy.types.Mesh)
    light_stale: BoolProperty(name="Stale Light", description="The scene has changed since this light was made")
    mirror_uv_source: PointerProperty(name="Copy Of", description="The object that this one, cut along what a mirror "
                                      "shows of it, stands in for", type=bpy.types.Object)
    mirror_uv_picture: PointerProperty(name="Mirror Picture", description="What shows a picture on this copy",
                                       type=bpy.types.Material)
    camera_hidden: BoolProperty(name="Hidden from the Camera",
                                description="This mirror is a window to its virtual image, until that is cleared")


class ReflectionScene(SettingsProperties, bpy.types.PropertyGroup):
    """`Scene.reflection_mesh`: what the panel hands to the operators."""

    comparison: StringProperty(name="Comparison", description="Numbers of the last comparison with Cycles, as JSON")
    seen_by: PointerProperty(name="Seen By", description="The camera whose reflections are shown; none: all are",
                             type=bpy.types.Object)
    collection: PointerProperty(name="Collection", description="Where results made in a window go",
                                type=bpy.types.Collection)


CLASSES = (ReflectionSource, ReflectionMaterial, ReflectionObject, ReflectionScene)


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
