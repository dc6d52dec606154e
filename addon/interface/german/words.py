"""The words of buttons, panels, menus, settings and tips, and why buttons are grey."""

OBJECT_MODE = ": verlasse zuerst den jetzigen Modus."
OPERATORS = {
    "Make It a Mirror": "Zum Spiegel machen",
    "Give the active object the role Mirror, and a mirror's material where it has none; its mesh keeps its own":
        "Gibt dem aktiven Objekt die Rolle Spiegel, und das Material eines Spiegels, wo es keines hat; sein Mesh "
        "behält die eigenen",
    "Generate Reflection": "Spiegelung erzeugen",
    "Make what each mirror shows as an object of its own, as the scene's camera sees it":
        "Macht aus dem, was jeder Spiegel zeigt, ein eigenes Objekt, wie die Kamera der Szene es sieht",
    "Preview": "Vorschau",
    "Until it is lit, show the colours of what is reflected in the mirror's tint, untouched by lamps: on where a "
    "button is pressed": "Zeigt, bis sie beleuchtet ist, die Farben des Gespiegelten in der Tönung des Spiegels, "
        "von Lampen unberührt: an, wo ein Knopf gedrückt wird",
    "Attributes": "Attribute",
    "What the points and faces of a reflection know": "Was Punkte und Flächen einer Spiegelung wissen",
    "All": "Alles",
    "Where each point lies on the mirror and on what it shows, how long its path is, which face it shows: for light on "
    "objects, comparisons and shaders": "Wo jeder Punkt auf dem Spiegel und auf dem Gezeigten liegt, wie lang sein Weg "
        "ist, welche Fläche er zeigt: für Licht auf Objekten, Vergleiche und Shader",
    "Shown": "Gezeigtes",
    "Only what is seen: positions, materials, and what these read: about a third smaller":
        "Nur was zu sehen ist: Orte, Materialien, und was diese lesen: etwa ein Drittel kleiner",
    "In a Collection": "In einer Sammlung",
    "A new result goes into the collection Reflections, instead of those of its mirror: on where a button is pressed":
        "Ein neues Ergebnis kommt in die Sammlung Reflections, statt in die seines Spiegels: an, wo ein Knopf "
        "gedrückt wird",
    "Select Alone": "Allein auswählen",
    "Only the result is selected afterwards: on where a button is pressed":
        "Danach ist allein das Ergebnis ausgewählt: an, wo ein Knopf gedrückt wird",
    "Light Reflection": "Spiegelung beleuchten",
    "Let the reflections look as the mirrors do, with the scene's lamps, materials and the mirrors' own tint":
        "Lässt die Spiegelungen aussehen wie die Spiegel, mit Lampen und Materialien der Szene und der Tönung der "
        "Spiegel",
    "Even Those That Need None": "Auch die, die keins brauchen",
    "Also reflections that look right as they are: for files that carry pictures but not all materials, as glTF and "
    "USD": "Auch Spiegelungen, die so schon richtig aussehen: für Dateien, die Bilder mitnehmen, aber nicht alle "
        "Materialien, wie glTF und USD",
    "Generate Caustics": "Kaustik erzeugen",
    "Compute the light of lamps that the mirrors throw on the reflected objects, as meshes that add it to them":
        "Berechnet das Licht der Lampen, das die Spiegel auf die Objekte werfen, als Netze, die es ihnen hinzufügen",
    "What": "Was",
    "Cameras": "Kameras",
    "For which cameras reflections are baked": "Für welche Kameras Spiegelungen gebacken werden",
    "Scene's": "Die der Szene",
    "The scene's camera, which its markers may change": "Die Kamera der Szene, die Markierungen wechseln können",
    "Selected": "Ausgewählte",
    "A sequence for each of the selected cameras": "Eine Bildfolge für jede ausgewählte Kamera",
    "View Layers": "Ansichtsebenen",
    "In which view layers reflections are baked": "In welchen Ansichtsebenen Spiegelungen gebacken werden",
    "This One": "Diese",
    "What the view layer sees that is looked at now": "Was die Ansichtsebene sieht, die gerade offen ist",
    "All Rendered": "Alle gerenderten",
    "A sequence for each view layer that is rendered, which the others do not show":
        "Eine Bildfolge für jede Ansichtsebene, die gerendert wird; die anderen zeigen sie nicht",
    "What is written of each frame": "Was von jedem Einzelbild geschrieben wird",
    "Reflections": "Spiegelungen",
    "What the mirrors show to the camera": "Was die Spiegel der Kamera zeigen",
    "The light of lamps that the mirrors throw": "Das Licht von Lampen, das die Spiegel werfen",
    "Places on each lamp that its caustics come from; 0: as many as they were generated with":
        "Orte auf jeder Lampe, von denen ihre Kaustik kommt; 0: so viele, wie sie beim Erzeugen hatte",
    "Lamp Places": "Orte je Lampe",
    "Places on each lamp that its light comes from: one is sharp, more are as soft as the lamp is large; as many as "
    "before, where this is not given":
        "Orte auf jeder Lampe, von denen ihr Licht kommt: einer ist scharf, mehr sind so weich, wie die Lampe groß "
        "ist; so viele wie zuvor, wo das nicht angegeben ist",
    "Replace Cycles' Own": "Die von Cycles ersetzen",
    "The lamps do not light these mirrors any more, so that Cycles does not add caustics of its own; clearing brings "
    "that back. As before, where this is not given":
        "Die Lampen beleuchten diese Spiegel nicht mehr, damit Cycles keine eigene Kaustik hinzufügt; Entfernen stellt "
        "das wieder her. Wie zuvor, wo das nicht angegeben ist",
    "Bake Reflection Frames": "Spiegelungen backen",
    "Write the reflections of a range of frames to files, and let them play; they need no extension to be seen":
        "Schreibt die Spiegelungen einer Reihe von Einzelbildern in Dateien und spielt sie ab; zu sehen sind sie ohne "
        "Erweiterung",
    "Folder": "Ordner",
    "Folder for the files of the frames": "Ordner für die Dateien der Einzelbilder",
    "Frames": "Einzelbilder",
    "As 1-24, or 1-100:2 with a step; the scene's range where empty":
        "Wie 1-24, oder 1-100:2 mit Schrittweite; leer: der Bereich der Szene",
    "Samples": "Samples",
    "Light paths for each pixel of the mirrors; 0: no light": "Lichtpfade für jedes Pixel der Spiegel; 0: kein Licht",
    "Overwrite": "Überschreiben",
    "Processes": "Prozesse",
    "So many bake side by side, each on a core and with memory of its own":
        "So viele backen nebeneinander, jeder auf einem Kern und mit Speicher für sich",
    "Make again the frames that are there already": "Auch Einzelbilder, die es schon gibt, neu machen",
    "Compare with Cycles": "Mit Cycles vergleichen",
    "Compare reflections or caustics with Cycles; leaves pictures and errors in a folder":
        "Vergleicht Spiegelungen oder Kaustik mit Cycles; Bilder und Fehler liegen danach in einem Ordner",
    "Folder for the pictures and the report": "Ordner für die Bilder und den Bericht",
    "Samples per pixel of the pictures; 0: as the scene is set":
        "Samples pro Pixel der Bilder; 0: wie in der Szene eingestellt",
    "What is compared with Cycles": "Was mit Cycles verglichen wird",
    "By What There Is": "Nach dem, was da ist",
    "Caustics where these are selected, or the mirrors have no reflection but caustics; else reflections":
        "Kaustik, wo sie ausgewählt ist oder die Spiegel keine Spiegelung haben, aber Kaustik; sonst Spiegelungen",
    "Reference Samples": "Samples der Referenz",
    "Of caustics: samples per pixel of Cycles' own that all is compared with":
        "Bei Kaustik: Samples pro Pixel der eigenen von Cycles, mit der alles verglichen wird",
    "Rays": "Strahlen",
    "Of caustics: rays traced one by one for each of them":
        "Bei Kaustik: Strahlen, die für jede einzeln verfolgt werden",
    "Clear Reflections": "Spiegelungen entfernen",
    "Remove the selected reflections, or all of the scene, and restore what they changed":
        "Entfernt die ausgewählten Spiegelungen, oder alle der Szene, und stellt her, was sie verändert haben",
    "Write Mirror UVs": "Spiegel-UVs schreiben",
    "Give the reflected objects a UV map by which a picture looks right in the mirror alone (anamorphosis)":
        "Gibt den gespiegelten Objekten eine UV-Karte, mit der ein Bild nur im Spiegel richtig aussieht (Anamorphose)",
    "Write On": "Schreiben auf",
    "What gets the UV map": "Was die UV-Karte bekommt",
    "A Copy": "Eine Kopie",
    "Faces are cut where the map bends, on a copy that stands in for the object, which is hidden":
        "Flächen werden zerschnitten, wo die Karte sich biegt, auf einer Kopie; das Objekt selbst wird ausgeblendet",
    "The Object Itself": "Das Objekt selbst",
    "No face is cut: the map is right at corners, and wrong between them where it bends":
        "Keine Fläche wird zerschnitten: die Karte stimmt an den Ecken, dazwischen nicht, wo sie sich biegt",
    "Picture Fills": "Bild füllt",
    "What the borders of the picture stand for": "Wofür die Ränder des Bildes stehen",
    "The Camera's View": "Den Blick der Kamera",
    "The picture fills what the camera sees": "Das Bild füllt, was die Kamera sieht",
    "As Much As Is Shown Whole": "So viel, wie ganz zu sehen ist",
    "The picture keeps its proportions and is as large as the mirror can show without cutting it off":
        "Das Bild behält sein Seitenverhältnis und ist so groß, wie der Spiegel es ganz zeigen kann",
    "What the Mirror Shows": "Was der Spiegel zeigt",
    "The picture fills the box around what the mirror shows of the objects":
        "Das Bild füllt das Rechteck um das, was der Spiegel von den Objekten zeigt",
    "Image in this file, or image file, to put on the copies; empty for the map alone":
        "Bild in dieser Datei, oder Bilddatei, für die Kopien; leer: nur die Karte",
    "Save Sheet to Print": "Blatt zum Drucken sichern",
    "Save the active flat object with its picture as a PNG or SVG file, to print in its size":
        "Sichert das aktive flache Objekt mit seinem Bild als PNG- oder SVG-Datei, zum Drucken in seiner Größe",
    "File": "Datei",
    "PNG or SVG file": "PNG- oder SVG-Datei",
    "Picture": "Bild",
    "Image in this file, or image file; empty for what the object shows":
        "Bild in dieser Datei, oder Bilddatei; leer: was das Objekt zeigt",
    "Dots per Inch": "Punkte pro Zoll",
    "How fine the print is": "Wie fein der Druck ist",
    "Add Reflection Preset": "Voreinstellung für Spiegelungen hinzufügen",
    "Save these settings as a preset, or remove one":
        "Sichert diese Einstellungen als Voreinstellung, oder entfernt eine",
}
SETTINGS = {
    "Tolerance": "Toleranz",
    "How many pixels a point may be from where the mirror shows it; more is faster":
        "Wie viele Pixel ein Punkt von da entfernt sein darf, wo der Spiegel ihn zeigt; mehr ist schneller",
    "Placement": "Lage",
    "Where the reflection lies": "Wo die Spiegelung liegt",
    "Layered": "Geschichtet",
    "In front of the mirror, near images before far ones, so that they hide each other rightly":
        "Vor dem Spiegel, Nahes vor Fernem, so dass eines das andere richtig verdeckt",
    "Surface": "Oberfläche",
    "Exactly on the mirror, where images over one another share a plane: for light of the picture":
        "Genau auf dem Spiegel, wo Bilder übereinander in einer Ebene liegen: für Licht des Bildes",
    "Virtual": "Virtuell",
    "Behind the mirror, where its picture seems to be; the mirror, now a window, is hidden from the camera":
        "Hinter dem Spiegel, wo sein Bild zu sein scheint; der Spiegel, jetzt ein Fenster, ist für die Kamera "
        "unsichtbar",
    "Made Of": "Besteht aus",
    "What the reflection is made of": "Woraus die Spiegelung besteht",
    "Faces": "Flächen",
    "Faces that show what the mirror shows, for all scenes":
        "Flächen, die zeigen, was der Spiegel zeigt; für alle Szenen",
    "Faces, Parallel Cameras": "Flächen, parallele Kameras",
    "A simpler way, to compare with: it tears between the mirror's triangles":
        "Ein einfacherer Weg, zum Vergleich: er reißt zwischen den Dreiecken des Spiegels",
    "Points": "Punkte",
    "A small disc for each point that the mirror shows: for dense scans, with triangles smaller than a pixel":
        "Ein Scheibchen für jeden Punkt, den der Spiegel zeigt: für dichte Scans, mit Dreiecken kleiner als ein Pixel",
    "Bounces": "Tiefe",
    "How many times the scene is followed from mirror to mirror; 1: mirrors show no mirrors":
        "Wie oft die Szene von Spiegel zu Spiegel verfolgt wird; 1: Spiegel zeigen keine Spiegel",
    "Memory (GB)": "Speicher (GB)",
    "Gigabytes that the work may take: what would need more is worked out more coarsely, or refused":
        "Gigabyte, die die Arbeit brauchen darf: was mehr bräuchte, wird gröber gerechnet oder abgelehnt",
    "Hidden Faces": "Verdeckte Flächen",
    "Also the faces that nearer ones hide whole, for objects that are to be taken away later; what lets light through "
    "keeps them anyway": "Auch Flächen, die nähere ganz verdecken, für Objekte, die später verschwinden sollen; wo "
        "Licht durchscheint, bleiben sie ohnehin",
    "Light Samples": "Licht-Samples",
    "Light paths for each pixel of the mirrors, which are denoised; more is cleaner and slower":
        "Lichtpfade für jedes Pixel der Spiegel, die entrauscht werden; mehr ist sauberer und langsamer",
    "Light": "Licht",
    "Where the light is kept": "Wo das Licht aufgehoben wird",
    "Automatic": "Automatisch",
    "On the objects where the camera or a mirror is animated and few objects are reflected, else in the picture":
        "Auf den Objekten, wo die Kamera oder ein Spiegel animiert ist und wenige Objekte gespiegelt werden, sonst im "
        "Bild",
    "As the mirrors show it from here: everything that Cycles knows, for this view alone":
        "Wie die Spiegel es von hier zeigen: alles, was Cycles kann, nur für diesen Blick",
    "Objects": "Objekte",
    "Baked once and kept with the reflected objects, so that camera and mirrors may move; gloss stays as it is seen "
    "from here": "Einmal gebacken und bei den gespiegelten Objekten aufgehoben, so dass Kamera und Spiegel sich "
        "bewegen dürfen; Glanz bleibt, wie er von hier aussieht",
    "Own Settings": "Eigene Einstellungen",
    "This mirror has settings of its own; else the scene's hold for it":
        "Dieser Spiegel hat eigene Einstellungen; sonst gelten für ihn die der Szene",
    "Only for '{name}'": "Nur für '{name}'",
}
ROLES = {
    "Role": "Rolle",
    "The part that this object plays in a reflection": "Was dieses Objekt in einer Spiegelung ist",
    "A mirror if its material is one; if no selected object is, the active object is the mirror":
        "Ein Spiegel, wenn sein Material einer ist; ist kein ausgewähltes Objekt einer, so ist es das aktive",
    "Mirror": "Spiegel",
    "The scene is reflected in this object": "In diesem Objekt spiegelt sich die Szene",
    "Reflected": "Gespiegelt",
    "Mirrors show this object": "Spiegel zeigen dieses Objekt",
    "Ignored": "Unbeteiligt",
    "This object takes no part": "Dieses Objekt bleibt aus dem Spiel",
    "Reflection": "Spiegelung",
    "This object is a reflection that was generated": "Dieses Objekt ist eine erzeugte Spiegelung",
    "Caustics": "Kaustik",
    "This object is light thrown by a mirror that was generated": "Dieses Objekt ist erzeugtes Licht eines Spiegels",
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
    "Select a mirror and what it shall show": "Wähle einen Spiegel aus, und was er zeigen soll",
    "Reflection in {mirror}": "Spiegelung in {mirror}",
    "a mirror that is gone": "einem Spiegel, der fehlt",
    "Shows {names}": "Zeigt {names}",
    "{names} and {count} more": "{names} und {count} weitere",
    "It is no mesh any more: Generate": "Sie ist kein Netz mehr: Spiegelung erzeugen",
    "makes a new one.": "macht eine neue.",
    "1 object": "1 Objekt",
    "{count} objects": "{count} Objekte",
    "Light of {lamp}, thrown by {mirror}": "Licht von {lamp}, geworfen von {mirror}",
    "a lamp that is gone": "einer Lampe, die fehlt",
    "Plays baked frames": "Spielt gebackene Einzelbilder",
    "1 face, {size}": "1 Fläche, {size}",
    "1 point, {size}": "1 Punkt, {size}",
    "{count:,} faces, {size}": "{count:,} Flächen, {size}",
    "{count:,} points, {size}": "{count:,} Punkte, {size}",
    "It is linked from another file:": "Sie ist aus einer anderen Datei verknüpft:",
    "there it is updated and lit.": "dort wird sie aktualisiert und beleuchtet.",
    "The render has another size now:": "Das Render hat jetzt eine andere Größe:",
    "press Generate Reflection again.": "drücke noch einmal Spiegelung erzeugen.",
    "The scene has changed since it was lit:": "Die Szene ist anders, als sie beleuchtet wurde:",
    "press Light Reflection again.": "drücke noch einmal Spiegelung beleuchten.",
    "Lit; gloss is seen as from one place:": "Beleuchtet; Glanz ist wie von einer Stelle aus gesehen:",
    "in the picture it would be exact.": "im Bild wäre er genau.",
    "Its light is still to come:": "Ihr Licht fehlt noch:",
    "press Light Reflection.": "drücke Spiegelung beleuchten.",
    "Lit.": "Beleuchtet.",
    "Made for {width} x {height} px": "Gemacht für {width} x {height} px",
    "Error about {error:.2f} px": "Fehler etwa {error:.2f} px",
    "Made in {seconds:.2f} s": "Gemacht in {seconds:.2f} s",
    "{share:.3f} % filled by rays": "{share:.3f} % mit Strahlen gefüllt",
    "Against Cycles at {width} x {height}": "Gegen Cycles bei {width} x {height}",
    "Displacement {median:.3f} px, 99 %: {most:.3f} px": "Verschoben um {median:.3f} px, 99 %: {most:.3f} px",
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
    "Keep reflections right while the camera, mirrors or objects move: coarse on the way, exact at rest":
        "Hält Spiegelungen richtig, während sich Kamera, Spiegel oder Objekte bewegen: grob unterwegs, genau in Ruhe",
    "Seen From": "Gesehen von",
    "For whom Live keeps reflections right": "Für wen Live die Spiegelungen richtig hält",
    "Camera": "Kamera",
    "Reflections are kept right for the scene's camera": "Spiegelungen bleiben für die Kamera der Szene richtig",
    "Viewport": "Ansicht",
    "Reflections are kept right for the largest 3D viewport; Generate makes them right for the camera again":
        "Spiegelungen bleiben für die größte 3D-Ansicht richtig; Spiegelung erzeugen macht sie wieder für die Kamera "
        "richtig",
    "Update Reflections": "Spiegelungen erneuern",
    "Make the reflections and the light of mirrors anew that no longer show what there is":
        "Erzeugt die Spiegelungen und das Licht von Spiegeln neu, die nicht mehr zeigen, was da ist",
    "'{name}' is stale:": "'{name}' ist veraltet:",
    "an object was removed": "ein Objekt wurde entfernt",
    "the camera has changed": "die Kamera hat sich geändert",
    "the picture's size has changed": "die Bildgröße hat sich geändert",
    "the mirror has changed": "der Spiegel hat sich geändert",
    "a reflected object has changed": "ein gespiegeltes Objekt hat sich geändert",
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
    "ESC cancels": "ESC bricht ab",
    "this cannot be divided, ESC cancels after it": "das lässt sich nicht teilen, ESC bricht danach ab",
    "about {seconds:.0f} s left": "noch etwa {seconds:.0f} s",
    "about {minutes:.0f} min left": "noch etwa {minutes:.0f} min",
    "about {hours:.1f} h left": "noch etwa {hours:.1f} h",
}
WORDS = {**OPERATORS, **SETTINGS, **ROLES, **PANELS, **OBSTACLES, **LIVE, **STATUS_BAR}
