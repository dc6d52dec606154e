"""German texts of panels, menus, the status bar and *Live*."""

PANELS = {
    "The scene has no mirror. A mirror is metal with a Roughness up to 0.1, or has the role Mirror.":
        "Die Szene hat keinen Spiegel. Ein Spiegel ist Metall mit einer Rauheit bis 0,1 oder hat die Rolle Spiegel.",
    "Make '{name}' a Mirror": "'{name}' zum Spiegel machen",
    "Reflection Mesh": "Reflection Mesh",
    "Settings": "Einstellungen",
    "Limits": "Grenzen",
    "Figures": "Zahlen",
    "Compare and Print": "Vergleichen und Drucken",
    "Reflection Presets": "Voreinstellungen für Spiegelungen",
    "Select Reflection": "Spiegelung auswählen",
    "Select the reflection in the active mirror, to edit it. From then on clicks in the viewport select it too":
        "Wählt die Spiegelung im aktiven Spiegel aus, um sie zu bearbeiten. Von da an wählen Klicks in der Ansicht "
        "auch sie aus",
    "Protect": "Schützen",
    "Clicks in the viewport select the mirror instead of the result, and the result cannot be moved. On if a button is "
    "pressed": "Klicks in der Ansicht wählen den Spiegel statt des Ergebnisses aus, und das Ergebnis lässt sich nicht "
        "verschieben. An, wenn ein Knopf gedrückt wird",
    "No Active Object": "Kein aktives Objekt",
    "Lamp": "Lampe",
    "Reflected By": "Gespiegelt von",
    "Gone": "Nicht mehr da",
    "Select a mirror, then click Generate Reflection.":
        "Wähle einen Spiegel aus, und klicke dann Spiegelung erzeugen.",
    "Up to date.": "Aktuell.",
    "Plays baked frames.": "Spielt gebackene Einzelbilder.",
    "This result is linked from another file. Update and light it there.":
        "Dieses Ergebnis ist aus einer anderen Datei verknüpft. Aktualisiere und beleuchte es dort.",
    "Its mirror or its lamp is gone. Click Clear Reflections.":
        "Sein Spiegel oder seine Lampe ist nicht mehr da. Klicke Spiegelungen entfernen.",
    "The mirror or the lamp of '{name}' is gone. Select it in the Outliner and click Clear Reflections.":
        "Der Spiegel oder die Lampe von '{name}' ist nicht mehr da. Wähle es im Outliner aus, und klicke Spiegelungen "
        "entfernen.",
    "This reflection is not a mesh any more. Click Generate Reflection.":
        "Diese Spiegelung ist kein Netz mehr. Klicke Spiegelung erzeugen.",
    "1 result is out of date: {why}. Click Update Reflections.":
        "1 Ergebnis ist veraltet: {why}. Klicke Spiegelungen erneuern.",
    "{count} results are out of date: {why}. Click Update Reflections.":
        "{count} Ergebnisse sind veraltet: {why}. Klicke Spiegelungen erneuern.",
    "{shading} shading shows no caustics, and no light in reflections.":
        "{shading} zeigt keine Kaustik, und kein Licht in Spiegelungen.",
    "{shading} shading shows reflections without light and textures.":
        "{shading} zeigt Spiegelungen ohne Licht und Texturen.",
    "{shading} shading does not show caustics.": "{shading} zeigt keine Kaustik.",
    "Material Preview": "Material-Vorschau",
    "The scene has changed since the reflection was lit. Click Light Reflection.":
        "Die Szene hat sich geändert, seit die Spiegelung beleuchtet wurde. Klicke Spiegelung beleuchten.",
    "Lit.": "Beleuchtet.",
    "Not lit yet. Click Light Reflection.": "Noch nicht beleuchtet. Klicke Spiegelung beleuchten.",
    "Shows {names}": "Zeigt {names}",
    "{names} and {count} more": "{names} und {count} weitere",
    "1 object": "1 Objekt",
    "{count} objects": "{count} Objekte",
    "1 face, {size}": "1 Fläche, {size}",
    "1 point, {size}": "1 Punkt, {size}",
    "{count:,} faces, {size}": "{count:,} Flächen, {size}",
    "{count:,} points, {size}": "{count:,} Punkte, {size}",
    "Made for {width} x {height} px": "Gemacht für {width} x {height} px",
    "Error about {error:.2f} px": "Fehler etwa {error:.2f} px",
    "Made in {seconds:.2f} s": "Gemacht in {seconds:.2f} s",
    "{share:.3f} % filled by rays": "{share:.3f} % mit Strahlen gefüllt",
    "Against Cycles at {width} x {height}": "Gegen Cycles bei {width} x {height}",
    "Displacement {median:.3f} px, 99 %: {most:.3f} px": "Verschoben um {median:.3f} px, 99 %: {most:.3f} px",
    "No mirror pixels to judge": "Keine Spiegelpixel zu beurteilen",
    "Holes, spill, wrong layer {share:.3f} %": "Löcher, Überstand, falsche Schicht {share:.3f} %",
    "Caustics PSNR {mesh:.1f} dB; Cycles' own, {samples} samples: {own:.1f} dB":
        "Kaustik PSNR {mesh:.1f} dB; die von Cycles, {samples} Samples: {own:.1f} dB",
    "Flux {flux:+.3f} % from rays": "Lichtstrom {flux:+.3f} % neben Strahlen",
    "Open the Report": "Bericht öffnen",
}
LIVE = {
    "Live": "Live",
    "Live Reflections": "Live-Spiegelungen",
    "Stop Live": "Live beenden",
    "Update reflections while the camera, mirrors or objects move: coarsely while they move, exactly afterwards":
        "Aktualisiert Spiegelungen, während sich Kamera, Spiegel oder Objekte bewegen: unterwegs grob, danach genau",
    "Seen From": "Gesehen von",
    "View that Live updates reflections for": "Blick, für den Live die Spiegelungen aktualisiert",
    "Camera": "Kamera",
    "Update reflections for the scene's camera": "Aktualisiert Spiegelungen für die Kamera der Szene",
    "Viewport": "Ansicht",
    "Update reflections for the largest 3D viewport. Generate Reflection makes them for the camera again":
        "Aktualisiert Spiegelungen für die größte 3D-Ansicht. Spiegelung erzeugen macht sie wieder für die Kamera",
    "Update Reflections": "Spiegelungen erneuern",
    "Update the reflections and caustics that are out of date":
        "Aktualisiert die Spiegelungen und Kaustik, die veraltet sind",
    "an object was removed": "ein Objekt wurde entfernt",
    "the camera has changed": "die Kamera hat sich geändert",
    "the picture's size has changed": "die Bildgröße hat sich geändert",
    "the mirror has changed": "der Spiegel hat sich geändert",
    "a reflected object has changed": "ein gespiegeltes Objekt hat sich geändert",
    "it shows other objects": "sie zeigt andere Objekte",
    "an object has changed": "ein Objekt hat sich geändert",
    "a material has changed": "ein Material hat sich geändert",
    "the lamps or the world have changed": "die Lampen oder die Welt haben sich geändert",
    "the render settings have changed": "die Rendereinstellungen haben sich geändert",
    "the lamp has changed": "die Lampe hat sich geändert",
    "what is lit has changed": "was beleuchtet ist, hat sich geändert",
    "what stands in the light's way has changed": "was dem Licht im Weg steht, hat sich geändert",
    "its mirror is gone, deleted or joined to another object: clear it":
        "sein Spiegel ist nicht mehr da, gelöscht oder mit einem anderen Objekt verbunden: entferne es",
    "its mirror or its lamp was removed: clear it": "sein Spiegel oder seine Lampe wurde entfernt: entferne es",
    "the settings have changed": "die Einstellungen haben sich geändert",
    "materials have been exchanged": "Materialien wurden ausgetauscht",
    "lines are drawn now": "jetzt werden Linien gezeichnet",
    "the camera looks through a reflected object now": "die Kamera blickt jetzt durch ein gespiegeltes Objekt",
    "the colours of materials have changed": "die Farben von Materialien haben sich geändert",
    "Live was stopped before it was exact":
        "Live wurde beendet, bevor sie genau war",
    "Exact, {milliseconds:.0f} ms": "Genau, {milliseconds:.0f} ms",
    "Coarse, {milliseconds:.0f} ms": "Grob, {milliseconds:.0f} ms",
    "Live waits for Object Mode.": "Live wartet auf den Objektmodus.",
    "Generate a reflection first.": "Erzeuge zuerst eine Spiegelung.",
}
STATUS_BAR = {
    "ESC: Cancel": "ESC: Abbrechen",
    "ESC: Cancel After This Step": "ESC: Nach diesem Schritt abbrechen",
    "about {seconds:.0f} s left": "noch etwa {seconds:.0f} s",
    "about {minutes:.0f} min left": "noch etwa {minutes:.0f} min",
    "about {hours:.1f} h left": "noch etwa {hours:.1f} h",
}
