"""German reasons why a button is grey."""

OBJECT_MODE = ": verlasse zuerst den jetzigen Modus."
OBSTACLES = {
    "No object to make a mirror of: make one with faces the active object.":
        "Kein Objekt für einen Spiegel: mache eines mit Flächen zum aktiven Objekt.",
    "The active object is linked from another file: make a library override of it, or open that file.":
        "Das aktive Objekt ist aus einer anderen Datei verknüpft: erstelle eine Bibliotheksüberschreibung, oder öffne "
        "jene Datei.",
    "Reflections are generated in Object Mode: leave the present mode first.":
        "Spiegelungen entstehen im Objektmodus" + OBJECT_MODE,
    "Caustics are generated in Object Mode: leave the present mode first.":
        "Kaustik entsteht im Objektmodus" + OBJECT_MODE,
    "Reflections are lit in Object Mode: leave the present mode first.":
        "Spiegelungen werden im Objektmodus beleuchtet" + OBJECT_MODE,
    "Reflections are baked in Object Mode: leave the present mode first.":
        "Spiegelungen werden im Objektmodus gebacken" + OBJECT_MODE,
    "This Blender cannot write USD files, nor play them: bake and play with one that can, as those of blender.org.":
        "Dieses Blender kann USD-Dateien weder schreiben noch abspielen: mit einem backen und abspielen, das es kann, "
        "wie die von blender.org.",
    "Reflections are compared in Object Mode: leave the present mode first.":
        "Spiegelungen werden im Objektmodus verglichen" + OBJECT_MODE,
    "Reflections are cleared in Object Mode: leave the present mode first.":
        "Spiegelungen werden im Objektmodus entfernt" + OBJECT_MODE,
    "Mirror UVs are written in Object Mode: leave the present mode first.":
        "Spiegel-UVs werden im Objektmodus geschrieben" + OBJECT_MODE,
    "No mirror: select the objects to reflect and then, as the active object, the mirror, or set roles in the "
    "Reflection tab.": "Kein Spiegel: wähle aus, was sich spiegeln soll, und zuletzt, als aktives Objekt, den "
        "Spiegel, oder gib den Objekten Rollen im Reiter Reflexion.",
    "Reflections are selected in Object Mode: leave the present mode first.":
        "Spiegelungen werden im Objektmodus ausgewählt" + OBJECT_MODE,
    "The active object has no reflection: make a mirror that has one the active object.":
        "Das aktive Objekt hat keine Spiegelung: mache einen Spiegel, der eine hat, zum aktiven Objekt.",
    "No sheet: make the object that carries the mirror UVs the active one.":
        "Kein Blatt: mache das Objekt mit den Spiegel-UVs zum aktiven.",
    "The scene has no camera: add one (Add > Camera) and make it the scene's camera.":
        "Die Szene hat keine Kamera: füge eine hinzu (Hinzufügen > Kamera) und mache sie zur Kamera der Szene.",
    "The scene has no reflection to light: generate one first.":
        "Die Szene hat keine Spiegelung zum Beleuchten: erzeuge zuerst eine.",
    "The scene has no reflection to clear.": "Die Szene hat keine Spiegelung zum Entfernen.",
    "The reflections are linked from another file: light them in that file, save it, and reload the library here.":
        "Die Spiegelungen sind aus einer anderen Datei verknüpft: beleuchte sie dort, speichere, und lade die "
        "Bibliothek hier neu.",
    "The reflections are linked from another file: clear them in that file, save it, and reload the library here.":
        "Die Spiegelungen sind aus einer anderen Datei verknüpft: entferne sie dort, speichere, und lade die "
        "Bibliothek hier neu.",
    "The scene is linked from another file: open that file, or choose a scene of this one.":
        "Die Szene ist aus einer anderen Datei verknüpft: öffne jene Datei, oder wähle eine Szene aus dieser.",
}
