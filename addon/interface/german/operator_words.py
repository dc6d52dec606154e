"""German names and tooltips of operators."""

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
