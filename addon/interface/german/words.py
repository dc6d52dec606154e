"""The words of buttons, panels, menus, settings and tips, and why buttons are grey."""

OBJECT_MODE = ": verlasse zuerst den jetzigen Modus."
OPERATORS = {
    "Make It a Mirror": "Zum Spiegel machen",
    "Give the active object the role Mirror, and a mirror's material where it has none; its mesh keeps its own":
        "Gibt dem aktiven Objekt die Rolle Spiegel, und das Material eines Spiegels, wo es keines hat; sein Mesh "
        "behält die eigenen",
    "Generate Reflection": "Spiegelung erzeugen",
    "Create an object for each mirror that shows its reflection, as the scene's camera sees it":
        "Erzeugt für jeden Spiegel ein Objekt mit seiner Spiegelung, wie die Kamera der Szene sie sieht",
    "Preview": "Vorschau",
    "Show the colors of the reflected objects, unaffected by lamps, until the reflection is lit. On if a button is "
    "pressed":
        "Zeigt die Farben der gespiegelten Objekte, von Lampen unberührt, bis die Spiegelung beleuchtet ist. An, wenn"
        " ein Knopf gedrückt wird",
    "Attributes": "Attribute",
    "Matte": "Maske",
    "Mattes": "Masken",
    "Reflections show this object in a pass of its own, for compositing: 1 where it is seen in a mirror, 0 elsewhere":
        "Spiegelungen zeigen dieses Objekt in einem eigenen Durchgang zum Compositing: 1, wo es in einem Spiegel zu "
        "sehen ist, sonst 0",
    "Select objects to list them here": "Wähle Objekte aus, um sie hier zu sehen",
    "Join Parts": "Teile verbinden",
    "Mirrors that have one topmost parent share one reflection; a mirror with settings of its own, or with a "
    "reflection already, keeps its own":
        "Spiegel mit einem gemeinsamen obersten Elternobjekt teilen sich eine Spiegelung; einer mit eigenen "
        "Einstellungen, oder der schon eine Spiegelung hat, behält seine eigene",
    "Attributes that are stored in the reflection's mesh": "Attribute, die im Netz der Spiegelung gespeichert sind",
    "All": "Alles",
    "Position on the mirror and on the reflected object, path length and reflected face, for light on objects, "
    "comparisons and shaders":
        "Ort auf dem Spiegel und auf dem gespiegelten Objekt, Weglänge und gespiegelte Fläche, für Licht auf "
        "Objekten, Vergleiche und Shader",
    "Shown": "Gezeigtes",
    "Only positions, materials and the attributes that materials use. About a third smaller":
        "Nur Orte, Materialien und die Attribute, die Materialien benutzen. Etwa ein Drittel kleiner",
    "In a Collection": "In einer Sammlung",
    "Put a new result into the collection Reflections instead of the collections of its mirror. On if a button is "
    "pressed":
        "Legt ein neues Ergebnis in die Sammlung Reflections statt in die seines Spiegels. An, wenn ein Knopf "
        "gedrückt wird",
    "Select Alone": "Allein auswählen",
    "Deselect all other objects afterwards. On if a button is pressed":
        "Wählt danach alle anderen Objekte ab. An, wenn ein Knopf gedrückt wird",
    "Light Reflection": "Spiegelung beleuchten",
    "Render the light that the mirrors show and put it on the reflections":
        "Rendert das Licht, das die Spiegel zeigen, und legt es auf die Spiegelungen",
    "Light All": "Alle beleuchten",
    "Also light reflections that look right without it, for files that carry images but not all materials, such as "
    "glTF and USD":
        "Beleuchtet auch Spiegelungen, die so schon richtig aussehen, für Dateien, die Bilder mitnehmen, aber nicht "
        "alle Materialien, wie glTF und USD",
    "Generate Caustics": "Kaustik erzeugen",
    "Create meshes that show the light of lamps that the mirrors reflect onto other objects":
        "Erzeugt Netze, die das Licht von Lampen zeigen, das die Spiegel auf andere Objekte werfen",
    "What": "Was",
    "Cameras": "Kameras",
    "Cameras that reflections are baked for": "Kameras, für die Spiegelungen gebacken werden",
    "Scene's": "Die der Szene",
    "The scene's camera. Markers can change it": "Die Kamera der Szene. Markierungen können sie wechseln",
    "Selected": "Ausgewählte",
    "One sequence for each selected camera": "Eine Bildfolge für jede ausgewählte Kamera",
    "View Layers": "Ansichtsebenen",
    "View layers that reflections are baked for": "Ansichtsebenen, für die Spiegelungen gebacken werden",
    "This One": "Diese",
    "The current view layer": "Die jetzige Ansichtsebene",
    "All Rendered": "Alle gerenderten",
    "One sequence for each rendered view layer, hidden in the others":
        "Eine Bildfolge für jede gerenderte Ansichtsebene, in den anderen ausgeblendet",
    "Results that are baked for each frame": "Ergebnisse, die für jedes Einzelbild gebacken werden",
    "Reflections": "Spiegelungen",
    "What the camera sees in the mirrors": "Was die Kamera in den Spiegeln sieht",
    "Light of lamps that the mirrors reflect onto other objects":
        "Licht von Lampen, das die Spiegel auf andere Objekte werfen",
    "Number of points on each lamp that its caustics come from. 0 uses as many as they were generated with":
        "Zahl der Orte auf jeder Lampe, von denen ihre Kaustik kommt. 0 nimmt so viele, wie sie beim Erzeugen hatte",
    "Lamp Places": "Orte je Lampe",
    "Number of points on each lamp that its light comes from. One gives sharp caustics, more give caustics as soft as"
    " the lamp is large. If not given, as many as before":
        "Zahl der Orte auf jeder Lampe, von denen ihr Licht kommt. Einer gibt scharfe Kaustik, mehr geben sie so "
        "weich, wie die Lampe groß ist. Wenn nicht angegeben, so viele wie zuvor",
    "Replace Cycles' Own": "Die von Cycles ersetzen",
    "Stop the lamps from lighting these mirrors, so that Cycles adds no caustics of its own, until the caustics are "
    "cleared. If not given, as before":
        "Lässt die Lampen diese Spiegel nicht mehr beleuchten, damit Cycles keine eigene Kaustik hinzufügt, bis die "
        "Kaustik entfernt wird. Wenn nicht angegeben, wie zuvor",
    "Bake Reflection Frames": "Spiegelungen backen",
    "Write the reflections of a range of frames to files and play them. Playing needs no extension":
        "Schreibt die Spiegelungen einer Reihe von Einzelbildern in Dateien und spielt sie ab. Das Abspielen braucht "
        "keine Erweiterung",
    "Folder": "Ordner",
    "Folder for the files of the frames": "Ordner für die Dateien der Einzelbilder",
    "Frames": "Einzelbilder",
    "Frames to bake, such as 1-24, or 1-100:2 with a step. Empty uses the scene's range":
        "Einzelbilder, etwa 1-24, oder 1-100:2 mit Schrittweite. Leer nimmt den Bereich der Szene",
    "Samples": "Samples",
    "Number of light paths for each pixel of the mirrors. 0 bakes no light":
        "Zahl der Lichtpfade für jedes Pixel der Spiegel. 0 backt kein Licht",
    "Overwrite": "Überschreiben",
    "Processes": "Prozesse",
    "Number of processes that bake at the same time. Each uses one core and memory of its own":
        "Zahl der Prozesse, die gleichzeitig backen. Jeder braucht einen Kern und Speicher für sich",
    "Bake frames again that exist already": "Backt auch Einzelbilder neu, die es schon gibt",
    "Compare with Cycles": "Mit Cycles vergleichen",
    "Compare reflections or caustics with Cycles, and write images and errors to a folder":
        "Vergleicht Spiegelungen oder Kaustik mit Cycles und schreibt Bilder und Fehler in einen Ordner",
    "Folder for the pictures and the report": "Ordner für die Bilder und den Bericht",
    "Samples per pixel of the images. 0 uses the scene's samples":
        "Samples pro Pixel der Bilder. 0 nimmt die der Szene",
    "What is compared with Cycles": "Was mit Cycles verglichen wird",
    "Automatic": "Automatisch",
    "Caustics if they are selected or if the mirrors have no reflections, otherwise reflections":
        "Kaustik, wenn sie ausgewählt ist oder die Spiegel keine Spiegelungen haben, sonst Spiegelungen",
    "Reference Samples": "Samples der Referenz",
    "Samples per pixel of the Cycles image that caustics are compared with":
        "Samples pro Pixel des Bildes von Cycles, mit dem Kaustik verglichen wird",
    "Rays": "Strahlen",
    "Number of rays that are traced for each caustics object":
        "Zahl der Strahlen, die für jedes Kaustik-Objekt verfolgt werden",
    "Clear Reflections": "Spiegelungen entfernen",
    "Remove the results of the selected mirrors, or all results in the scene, and restore what they changed":
        "Entfernt die Ergebnisse der ausgewählten Spiegel, oder alle der Szene, und stellt her, was sie verändert "
        "haben",
    "Write Mirror UVs": "Spiegel-UVs schreiben",
    "Add a UV map to the reflected objects with which an image looks right only in the mirror (anamorphosis)":
        "Gibt den gespiegelten Objekten eine UV-Karte, mit der ein Bild nur im Spiegel richtig aussieht (Anamorphose)",
    "Write On": "Schreiben auf",
    "Object that gets the UV map": "Objekt, das die UV-Karte bekommt",
    "A Copy": "Eine Kopie",
    "Write the map on a copy whose faces are cut where the map bends, and hide the object":
        "Schreibt die Karte auf eine Kopie, deren Flächen zerschnitten sind, wo die Karte sich biegt, und blendet das"
        " Objekt aus",
    "The Object Itself": "Das Objekt selbst",
    "Write the map on the object without cutting faces. Between vertices the map is less accurate":
        "Schreibt die Karte auf das Objekt, ohne Flächen zu zerschneiden. Zwischen den Punkten ist sie weniger genau",
    "Picture Fills": "Bild füllt",
    "Area that the image fills": "Bereich, den das Bild füllt",
    "The Camera's View": "Den Blick der Kamera",
    "The image fills the camera's view": "Das Bild füllt den Blick der Kamera",
    "As Much As Is Shown Whole": "So viel, wie ganz zu sehen ist",
    "The image keeps its proportions and is as large as the mirror can show completely":
        "Das Bild behält sein Seitenverhältnis und ist so groß, wie der Spiegel es ganz zeigen kann",
    "What the Mirror Shows": "Was der Spiegel zeigt",
    "The image fills the bounding box of what the mirror shows of the objects":
        "Das Bild füllt das Rechteck um das, was der Spiegel von den Objekten zeigt",
    "Image in this file or image file that the copies show. Empty writes only the map":
        "Bild in dieser Datei oder Bilddatei, das die Kopien zeigen. Leer schreibt nur die Karte",
    "Save Sheet to Print": "Blatt zum Drucken sichern",
    "Save the active flat object with its image as a PNG or SVG file, to print at its real size":
        "Sichert das aktive flache Objekt mit seinem Bild als PNG- oder SVG-Datei, zum Drucken in wahrer Größe",
    "File": "Datei",
    "PNG or SVG file": "PNG- oder SVG-Datei",
    "Picture": "Bild",
    "Image in this file or image file. Empty uses the image that the object shows":
        "Bild in dieser Datei oder Bilddatei. Leer nimmt das Bild, das das Objekt zeigt",
    "Dots per Inch": "Punkte pro Zoll",
    "Resolution of the print": "Auflösung des Drucks",
    "Add Reflection Preset": "Voreinstellung für Spiegelungen hinzufügen",
    "Save these settings as a preset or remove a preset":
        "Sichert diese Einstellungen als Voreinstellung oder entfernt eine",
}
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
    "Number of reflections from mirror to mirror. With 1, mirrors do not show other mirrors":
        "Zahl der Spiegelungen von Spiegel zu Spiegel. Mit 1 zeigen Spiegel keine anderen Spiegel",
    "Memory (GB)": "Speicher (GB)",
    "Memory that the computation may use. What needs more is computed more coarsely or refused":
        "Speicher, den die Berechnung brauchen darf. Was mehr braucht, wird gröber berechnet oder abgelehnt",
    "Hidden Faces": "Verdeckte Flächen",
    "Keep faces that nearer faces hide completely, for objects that are removed later. Faces behind transparent faces"
    " are always kept":
        "Behält Flächen, die nähere ganz verdecken, für Objekte, die später entfernt werden. Flächen hinter "
        "durchsichtigen bleiben immer",
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
WORDS = {**OPERATORS, **SETTINGS, **ROLES, **PANELS, **OBSTACLES, **LIVE, **STATUS_BAR}
