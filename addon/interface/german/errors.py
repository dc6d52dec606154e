"""Sentences on what cannot be done, and what to do instead."""

OBJECTS = {
    "'{}' has no faces to reflect: choose objects with faces.":
        "'{}' hat keine Flächen zum Spiegeln: wähle Objekte mit Flächen.",
    "The mirror '{}' has no faces: choose an object with faces.":
        "Der Spiegel '{}' hat keine Flächen: wähle ein Objekt mit Flächen.",
    "The mirror '{}' is a part of the metaball '{}': choose that instead.":
        "Der Spiegel '{}' ist ein Teil des Metaballs '{}': wähle stattdessen den.",
    "'{}' has a transform that is not a finite number: clear its location, rotation and scale.":
        "'{}' hat eine Transformation, die keine endliche Zahl ist: setze Ort, Rotation und Skalierung zurück.",
    "'{}' reaches further than 1e17 units from the origin, where Blender's numbers end: make it smaller or move it "
    "nearer.":
        "'{}' reicht weiter als 1e17 Einheiten vom Ursprung, wo Blenders Zahlen enden: mache es kleiner oder rücke "
        "es näher.",
    "'{}' has a vertex whose coordinates are not finite numbers: remove or repair it.":
        "'{}' hat einen Punkt, dessen Koordinaten keine endlichen Zahlen sind: entferne oder repariere ihn.",
    "'{}' has a normal that is not a finite number: recalculate its normals.":
        "'{}' hat eine Normale, die keine endliche Zahl ist: berechne seine Normalen neu.",
    "A triangle names a vertex that the mesh does not have; rebuild the mesh.":
        "Ein Dreieck nennt einen Punkt, den das Netz nicht hat; baue das Netz neu auf.",
    "A vertex has a coordinate that is not a finite number; remove or repair it.":
        "Ein Punkt hat eine Koordinate, die keine endliche Zahl ist; entferne oder repariere ihn.",
    "A vertex has a coordinate larger than 1e40; move it nearer or make the scene smaller.":
        "Ein Punkt hat eine Koordinate größer als 1e40; rücke ihn näher oder mache die Szene kleiner.",
    "A shading normal is not a finite number; recalculate the normals.":
        "Eine Normale ist keine endliche Zahl; berechne die Normalen neu.",
    "The reflected objects have no faces with an area; select objects with faces to reflect.":
        "Die Objekte haben keine Flächen mit einem Inhalt; wähle Objekte mit Flächen zum Spiegeln.",
    "The reflected objects have no faces; select objects with faces to reflect.":
        "Die Objekte haben keine Flächen; wähle Objekte mit Flächen zum Spiegeln.",
    "The mirror has no faces; give it faces or choose another mirror.":
        "Der Spiegel hat keine Flächen; gib ihm welche oder wähle einen anderen.",
    "The mirrors have no faces; give all mirrors, this one among them, or leave them out.":
        "Die Spiegel haben keine Flächen; nenne alle Spiegel, diesen mit, oder lasse sie weg.",
    "There is no light of mirrors to compare: generate caustics first.":
        "Es gibt kein Licht von Spiegeln zu vergleichen: erzeuge zuerst Kaustik.",
    "The light '{}' is hidden: show it in the viewport and in renders.":
        "Das Licht '{}' ist ausgeblendet: zeige es in der Ansicht und im Render.",
    "The mirror or the lamp of '{}' has gone: clear it.":
        "Der Spiegel oder die Lampe von '{}' ist nicht mehr da: entferne es.",
    "The faces of '{}' do not know their light: generate it again.":
        "Die Flächen von '{}' kennen ihr Licht nicht: erzeuge es neu.",
    "The mirror has no face with an area; give it faces or choose another mirror.":
        "Der Spiegel hat keine Fläche mit einem Inhalt; gib ihm welche oder wähle einen anderen.",
}
CAMERAS = {
    "The scene's camera '{}' is no camera object: choose one in the scene's properties.":
        "Die Kamera der Szene, '{}', ist kein Kameraobjekt: wähle eines in den Eigenschaften der Szene.",
    "The camera '{}' is panoramic: set its type to Perspective or Orthographic.":
        "Die Kamera '{}' ist eine Panoramakamera: stelle sie auf Perspektivisch oder Orthographisch.",
    "The camera '{}' has a scale of zero or a position that is no number: clear its transform.":
        "Die Kamera '{}' hat eine Skalierung von null oder einen Ort, der keine Zahl ist: setze ihre Transformation "
        "zurück.",
    "The 3D viewport's view cannot be reflected: {}": "Der Blick der 3D-Ansicht lässt sich nicht spiegeln: {}",
    "The eye is where it looks; move the eye or the target.":
        "Das Auge ist da, wohin es blickt; bewege das Auge oder das Ziel.",
    "The view does not see the mirror; turn the camera to the mirror or move it into view.":
        "Die Kamera sieht den Spiegel nicht; drehe sie zum Spiegel oder rücke ihn ins Bild.",
    "The view's eye is further than 1e40 from the origin; move it nearer or make the scene smaller.":
        "Das Auge ist weiter als 1e40 vom Ursprung; rücke es näher oder mache die Szene kleiner.",
    "The eye lies on the mirror; move the camera away from the mirror's surface.":
        "Das Auge liegt auf dem Spiegel; rücke die Kamera von seiner Oberfläche weg.",
    "'{}' is for the camera '{}': make that the scene's camera, or generate the reflection for '{}' too.":
        "'{}' ist für die Kamera '{}': mache diese zur Kamera der Szene, oder erzeuge die Spiegelung auch für '{}'.",
    "The camera sees none of the reflections: generate them again for this view.":
        "Die Kamera sieht keine der Spiegelungen: erzeuge sie für diesen Blick neu.",
    "The camera sees none of the reflected objects in this mirror; move the camera, the mirror or the objects.":
        "Die Kamera sieht keines der Objekte in diesem Spiegel; bewege die Kamera, den Spiegel oder die Objekte.",
    "The camera sees none of the objects in this mirror; move the camera, the mirror or the objects.":
        "Die Kamera sieht keines der Objekte in diesem Spiegel; bewege die Kamera, den Spiegel oder die Objekte.",
}
CHOICE = {
    "'{}' and '{}' show different objects: select one of them, or the mirrors together with what they shall show.":
        "'{}' und '{}' zeigen verschiedene Objekte: wähle eines davon aus, oder die Spiegel zusammen mit dem, was "
        "sie zeigen sollen.",
    "'{}' is both the mirror and a source of '{}': choose another mirror or remove it from the sources.":
        "'{}' ist zugleich der Spiegel von '{}' und etwas, das darin zu sehen ist: wähle einen anderen Spiegel, "
        "oder nimm ihn aus den Quellen.",
    "'{}' is a shadow catcher, in which Cycles shows no reflection: switch off Shadow Catcher in Object Properties > "
    "Visibility.": "'{}' ist ein Schattenfänger, in dem Cycles keine Spiegelung zeigt: schalte Schattenfänger in "
        "Objekteigenschaften > Sichtbarkeit aus.",
    "The mirror '{}' is hidden: show it in the viewport and in renders.":
        "Der Spiegel '{}' ist ausgeblendet: zeige ihn in der Ansicht und im Render.",
    "'{}' is not in this scene: add it to one of the scene's collections.":
        "'{}' ist nicht in dieser Szene: nimm es in eine ihrer Sammlungen auf.",
    "'{}' is not in this scene, as after it was deleted or joined to another object: clear the result, or add it to "
    "one of the scene's collections.":
        "'{}' ist nicht in dieser Szene, wie nach dem Löschen oder Verbinden mit einem anderen Objekt: entferne das "
        "Ergebnis, oder nimm es in eine der Sammlungen der Szene auf.",
    "'{}' is no mesh any more: generate the reflection again.":
        "'{}' ist kein Netz mehr: erzeuge die Spiegelung neu.",
    "The mirror of '{}' is gone: clear it, or select another mirror.":
        "Der Spiegel von '{}' ist nicht mehr da: entferne es, oder wähle einen anderen Spiegel aus.",
    "The reflected object '{}' is hidden: show it in the viewport, in renders and to glossy rays.":
        "Das Objekt '{}' ist ausgeblendet: zeige es in der Ansicht, im Render und für Glanzstrahlen.",
    "Nothing to reflect in '{}': select the objects to reflect together with it, or set their role to Reflected in "
    "the Reflection tab.":
        "In '{}' spiegelt sich nichts: wähle die Objekte zusammen mit ihm aus, oder gib ihnen im Reiter Reflexion "
        "die Rolle Gespiegelt.",
    "The reflection '{}' is hidden: show it in the viewport and in renders.":
        "Die Spiegelung '{}' ist ausgeblendet: zeige sie in der Ansicht und im Render.",
    "'{}' stands before the virtual image behind this mirror and would hide it; choose the placement Layered, or hide "
    "that object from the camera.":
        "'{}' steht vor dem virtuellen Bild hinter diesem Spiegel und würde es verdecken; wähle die Lage "
        "Geschichtet, oder blende das Objekt für die Kamera aus.",
    "Points follow one bounce only: set Bounces (depth) to 1, or let Made Of (method) be faces.":
        "Punkte zeigen nur, was ein einziger Spiegel zeigt: stelle die Tiefe auf 1, oder lasse die Spiegelung aus "
        "Flächen bestehen.",
    "The faces of '{}' do not know what they show: generate it again, with all attributes.":
        "Die Flächen von '{}' wissen nicht, was sie zeigen: erzeuge sie neu, mit allen Attributen.",
}
LIGHT = {
    "The render was cancelled: nothing has changed.": "Das Rendern wurde abgebrochen: nichts hat sich geändert.",
    "Cycles is not available: enable the add-on 'Cycles Render Engine' in the preferences.":
        "Cycles fehlt: schalte das Add-on 'Cycles Render Engine' in den Einstellungen ein.",
    "'{}' does not know what it shows: set Attributes to All and generate it again.":
        "'{}' weiß nicht, was es zeigt: stelle Attribute auf Alle, und erzeuge es neu.",
    "The camera sees none of the reflections: generate them again for this view.":
        "Die Kamera sieht keine der Spiegelungen: erzeuge sie für diesen Blick neu.",
    "There is no lamp: add one (Add > Light) or show it in the viewport and in renders.":
        "Es gibt keine Lampe: füge eine hinzu (Hinzufügen > Licht), oder zeige sie in der Ansicht und im Render.",
    "No camera is selected: select the cameras, or bake what the scene's own one sees.":
        "Keine Kamera ist ausgewählt: wähle die Kameras aus, oder backe, was die der Szene sieht.",
    "The lamp '{}' has a scale of zero or a position that is no number: clear its transform.":
        "Die Lampe '{}' hat eine Skalierung von null oder einen Ort, der keine Zahl ist: setze ihre Transformation "
        "zurück.",
    "The lamp '{}' is hidden from glossy rays, and so from mirrors: switch its Ray Visibility > Glossy on.":
        "Die Lampe '{}' ist für glänzende Strahlen ausgeblendet, und so für Spiegel: schalte ihre Strahlensichtbarkeit "
        "> Glänzend ein.",
    "The lamp '{}' gives no light: raise its power.": "Die Lampe '{}' gibt kein Licht: erhöhe ihre Leistung.",
    "The lamp '{}' gives no light to the mirror: raise the strength of its emission.":
        "Die Lampe '{}' gibt dem Spiegel kein Licht: erhöhe die Stärke ihrer Emission.",
    "Light goes through all that is to be lit: select what it is to fall on, or give it the role Reflected.":
        "Licht geht durch alles hindurch, was beleuchtet werden soll: wähle aus, worauf es fallen soll, oder gib ihm "
        "die Rolle Gespiegelt.",
    "Light falls on nothing but lamps: select what it is to fall on, or give it the role Reflected.":
        "Licht fällt auf nichts als Lampen: wähle aus, worauf es fallen soll, oder gib ihm die Rolle Gespiegelt.",
    "The light that mirrors throw is the same for all cameras: name one at most.":
        "Das Licht, das Spiegel werfen, ist für alle Kameras dasselbe: nenne höchstens eine.",
    "Light comes from one place of each lamp at least: raise the number of places.":
        "Licht kommt von wenigstens einem Ort jeder Lampe: erhöhe die Zahl der Orte.",
    "The mirror throws none of the lamp's light on the objects; move the lamp, the mirror or the objects.":
        "Der Spiegel wirft nichts vom Licht der Lampe auf die Objekte; bewege die Lampe, den Spiegel oder die "
        "Objekte.",
    "The lamp lies on the mirror; move it away from the mirror's surface.":
        "Die Lampe liegt auf dem Spiegel; rücke sie von seiner Oberfläche weg.",
}
FILES = {
    "The file has not been saved: save it, or choose an absolute folder.":
        "Die Datei ist noch nicht gesichert: sichere sie, oder wähle einen Ordner mit ganzem Pfad.",
    "No file is named: write the name of a .png or .svg file.":
        "Keine Datei ist genannt: schreibe den Namen einer .png- oder .svg-Datei.",
    "The file has not been saved: save it, or choose an absolute path.":
        "Die Datei ist noch nicht gesichert: sichere sie, oder wähle einen ganzen Pfad.",
    "No folder is named: choose one for the results.": "Es ist kein Ordner genannt: wähle einen für die Ergebnisse.",
    "'{}' is a folder: name a file in it.": "'{}' ist ein Ordner: nenne eine Datei darin.",
    "'{}' is a device and no file: name another one.": "'{}' ist ein Gerät und keine Datei: nenne eine andere.",
    "'{}' cannot be saved, because there is no folder '{}': make it first.":
        "'{}' lässt sich nicht sichern, weil es den Ordner '{}' nicht gibt: lege ihn zuerst an.",
    "'{}' is protected from writing: name another file.": "'{}' ist schreibgeschützt: nenne eine andere Datei.",
    "'{}' cannot be written whole, as on a full disk: make room there, or name another file; nothing has been saved.":
        "'{}' lässt sich nicht ganz schreiben, wie auf vollen Datenträgern: schaffe Platz, oder nenne eine andere "
        "Datei; nichts ist gesichert.",
    "'{}' cannot be written ({}): name another file.":
        "'{}' lässt sich nicht schreiben ({}): nenne eine andere Datei.",
    "The folder '{}' cannot be written ({}): choose another one.":
        "Der Ordner '{}' lässt sich nicht beschreiben ({}): wähle einen anderen.",
    "No folder for temporary files can be written: make room, or name another one with TMPDIR.":
        "Kein Ordner für temporäre Dateien lässt sich beschreiben: schaffe Platz, oder nenne einen anderen mit "
        "TMPDIR.",
    "The scratch folder '{}' is full or cannot be written: make room in it, or name another one with TMPDIR.":
        "Der Ordner '{}' für temporäre Dateien ist voll oder lässt sich nicht beschreiben: schaffe Platz darin, "
        "oder nenne einen anderen mit TMPDIR.",
    "The folder '{}' cannot be written ({}): make room in it, or choose another one.":
        "Der Ordner '{}' lässt sich nicht beschreiben ({}): schaffe Platz darin, oder wähle einen anderen.",
    "The folder '{}' cannot be made ({}): choose another one.":
        "Der Ordner '{}' lässt sich nicht anlegen ({}): wähle einen anderen.",
    "'{}' cannot be written ({}): rename or remove it, or choose another folder.":
        "'{}' lässt sich nicht schreiben ({}): benenne es um, entferne es, oder wähle einen anderen Ordner.",
    "'{}' names no frames: write them as 1-24, as 1-100:2 with a step, or with commas between them, from 0 on.":
        "'{}' nennt keine Einzelbilder: schreibe 1-24, mit Schrittweite 1-100:2, oder Kommas dazwischen, ab 0.",
    "Something of this file is called '{}', as what is baked must be: rename that object or mesh.":
        "Etwas in dieser Datei heißt '{}', wie das Gebackene heißen muss: benenne das Objekt oder Netz um.",
    "'{}' cannot be written whole, as on a full disk: make room, or choose another folder; the frames before it are "
    "kept.":
        "'{}' lässt sich nicht ganz schreiben, wie auf vollen Datenträgern: schaffe Platz, oder wähle einen anderen "
        "Ordner; die Einzelbilder davor bleiben.",
    "A process that baked frames ended without a word ({}): let fewer bake at once, as memory may have run out; the "
    "frames that are done stay.":
        "Ein Prozess, der Einzelbilder backte, endete ohne ein Wort ({}): lass weniger zugleich backen, der Speicher "
        "kann ausgegangen sein; fertige Einzelbilder bleiben.",
    "Two mirrors are called '{}': rename one of them.":
        "Zwei Spiegel heißen '{}': benenne einen von ihnen um.",
    "Frame {} in '{}' was baked with other settings or mirrors: overwrite it, or choose another folder.":
        "Einzelbild {} in '{}' wurde mit anderen Einstellungen oder Spiegeln gebacken: überschreibe es, oder wähle "
        "einen anderen Ordner.",
}
PRINTS = {
    "'{}' has no UV map '{}': press Write Mirror UVs first.":
        "'{}' hat keine UV-Karte '{}': drücke zuerst Spiegel-UVs schreiben.",
    "'{}' is not flat, and cannot be printed on a sheet: choose a flat object.":
        "'{}' ist nicht eben, und lässt sich nicht auf ein Blatt drucken: wähle ein ebenes Objekt.",
    "'{}' has no mesh of its own that could be written: choose A Copy.":
        "'{}' hat kein eigenes Netz zum Beschreiben: wähle Eine Kopie.",
    "'{}' is reflected with its modifiers: apply them, or choose A Copy.":
        "'{}' spiegelt sich mit seinen Modifiern: wende sie an, oder wähle Eine Kopie.",
    "'{}' has as many UV maps as a mesh can hold: remove one.":
        "'{}' hat so viele UV-Karten, wie ein Netz fasst: entferne eine.",
    "There is no picture '{}': choose an image file.": "Es gibt kein Bild '{}': wähle eine Bilddatei.",
    "'{}' is no picture that Blender can read: choose an image file.":
        "'{}' ist kein Bild, das Blender lesen kann: wähle eine Bilddatei.",
    "The sheet is {} m large, {} million pixels at {} dots per inch: lower them, scale the scene to the size of the "
    "paper, or set its unit scale.":
        "Das Blatt ist {} m groß, {} Millionen Pixel bei {} Punkten pro Zoll: verringere sie, bringe die Szene auf "
        "die Größe des Papiers, oder stelle ihre Einheiten um.",
    "Light that mirrors throw is baked for one view layer at a time: choose one.":
        "Licht, das Spiegel werfen, wird für eine Ansichtsebene auf einmal gebacken: wähle eine.",
    "Mirror UVs are those of one mirror, and here are {}: select one of them with the objects that it shows.":
        "Spiegel-UVs sind die eines Spiegels, und hier sind {}: wähle einen davon mit den Objekten aus, die er "
        "zeigt.",
    "A picture is put on copies alone: choose A Copy, or give the object a material that shows the picture by the UV "
    "map '{}'.":
        "Ein Bild kommt nur auf Kopien: wähle Eine Kopie, oder gib dem Objekt ein Material, das das Bild nach der "
        "UV-Karte '{}' zeigt.",
    "'{}' shows no picture by its UV map '{}': choose one to print.":
        "'{}' zeigt kein Bild nach seiner UV-Map '{}': wähle eines zum Drucken.",
    "'{}' has no area to print: clear its scale, or choose another object.":
        "'{}' hat keinen Flächeninhalt zum Drucken: setze die Skalierung zurück, oder wähle ein anderes Objekt.",
    "'{}' is neither a .png nor a .svg file: name one of them.": "'{}' ist weder .png noch .svg: nenne eines davon.",
    "A print has {} to {} dots per inch: choose 150 or 300.":
        "Ein Druck hat {} bis {} Punkte pro Zoll: wähle 150 oder 300.",
}
UNFORESEEN = {
    "An object was removed while the work went on: start it again.":
        "Ein Objekt wurde während der Arbeit entfernt: beginne noch einmal.",
    "The memory does not suffice: raise the tolerance or reflect fewer objects at once.":
        "Der Speicher reicht nicht: erhöhe die Toleranz, oder spiegle weniger Objekte auf einmal.",
    "{} failed for a reason that was not foreseen ({}): {}; the console tells more.":
        "{} misslang aus einem unvorhergesehenen Grund ({}): {}; die Konsole sagt mehr.",
    "Interrupted: ends with the present step; press again to end at once.":
        "Unterbrochen: endet mit dem jetzigen Schritt; noch einmal drücken beendet sofort.",
}
ERRORS = {**OBJECTS, **CAMERAS, **CHOICE, **LIGHT, **FILES, **PRINTS, **UNFORESEEN}
