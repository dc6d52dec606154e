"""Properties that a .blend file stores: the role of each object, the inputs of each result, and settings."""
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

from . import compat
from .lighting import update_mattes
from .reading import forget_known
from .settings import SettingsOfMirror, SettingsOfScene, make_own

ROLES = (
    ("AUTO", "Automatic", "A mirror if its material is one; if no selected object is, the active object is the mirror"),
    ("MIRROR", "Mirror", "The scene is reflected in this object"),
    ("DIFFUSE", "Reflected", "Mirrors show this object"),
    ("IGNORE", "Ignored", "This object is neither a mirror nor reflected"),
    ("REFLECTION", "Reflection", "This object is a reflection that was generated"),
    ("CAUSTICS", "Caustics", "This object shows caustics that were generated"),
)
# what ties objects of a library together: an override of them all must stay tied to its own ones
OVERRIDABLE = {"LIBRARY_OVERRIDABLE"}
GROWING = OVERRIDABLE | {"USE_INSERTION"}


def _begin_own(self, context: bpy.types.Context) -> None:
    if self.own_settings and context.scene is not None:
        make_own(self.id_data, context.scene)


def _after_role(_record, _context: bpy.types.Context) -> None:
    # Blender tells of no change of a property
    forget_known()


def _after_matte(_record, context: bpy.types.Context) -> None:
    if context.scene is not None:
        update_mattes(context)


class ReflectionSource(bpy.types.PropertyGroup):
    """One diffuse object of a result, or one part of its mirror."""

    object: PointerProperty(name="Object", type=bpy.types.Object, override=OVERRIDABLE)


class ReflectionMaterial(bpy.types.PropertyGroup):
    """One material of a result, as it was generated."""

    material: PointerProperty(name="Material", type=bpy.types.Material, override=OVERRIDABLE)


class ReflectionObject(SettingsOfMirror, bpy.types.PropertyGroup):
    """`Object.reflection_mesh`: the role that an object plays, a mirror's own settings and, for a result, where it came
    from."""

    role: EnumProperty(name="Role", description="Role of this object in reflections", items=ROLES,
                       default="AUTO", override=OVERRIDABLE, update=_after_role)
    matte: BoolProperty(name="Matte", description="Reflections show this object in a pass of its own, for compositing: "
                        "1 where it is seen in a mirror, 0 elsewhere", default=False, override=OVERRIDABLE,
                        options=set(), update=_after_matte)
    own_settings: BoolProperty(name="Own Settings", description="Use settings of this mirror instead of the scene's "
                               "settings", default=False, override=OVERRIDABLE, options=set(), update=_begin_own)
    mirror: PointerProperty(name="Mirror", description="The mirror of this reflection", type=bpy.types.Object,
                            override=OVERRIDABLE)
    parts: CollectionProperty(name="Parts", description="The objects that its mirror is joined from; none: it is one",
                              type=ReflectionSource, override=GROWING)
    lamp: PointerProperty(name="Lamp", description="The lamp of these caustics", type=bpy.types.Object,
                          override=OVERRIDABLE)
    eyes: IntProperty(name="Lamp Places", description="On how many places of its lamp these caustics come from")
    keeps_own: BoolProperty(name="Keeps Cycles' Own", description="Cycles adds caustics of its own to these: that was "
                            "asked for")
    sources: CollectionProperty(name="Sources", description="The objects that this reflection shows",
                                type=ReflectionSource, override=GROWING)
    camera: PointerProperty(name="Camera", description="The camera that this reflection is right for; none: the "
                            "scene's", type=bpy.types.Object, override=OVERRIDABLE)
    aside: BoolVectorProperty(name="Aside", size=2, description="Hidden in renders, and in the viewport, while another "
                              "camera looks that has reflections of its own", override=OVERRIDABLE)
    bounces: IntProperty(name="Bounces", default=1, description="By how many mirrors at most it shows anything")
    world_faces: StringProperty(name="World Faces", default="LIT", description="When it has faces that show the world")
    hidden_faces: BoolProperty(name="Hidden Faces", description="It has faces that nearer ones hide, with light of "
                               "their own", override=OVERRIDABLE)
    window: BoolProperty(name="Window", description="Its mirror is a window where this reflection's camera looks",
                         override=OVERRIDABLE)
    origin: FloatVectorProperty(name="Origin", size=3, description="Where it was generated, in world space")
    basis: FloatVectorProperty(name="Basis", size=16, description="Its own transform when it was generated; zero where "
                               "that is not known")
    landmarks: IntVectorProperty(name="Landmarks", size=4, description="Vertices by which its mesh is known again "
                                 "where transforms have been applied; zero where there are none")
    landmark_places: FloatVectorProperty(name="Landmark Places", size=12, description="Where these were generated, in "
                                         "its own space")
    later_materials: CollectionProperty(name="Later Materials", type=ReflectionMaterial,
                                        description="The materials of the mirrors that it is seen by after its own",
                                        override=GROWING)
    materials: CollectionProperty(name="Materials", type=ReflectionMaterial,
                                  description="The materials of its mesh when it was generated", override=GROWING)
    estimated_error: FloatProperty(name="Estimated Error", description="99th percentile of the displacement, in pixels")
    seconds: FloatProperty(name="Seconds", description="Time that it took to generate, this mirror's share")
    counts: StringProperty(name="Counts", description="How much of each part of the method was needed, as JSON")
    resolution: IntVectorProperty(name="Resolution", size=2,
                                  description="Size in pixels of the picture that this reflection was made for")
    protected: BoolProperty(name="Protected", description="Clicks were made to pass by this result, and its transform "
                            "was locked; what the user changes of that stays", override=OVERRIDABLE)
    made_from: StringProperty(name="Made From", description="The view, the mirror and the objects that this reflection "
                              "was made from, as JSON; empty where that is not known")
    faces: IntProperty(name="Faces", description="Number of faces when it was generated")
    points: IntProperty(name="Points", description="Number of points when it was generated by the method Points")
    light: StringProperty(name="Light", description="How the light that this reflection shows was made, as JSON; empty "
                          "where it has none")
    light_material: PointerProperty(name="Light Material", description="What shows this reflection its light",
                                    type=bpy.types.Material, override=OVERRIDABLE)
    lit_from: StringProperty(name="Lit From", description="All that this light depends on, as digests in JSON, and the "
                             "settings that it was made with; empty where that is not known")
    mirror_uv_source: PointerProperty(name="Copy Of", description="The object that this one, cut along what a mirror "
                                      "shows of it, stands in for", type=bpy.types.Object, override=OVERRIDABLE)
    mirror_uv_picture: PointerProperty(name="Mirror Picture", description="What shows a picture on this copy",
                                       type=bpy.types.Material, override=OVERRIDABLE)
    camera_hidden: BoolProperty(name="Hidden from the Camera",
                                description="This mirror is a window to its virtual image, until that is cleared",
                                override=OVERRIDABLE)


class ReflectionScene(SettingsOfScene, bpy.types.PropertyGroup):
    """`Scene.reflection_mesh`: the settings of every mirror that has none of its own."""

    comparison: StringProperty(name="Comparison", description="Numbers of the last comparison with Cycles, as JSON")
    seen_by: PointerProperty(name="Seen By", description="The camera whose reflections are shown; none: all are",
                             type=bpy.types.Object)
    mattes: StringProperty(name="Mattes", description="Passes that view layers have for mattes, a line each")
    collection: PointerProperty(name="Collection", description="Where results made in a window go",
                                type=bpy.types.Collection)


CLASSES = (ReflectionSource, ReflectionMaterial, ReflectionObject, ReflectionScene)


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    compat.let_go_at_exit(ReflectionObject)
    bpy.types.Object.reflection_mesh = PointerProperty(name="Reflection Mesh", type=ReflectionObject,
                                                        override=OVERRIDABLE)
    bpy.types.Scene.reflection_mesh = PointerProperty(name="Reflection Mesh", type=ReflectionScene)


def unregister() -> None:
    del bpy.types.Scene.reflection_mesh
    del bpy.types.Object.reflection_mesh
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
