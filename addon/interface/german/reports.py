"""Sentences on what was done, and what it lacks; parts of them stand beside those that they are parts of."""

DONE = {
    "{}: {}": "{}: {}",
    "{} Also: {}.": "{} Ebenso: {}.",
    "{names} and {count} more": "{names} und {count} weitere",
    "{}: cancelled, {}.": "{}: abgebrochen, {}.",
    "nothing has changed": "nichts hat sich geändert",
    "the frames that are done are kept, the file has not changed":
        "fertige Einzelbilder bleiben, die Datei ist unverändert",
    "{}: {}, {}, error about {} px{}, {} s{}": "{}: {}, {}, Fehler etwa {} px{}, {} s{}",
    "1 point": "1 Punkt",
    "{count} points": "{count} Punkte",
    "1 face": "1 Fläche",
    "{count} faces": "{count} Flächen",
    ", {} % filled by rays": ", {} % mit Strahlen gefüllt",
    "; not lit yet": "; noch nicht beleuchtet",
    "The light of '{}' no longer fits: {}. Click Light Reflection.":
        "Das Licht von '{}' passt nicht mehr: {}. Klicke Spiegelung beleuchten.",
    "it shows other faces": "sie zeigt andere Flächen",
    "{}: lit in {} s": "{}: beleuchtet in {} s",
    "{} use Camera or Window coordinates or Camera Data, which light sees from elsewhere: use other coordinates.":
        "{} verwenden Kamera- oder Fensterkoordinaten oder Kameradaten, die das Licht von anderswo sieht: verwende "
        "andere Koordinaten.",
    "The material of {} bends its normals or displaces it, which a reflection does not follow: model it.":
        "Das Material von {} biegt seine Normalen oder verschiebt es, dem folgt eine Spiegelung nicht: modelliere das.",
    "{}: {} of light, {} s": "{}: {} aus Licht, {} s",
    "{made} of 1 frame baked into '{folder}', {seconds} s":
        "{made} von 1 Einzelbild gebacken, in '{folder}', {seconds} s",
    "{made} of {count} frames baked into '{folder}', {seconds} s":
        "{made} von {count} Einzelbildern gebacken, in '{folder}', {seconds} s",
    "{}: UV map '{}', {}, those that are seen marked '{}', {} s":
        "{}: UV-Karte '{}', {}, die zu sehenden markiert mit '{}', {} s",
    "{}: {} cm, {} x {} pixels; print it at 100 %": "{}: {} cm, {} x {} Pixel; drucke es mit 100 %",
    "{} cleared.": "{} entfernt.",
    "1 reflection": "1 Spiegelung",
    "{count} reflections": "{count} Spiegelungen",
    "1 caustics object": "1 Kaustik-Objekt",
    "{count} caustics objects": "{count} Kaustik-Objekte",
    "{told} and 1 caustics object": "{told} und 1 Kaustik-Objekt",
    "{told} and {count} caustics objects": "{told} und {count} Kaustik-Objekte",
    "'{}' cannot be made anew: {}.": "'{}' lässt sich nicht erneuern: {}.",
    "No reflection is stale.": "Keine Spiegelung ist veraltet.",
    "The camera sees no mirror whose reflection could be judged; pictures in {}":
        "Die Kamera sieht keinen Spiegel, dessen Spiegelung sich beurteilen ließe; Bilder in {}",
    "The reflection shows nothing that could be measured; pictures in {}":
        "Die Spiegelung zeigt nichts, das sich messen ließe; Bilder in {}",
    "Displacement {} px (median), {} px (99 %); holes, spill and wrong layer {} % of the mirror; pictures in {}":
        "Verschoben um {} px (Median), {} px (99 %); Löcher, Überstand und falsche Schicht {} % des Spiegels; "
        "Bilder in {}",
    "1 sample": "1 Abtastung",
    "{count} samples": "{count} Abtastungen",
    "1 transparent layer": "1 durchsichtige Schicht",
    "{count} transparent layers": "{count} durchsichtige Schichten",
    "The camera sees nothing on which light falls; pictures in {}":
        "Die Kamera sieht nichts, auf das Licht fällt; Bilder in {}",
    "{} dB from Cycles' own converged caustics, where its own at {} are {} dB; pictures in {}":
        "{} dB von Cycles' eigener Kaustik entfernt, wo diese selbst mit {} {} dB hat; Bilder in {}",
    "{} dB from Cycles' own converged caustics, where its own at {} are {} dB; flux {} % from rays; pictures "
    "in {}":
        "{} dB von Cycles' eigener Kaustik entfernt, wo diese selbst mit {} {} dB hat; Lichtstrom {} % "
        "neben dem von Strahlen; Bilder in {}",
}
KEPT = {
    "'{}' has no mattes, because Attributes is Shown. Set Attributes to All and generate again.":
        "'{}' hat keine Masken, weil Attribute auf Gezeigtes steht. Setze Attribute auf Alles und erzeuge es neu.",
    "'{}' stays moved, as you left it: clear it and generate again to have it on its mirror.":
        "'{}' bleibt verschoben, wie du es gelassen hast: entferne und erzeuge es neu, um es auf dem Spiegel zu "
        "haben.",
    "What was joined to '{}' is an object of its own again: '{}'.":
        "Was mit '{}' verbunden wurde, ist wieder ein eigenes Objekt: '{}'.",
    "Hidden, since what plays is right for every camera: {}.":
        "Ausgeblendet, da für jede Kamera stimmt, was abgespielt wird: {}.",
    "Hidden where cameras have sequences of their own: {}.":
        "Ausgeblendet, wo Kameras eigene Sequenzen haben: {}.",
    "Updated too, as a copy: {}.": "Auch erneuert, als Kopie: {}.",
    "'{}' shows other faces than before, and has lost what was made for those: {}.":
        "'{}' zeigt andere Flächen als vorher, und hat verloren, was für diese gemacht war: {}.",
    "Blender rounds places so far from the origin to {} units, or {} pixels, and renders are noisy. Move the whole "
    "scene to the origin, or import it with an offset.":
        "So weit vom Ursprung rundet Blender Orte auf {} Einheiten, oder {} Pixel, und Bilder rauschen. Verschiebe die "
        "ganze Szene zum Ursprung, oder importiere sie mit einem Versatz.",
    "'{}' is a mirror now, by its own material.": "'{}' ist jetzt ein Spiegel, mit dem eigenen Material.",
    "'{}' is a mirror now, by a new material.": "'{}' ist jetzt ein Spiegel, mit einem neuen Material.",
    "'{}' is a mirror now, and its mesh keeps its materials: set the Link of the material slots to Data to have them "
    "back.": "'{}' ist jetzt ein Spiegel, und sein Mesh behält seine Materialien: stelle die Verknüpfung der "
        "Materialslots auf Daten, um sie zurückzuhaben.",
    "'{}' has the role Mirror now: give what it consists of a mirror's material.":
        "'{}' hat jetzt die Rolle Spiegel: gib dem, woraus es besteht, das Material eines Spiegels.",
    "'{}' has a roughness of {}, and its reflection is sharp, where Cycles' is blurred.":
        "'{}' hat die Rauheit {}, und die Spiegelung ist scharf, wo die von Cycles unscharf ist.",
    "The roughness of '{}' is not known, and its reflection is sharp, where Cycles' may be blurred.":
        "Die Rauheit von '{}' ist nicht bekannt, und die Spiegelung ist scharf, wo die von Cycles unscharf sein kann.",
    "{} mirrors are rough, '{}' among them, and their reflections are sharp, where Cycles' are blurred.":
        "{} Spiegel sind rau, darunter '{}', und ihre Spiegelungen sind scharf, wo die von Cycles unscharf sind.",
    "Left out because it is hidden: '{}'.": "Ausgelassen, weil ausgeblendet: '{}'.",
    "Left out because it has no faces: '{}'.": "Ausgelassen, weil ohne Flächen: '{}'.",
    "Left out because it is not in this scene: '{}'.": "Ausgelassen, weil nicht in dieser Szene: '{}'.",
    "Left out because the mirror does not show it: '{}'.": "Ausgelassen, weil der Spiegel es nicht zeigt: '{}'.",
    "Kept although they were baked from another state of the scene ({}): {} in '{}'; overwrite them, or choose "
    "another folder, to have all alike.":
        "Behalten, obwohl die Szene beim Backen eine andere war ({}): {} in '{}'; überschreibe sie, oder wähle "
        "einen anderen Ordner, damit alle gleich sind.",
    "Empty in every baked frame, since hidden, out of sight or with nothing to show: {}.":
        "Leer in jedem gebackenen Einzelbild, da ausgeblendet, außer Sicht oder mit nichts zu zeigen: {}.",
    "In {}: {}": "{}: {}",
    "frame {}": "Einzelbild {}",
    "frames {}": "Einzelbilder {}",
    "frames {} and {} more": "Einzelbilder {} und {} weitere",
    "an object was removed": "ein Objekt wurde entfernt",
    "its mirror is gone, deleted or joined to another object: clear it":
        "sein Spiegel ist nicht mehr da, gelöscht oder mit einem anderen Objekt verbunden: entferne es",
    "its mirror or its lamp was removed: clear it": "sein Spiegel oder seine Lampe wurde entfernt: entferne es",
    "the camera has changed": "die Kamera hat sich geändert",
    "the picture's size has changed": "die Bildgröße hat sich geändert",
    "the mirror has changed": "der Spiegel hat sich geändert",
    "a reflected object has changed": "ein gespiegeltes Objekt hat sich geändert",
    "materials have been exchanged": "Materialien wurden ausgetauscht",
    "lines are drawn now": "jetzt werden Linien gezeichnet",
    "the camera looks through a reflected object now": "die Kamera blickt jetzt durch ein gespiegeltes Objekt",
    "the colours of materials have changed": "die Farben von Materialien haben sich geändert",
    "mirrors have been shown or hidden": "Spiegel wurden ein- oder ausgeblendet",
    "the lamps or the world have changed": "die Lampen oder die Welt haben sich geändert",
    "{}: What it shows is finer than its pixels; with Made Of > Points it takes about half of the time.":
        "{}: Was er zeigt, ist feiner als seine Pixel; mit Besteht aus > Punkte dauert es etwa halb so lange.",
    "The frames show what the view layer '{}' sees, and '{}' shows them too: bake all view layers that are "
    "rendered, for a sequence each.":
        "Die Einzelbilder zeigen, was die Ansichtsebene '{}' sieht, und '{}' zeigt sie auch: backe alle "
        "Ansichtsebenen, die gerendert werden, jede für sich.",
}
LACKS = {
    "No reflection has hair, point clouds or volumes, as '{}' has: make meshes of them, or leave the mirror to Cycles.":
        "Keine Spiegelung hat Haare, Punktwolken oder Volumen wie '{}': mache Netze daraus, oder überlasse den Spiegel "
        "Cycles.",
    "Renders show '{}' of the background set too, which no reflection shows: link it into this scene.":
        "Gerendert ist auch '{}' aus der Hintergrundszene zu sehen, das keine Spiegelung zeigt: verknüpfe es mit "
        "dieser Szene.",
    "Stereoscopy: a reflection is right for one eye, and both show the same one; choose the placement Virtual for flat "
    "mirrors, or render each eye by a camera that has its own.":
        "Stereoskopie: eine Spiegelung stimmt für ein Auge, und beide zeigen dieselbe; wähle für ebene Spiegel die "
        "Lage Virtuell, oder rendere jedes Auge mit einer Kamera, die ihre eigene hat.",
    "Renders show '{}', which is hidden in the viewport and so in no reflection: show it, or hide it in renders too.":
        "Gerendert ist '{}' zu sehen, in der Ansicht ausgeblendet und darum in keiner Spiegelung: zeige es, oder "
        "blende es auch im Render aus.",
    "Renders show {} objects, '{}' among them, which are hidden in the viewport and so in no reflection: show them, or "
    "hide them in renders too.":
        "Gerendert sind {} Objekte zu sehen, unter ihnen '{}', die in der Ansicht ausgeblendet sind und darum in "
        "keiner Spiegelung: zeige sie, oder blende sie auch im Render aus.",
    "Renders show another mesh of '{}' than viewports do, by '{}', and what was generated has the viewport's: give "
    "both the same levels.":
        "Gerendert hat '{}' durch '{}' ein anderes Netz als in Ansichten, und das Erzeugte hat das der Ansichten: "
        "gib beiden dieselben Stufen.",
    "Renders show other meshes of {} objects than viewports do, of '{}' by '{}', and what was generated has the "
    "viewport's: give both the same levels.":
        "Gerendert haben {} Objekte andere Netze als in Ansichten, '{}' durch '{}', und das Erzeugte hat die der "
        "Ansichten: gib beiden dieselben Stufen.",
    "Motion blur: reflections are sharp, since their faces change from frame to frame; blur them after the render, or "
    "render in-between frames and mix them.":
        "Bewegungsunschärfe: Spiegelungen sind scharf, weil ihre Flächen von Bild zu Bild andere sind; mache sie "
        "nach dem Rendern unscharf, oder mische Zwischenbilder.",
    "'{}' has a linked reflection too: hide one of the two.":
        "'{}' hat auch eine verknüpfte Spiegelung: blende eine der beiden aus.",
    "Markers change the camera: choose Render > Lock Interface, so that a render of the animation in this window shows "
    "each camera its own reflection.":
        "Marker wechseln die Kamera: wähle Rendern > Interface sperren, damit ein Render der Animation in diesem "
        "Fenster jeder Kamera ihre eigene Spiegelung zeigt.",
    "Motion blur: the reflection is that of one moment, and is blurred as what lies on the mirror; blur it after the "
    "render, or switch motion blur off.":
        "Bewegungsunschärfe: Die Spiegelung ist die eines Augenblicks und verschwimmt wie das, was auf dem Spiegel "
        "liegt; mache sie nach dem Rendern unscharf, oder schalte Bewegungsunschärfe aus.",
    "Depth of field: the camera focuses on the mirror and not on what it shows; choose the placement Virtual for flat "
    "mirrors, or blur after the render.":
        "Tiefenschärfe: die Kamera stellt auf den Spiegel scharf und nicht auf das, was er zeigt; wähle für ebene "
        "Spiegel die Lage Virtuell, oder mache es nach dem Rendern unscharf.",
    "Cycles adds its own caustics of '{}', whose light is linked already: take '{}' out of what it lights.":
        "Cycles fügt eigene Kaustik von '{}' hinzu, deren Licht schon verknüpft ist: nimm '{}' von dem aus, was sie "
        "beleuchtet.",
    "Cycles adds its own caustics of '{}' in '{}', which is lit as well as it mirrors: switch Light Paths > Caustics > "
    "Reflective off.":
        "Cycles fügt eigene Kaustik von '{}' in '{}' hinzu, das auch beleuchtet ist und nicht nur spiegelt: schalte "
        "Lichtpfade > Kaustik > Reflektierend aus.",
    "The colour of '{}' is not known all over, where it asks for what only its own object knows or its "
    "shaders send light back in another way than diffuse: its light may have another colour.":
        "Die Farbe von '{}' ist nicht überall bekannt, wo sie nach etwas fragt, das nur das Objekt selbst weiß, oder "
        "seine Shader Licht anders als diffus zurückwerfen: sein Licht kann eine andere Farbe haben.",
    "The nodes of '{}' tell more than one colour and one strength: its light counts as if the rest were unplugged.":
        "Die Nodes von '{}' sagen mehr als eine Farbe und eine Stärke: sein Licht zählt, als wäre der Rest abgezogen.",
    "Light ends at '{}', though some of it would go through: give it an Alpha without a texture; of different ones no "
    "more than two count.":
        "Licht endet bei '{}', obwohl ein Teil hindurchginge: gib ihm ein Alpha ohne Textur; von verschiedenen zählen "
        "höchstens zwei.",
    "The mirror '{}' is coarse and shaded smooth: Cycles bends its normals, and throws more light than is here; give "
    "it more faces, or shade it flat.":
        "Der Spiegel '{}' ist grob und weich schattiert: Cycles biegt seine Normalen, und wirft mehr Licht als hier; "
        "gib ihm mehr Flächen, oder schattiere ihn flach.",
    "The material of '{}' bends its normals or displaces it, which the light that it throws does not follow: model "
    "that, as by a Displace modifier.":
        "Das Material von '{}' biegt dessen Normalen oder verschiebt seine Fläche, und das Licht, das es wirft, folgt "
        "dem nicht: modelliere das, etwa mit einem Verschieben-Modifikator.",
    "No light is thrown of the lamps that '{}' instances: make them real (Object > Apply > Make Instances Real).":
        "Das Licht der Lampen, die '{}' instanziiert, wird nicht geworfen: mache sie real (Objekt > Anwenden > "
        "Instanzen real machen).",
    "The lamp '{}' is sheared: mirrors throw what they show of it, while Cycles lights directly with more or less than "
    "that; apply the scale of its parent.":
        "Die Lampe '{}' ist geschert: Spiegel werfen, was sie von ihr zeigen, während Cycles direkt mit mehr oder "
        "weniger als dem beleuchtet; wende die Skalierung ihres übergeordneten Objekts an.",
    "A mirror's colour that changes over it in a way that only the mirror knows, or that light meets after another "
    "mirror, counts as one colour: unplug it to choose which.":
        "Die Farbe eines Spiegels, die sich über ihn auf eine Weise ändert, die nur der Spiegel kennt, oder auf die "
        "Licht nach einem anderen Spiegel trifft, zählt als eine einzige: ziehe sie ab, um zu wählen, welche.",
    "Cycles followed {}, and {} or more of light have to be passed: Light Paths > Max Bounces > "
    "Transparent is {} until the light is cleared.":
        "Cycles folgte durch {}, und {} oder mehr vom Licht sind zu durchqueren: Lichtpfade > "
        "Max. Reflexionen > Transparent ist {}, bis das Licht entfernt wird.",
    "Cycles follows {} transparent layers, and {} or more of light have to be passed, so that it is dark behind them: "
    "lower Lamp Places or the depth.":
        "Cycles folgt durch {} durchsichtige Schichten, und {} oder mehr vom Licht sind zu durchqueren, so dass es "
        "dahinter dunkel ist: senke Orte je Lampe oder die Tiefe.",
    "A mesh has eight UV maps at the most: '{}' of '{}' is not on the copy.":
        "Ein Netz hat höchstens acht UV-Maps: '{}' von '{}' ist nicht auf der Kopie.",
    "Between the corners of '{}' the picture is up to {} px off: subdivide it, or choose A Copy.":
        "Zwischen den Ecken von '{}' ist das Bild bis zu {} px daneben: unterteile es, oder wähle Eine Kopie.",
    "About {} % of what the mirror shows is missing: give it a clean mesh, or move the camera.":
        "Etwa {} % von dem, was der Spiegel zeigt, fehlt: gib ihm ein sauberes Netz, oder bewege die Kamera.",
    "About {} % of the light that the mirror throws is missing: give the mirror a clean mesh, or move the lamp.":
        "Etwa {} % des Lichts, das der Spiegel wirft, fehlt: gib ihm ein sauberes Netz, oder bewege die Lampe.",
    "{}: this mirror is linked and cannot be hidden, so that it stands before the virtual image; override it, or "
    "choose the placement Layered.":
        "{}: dieser Spiegel ist verknüpft und lässt sich nicht ausblenden, so dass er vor dem virtuellen Bild "
        "steht; überschreibe ihn, oder wähle die Lage Geschichtet.",
    "{}: '{}' hides a part of the virtual image behind this mirror; the placement Layered shows all of it.":
        "{}: '{}' verdeckt einen Teil des virtuellen Bildes hinter diesem Spiegel; die Lage Geschichtet zeigt es "
        "ganz.",
    "Dense areas were sampled at one ray per pixel ({share} % of this reflection). Raise Memory for exact outlines.":
        "Dichte Bereiche sind mit einem Strahl je Pixel abgetastet ({share} % dieser Spiegelung). Erhöhe Speicher, "
        "damit Umrisse genau werden.",
    "The mirror overlaps itself too often to be cut exactly, so hidden objects may show. Simplify the mirror.":
        "Der Spiegel überdeckt sich zu oft selbst, um genau geschnitten zu werden; Verdecktes kann zu sehen sein. "
        "Vereinfache den Spiegel.",
    "Too many faces pass through the mirror, so objects behind them may show. Simplify the objects that pass through "
    "it.":
        "Zu viele Flächen gehen durch den Spiegel; Objekte dahinter können zu sehen sein. Vereinfache die Objekte, die "
        "durch ihn gehen.",
    "Too many outlines of mirrors cross, so some edges are rough. Simplify the mirrors.":
        "Zu viele Umrisse von Spiegeln kreuzen sich; manche Ränder sind rau. Vereinfache die Spiegel.",
    "Refinement stopped at the largest number of faces, so the error may exceed the tolerance. Raise Tolerance or "
    "Memory.":
        "Die Verfeinerung endete bei der größten Zahl von Flächen; der Fehler kann größer als die Toleranz sein. "
        "Erhöhe Toleranz oder Speicher.",
    "{share} % of the points are too far apart for discs without gaps. Subdivide the reflected objects, or set Made Of "
    "to Faces.":
        "{share} % der Punkte liegen zu weit auseinander für Scheiben ohne Lücken. Unterteile die gespiegelten "
        "Objekte, oder setze Besteht aus auf Flächen.",
    "A film or tinted pane is so close before this mirror that the reflection is left out behind it: move it away from "
    "the mirror by a thousandth of the camera's distance.":
        "Eine Folie oder getönte Scheibe liegt so dicht vor diesem Spiegel, dass die Spiegelung dahinter fehlt: rücke "
        "sie um ein Tausendstel des Kameraabstands vom Spiegel ab.",
    "The mirror '{}' is left out: its lit reflection stands for it.":
        "Der Spiegel '{}' wird weggelassen: seine beleuchtete Spiegelung steht für ihn.",
}
REPORTS = {**DONE, **KEPT, **LACKS}
