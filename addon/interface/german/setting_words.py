"""German names and tooltips of settings and roles."""

SETTINGS = {
    "Tolerance": "Toleranz",
    "Error in pixels that 99 % of the points stay below. Higher values are faster":
        "Fehler in Pixeln, unter dem 99 % der Punkte bleiben. Höhere Werte sind schneller",
    "Placement": "Lage",
    "Position of the reflection's geometry": "Ort der Geometrie der Spiegelung",
    "Layered": "Geschichtet",
    "Just in front of the mirror, with near images in front of far ones": "Knapp vor dem Spiegel, Nahes vor Fernem",
    "Surface": "Oberfläche",
    "Exactly on the mirror. Overlapping images share a plane":
        "Genau auf dem Spiegel. Bilder, die sich überdecken, liegen in einer Ebene",
    "Virtual": "Virtuell",
    "Behind the mirror, where the reflection appears to be. The mirror is hidden from the camera":
        "Hinter dem Spiegel, wo die Spiegelung zu sein scheint. Der Spiegel ist für die Kamera ausgeblendet",
    "Made Of": "Besteht aus",
    "Type of the reflection's geometry": "Art der Geometrie der Spiegelung",
    "Faces": "Flächen",
    "Faces, for all scenes": "Flächen, für alle Szenen",
    "Faces, Parallel Cameras": "Flächen, parallele Kameras",
    "A simpler method for comparisons, with gaps between the mirror's triangles":
        "Ein einfacheres Verfahren für Vergleiche, mit Lücken zwischen den Dreiecken des Spiegels",
    "Points": "Punkte",
    "A small disc for each vertex that the mirror shows, for dense scans with triangles smaller than a pixel":
        "Eine kleine Scheibe für jeden Punkt, den der Spiegel zeigt, für dichte Scans mit Dreiecken kleiner als ein "
        "Pixel",
    "Bounces": "Tiefe",
    "Bounces: Automatic": "Tiefe: Automatisch",
    "Number of reflections from mirror to mirror. 0 is automatic: as many as there are to see. With 1, mirrors do not "
    "show other mirrors":
        "Zahl der Spiegelungen von Spiegel zu Spiegel. 0 heißt automatisch: so viele, wie zu sehen sind. Mit 1 zeigen "
        "Spiegel keine anderen Spiegel",
    "Memory (GB)": "Speicher (GB)",
    "Memory that the computation may use. What needs more is computed more coarsely or refused":
        "Speicher, den die Berechnung brauchen darf. Was mehr braucht, wird gröber berechnet oder abgelehnt",
    "Hidden Faces": "Verdeckte Flächen",
    "Keep faces that nearer faces hide completely, for objects that are removed later. Faces behind transparent faces"
    " are always kept":
        "Behält Flächen, die nähere ganz verdecken, für Objekte, die später entfernt werden. Flächen hinter "
        "durchsichtigen bleiben immer",
    "World Faces": "Flächen der Welt",
    "Faces that show the world, and what is left after the last bounce, so that the reflection covers its mirror":
        "Flächen, die die Welt zeigen, und was nach der letzten Spiegelung bleibt, damit die Spiegelung ihren Spiegel "
        "bedeckt",
    "Never": "Nie",
    "None: the mirror itself shows the world, and has to be rendered":
        "Keine: Der Spiegel selbst zeigt die Welt und muss gerendert werden",
    "When Lit": "Beleuchtet",
    "Light Reflection adds them, so that no engine has to trace the mirror":
        "Spiegelung beleuchten fügt sie hinzu, damit kein Renderer den Spiegel verfolgen muss",
    "Always": "Immer",
    "Generate Reflection adds them too": "Auch Spiegelung erzeugen fügt sie hinzu",
    "When it has faces that show the world": "Wann sie Flächen hat, die die Welt zeigen",
    "Light Samples": "Licht-Samples",
    "Number of light paths for each pixel of the mirrors. The light is denoised":
        "Zahl der Lichtpfade für jedes Pixel der Spiegel. Das Licht wird entrauscht",
    "It has faces that nearer ones hide, with light of their own":
        "Sie hat Flächen, die nähere verdecken, mit eigenem Licht",
    "Own Settings": "Eigene Einstellungen",
    "Use settings of this mirror instead of the scene's settings":
        "Nimmt Einstellungen dieses Spiegels statt denen der Szene",
}
ROLES = {
    "Role": "Rolle",
    "Role of this object in reflections": "Rolle dieses Objekts in Spiegelungen",
    "A mirror if its material is one; if no selected object is, the active object is the mirror":
        "Ein Spiegel, wenn sein Material einer ist; ist kein ausgewähltes Objekt einer, so ist es das aktive",
    "Mirror": "Spiegel",
    "The scene is reflected in this object": "In diesem Objekt spiegelt sich die Szene",
    "Reflected": "Gespiegelt",
    "Mirrors show this object": "Spiegel zeigen dieses Objekt",
    "Ignored": "Unbeteiligt",
    "This object is neither a mirror nor reflected": "Dieses Objekt ist weder Spiegel noch gespiegelt",
    "Reflection": "Spiegelung",
    "This object is a reflection that was generated": "Dieses Objekt ist eine erzeugte Spiegelung",
    "Caustics": "Kaustik",
    "This object shows caustics that were generated": "Dieses Objekt zeigt erzeugte Kaustik",
}
