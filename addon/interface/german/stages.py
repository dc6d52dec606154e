"""Stages of work, which the status bar shows while it goes on. Names and numbers are `{}`."""

READING = {
    "Reading the scene": "Szene wird gelesen",
    "Reading the reflection": "Spiegelung wird gelesen",
    "Reading the sheet": "Bogen wird gelesen",
    "Preparing the scene": "Szene wird vorbereitet",
    "Copying the scene": "Szene wird kopiert",
    "Frame {}": "Bild {}",
    "Frame {} {}": "Bild {} {}",
    "Comparing frame {}": "Bild {} wird verglichen",
}
REFLECTING = {
    "Preparing the mirror": "Spiegel wird vorbereitet",
    "Finding reflected objects": "Gespiegelte Objekte werden gesucht",
    "Reflecting vertices": "Punkte werden gespiegelt",
    "Clipping faces": "Flächen werden beschnitten",
    "Reflecting faces": "Flächen werden gespiegelt",
    "Reflecting other mirrors": "Andere Spiegel werden gespiegelt",
    "Building faces": "Flächen werden gebaut",
    "Refining faces": "Flächen werden verfeinert",
    "Sorting by depth": "Nach Tiefe wird sortiert",
    "Building points": "Punkte werden gebaut",
    "Computing brightness": "Helligkeit wird berechnet",
    "Finding visible faces": "Sichtbare Flächen werden gesucht",
    "Cutting faces": "Flächen werden geschnitten",
}
RENDERING = {
    "Rendering light": "Licht wird gerendert",
    "Rendering {}, {} of {}": "Rendern: {}, {} von {}",
    "the outline of the mirror": "der Umriss des Spiegels",
    "the faces in the mirror": "die Flächen im Spiegel",
    "the faces in the mirror with exact normals": "die Flächen im Spiegel mit genauen Normalen",
    "the positions in the mirror": "die Orte im Spiegel",
    "the positions in the mirror with exact normals": "die Orte im Spiegel mit genauen Normalen",
    "the faces of the mesh": "die Flächen des Netzes",
    "the positions on the mesh": "die Orte auf dem Netz",
    "the picture with the mirror": "das Bild mit dem Spiegel",
    "the picture with the mirror once more": "das Bild mit dem Spiegel noch einmal",
    "the picture with the mesh": "das Bild mit dem Netz",
    "the reference": "das Vergleichsbild",
    "Cycles caustics at {} samples": "Kaustik von Cycles mit {} Samples",
    "Cycles caustics at {} samples once more": "Kaustik von Cycles mit {} Samples noch einmal",
    "the meshes of light at {} samples": "die Netze aus Licht mit {} Samples",
    "Tracing rays for '{}'": "Strahlen für '{}' werden verfolgt",
}
ENDING = {
    "Measuring displacements": "Verschiebungen werden gemessen",
    "Comparing the pictures": "Bilder werden verglichen",
    "Drawing error maps": "Fehlerkarten werden gezeichnet",
    "Drawing the surroundings of the mirror": "Umgebung des Spiegels wird gezeichnet",
    "Drawing the sheet": "Bogen wird gezeichnet",
    "Packing the picture": "Bild wird gepackt",
    "Writing": "Schreiben",
    "Writing {}": "{} wird geschrieben",
    "Writing the light": "Licht wird geschrieben",
    "Writing the report": "Bericht wird geschrieben",
}
STAGES = {**READING, **REFLECTING, **RENDERING, **ENDING}
