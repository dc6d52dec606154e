// SPDX-License-Identifier: GPL-3.0-or-later
//
// A job type of Flamenco 3: bakes the reflections of an animation, or the light that its mirrors throw, in chunks of
// frames, and then writes the file that plays them. It goes into the folder "scripts" beside Flamenco Manager; the
// workers' Blender has the extension.
//
// The worker reads which files are done from lines as "Saved: '...'".

const JOB_TYPE = {
    label: "Bake Reflections",
    description: "Write the reflections of a range of frames to files, and a file that plays them",
    settings: [
        { key: "frames", type: "string", required: true,
          eval: "f'{C.scene.frame_start}-{C.scene.frame_end}'",
          evalInfo: { showLinkButton: true, description: "Scene frame range" },
          description: "Frames to bake. Examples: '47', '1-30', '3, 5-10, 47-327'" },
        { key: "chunk_size", type: "int32", default: 10, propargs: { min: 1 }, visible: "submission",
          description: "Number of frames that one task bakes" },
        { key: "what", type: "string", default: "REFLECTIONS", choices: ["REFLECTIONS", "CAUSTICS"],
          description: "Reflections, or the light of lamps that mirrors throw" },
        { key: "eyes", type: "string", default: "",
          description: "Places on each lamp that its caustics come from; as they were generated where empty" },
        { key: "samples", type: "string", default: "",
          description: "Samples per pixel of the light, 0 for none; those of the file where empty" },
        { key: "tolerance", type: "string", default: "",
          description: "Allowed displacement of the reflection, in pixels; that of the file where empty" },
        { key: "view_layer", type: "string", default: "",
          description: "Name of the view layer; the file's own where empty" },
        { key: "camera", type: "string", default: "",
          description: "Name of the camera; the scene's, which its markers may change, where empty" },
        { key: "output_folder", type: "string", subtype: "dir_path", required: true,
          description: "Where the frames go, the same for all workers" },

        // worked out on submission
        { key: "blendfile", type: "string", required: true, visible: "web", description: "The .blend file" },
        { key: "scene", type: "string", required: true, eval: "C.scene.name", visible: "web",
          description: "Name of the scene" },
    ],
};

function compileJob(job) {
    const settings = job.settings;
    const whole = bakeTask("play", settings, settings.frames, []);
    for (const chunk of frameChunker(settings.frames, settings.chunk_size)) {
        const task = bakeTask(`bake-${chunk}`, settings, chunk, ["--frames-only"]);
        job.addTask(task);
        whole.addDependency(task);
    }
    // all frames are there by then: it only writes the file that plays them
    job.addTask(whole);
}

function bakeTask(name, settings, frames, options) {
    const task = author.Task(name, "blender"), names = [];
    if (settings.view_layer) names.push("--view-layer", settings.view_layer);
    if (settings.camera) names.push("--camera", settings.camera);
    task.addCommand(author.Command("blender-render", {
        exe: "{blender}",
        exeArgs: "{blenderArgs}",
        argsBefore: [],
        blendfile: settings.blendfile,
        // Blender hands all that follows "--command" to the extension
        args: ["--command", "reflection_mesh", "bake",
               "--scene", settings.scene,
               "--what", settings.what,
               "--eyes", `${settings.eyes}`,
               "--frames", frames,
               "--light", `${settings.samples}`,
               "--tolerance", `${settings.tolerance}`,
               "--output", settings.output_folder].concat(names, options),
    }));
    return task;
}
