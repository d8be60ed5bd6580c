// A run to look at: scene, growth time and plots, kept in step.

async function createPanel(run, payloadId, colours, { field = "von_mises", isActive } = {}) {
  const model = await loadModel(run, payloadId);
  const viewer = createViewer(model, colours);
  const player = createPlayer(model.times, run.duration);
  const tooltip = createTooltip();
  const pointer = connectPointer(viewer, tooltip);
  const first = model.fields.has(field) ? field : "region";
  const choice = createFieldChoice(run.frames.fields, first, (name) => {
    viewer.set({ field: name });
    if (mode) mode.leave();
    choice.set(name);
    describeScene();
  });
  const mode = model.hasMode ? createModeSwitch(viewer, run.onset, (isOn) => {
    player.toggle(false);
    plots.mark(isOn ? run.onset.growth_time : model.times[player.frame]);
    // The scene shows the tissues at onset: so do the choice of colours, the slider and the text beside it.
    choice.set(isOn ? REGION.name : viewer.state.field);
    if (isOn) player.showTime(run.onset.growth_time, "onset");
    else player.seek(player.frame);
    describeScene();
  }) : null;
  const plots = createPlots(run.plots, {
    duration: run.duration, onset: run.onset, onSeek: (time) => player.seekTime(time),
  });
  const describeScene = () => {
    const shown = viewer.state.mode === null
      ? `coloured by ${viewer.field().label}, growth time ${brief(model.times[player.frame])}`
      : `critical mode at onset, growth time ${brief(run.onset.growth_time)}`;
    viewer.canvas.setAttribute("aria-label", `${run.name}, ${shown}. ${viewer.bar ? "Arrow keys turn, " : ""}${viewer.bar ? "plus" : "Plus"} and minus zoom, 0 shows all.`);
  };
  player.changed.listen((frame) => {
    if (mode) mode.leave();
    viewer.set({ frame });
    plots.mark(model.times[frame]);
    describeScene();
  });
  connectKeys(player, isActive);
  viewer.set({ field: first });
  player.seek(model.nFrames - 1);
  const host = layOut({ viewer, player, tooltip, pointer, choice, mode, plots, colours });
  const release = () => {
    player.toggle(false);
    if (mode) mode.leave();
    viewer.release();
  };
  return { host, viewer, player, choice, model, release };
}

function layOut({ viewer, player, tooltip, pointer, choice, mode, plots, colours }) {
  const options = element("div", { class: "options" },
    createSwitch("colours of this state", "Stretch the colours over the range of this state instead of the whole run",
      false, (isOn) => viewer.set({ scope: isOn ? "state" : "run" })).host,
    createSwitch("mesh", "Draw the edges of the cells", false, (mesh) => viewer.set({ mesh })).host,
    mode && mode.host);
  const drawn = () => [viewer.canvas, createColourBar(viewer, colours), createScaleBar(viewer), createZoomButtons(pointer, viewer.what),
    mode && mode.bar, tooltip.host];
  const scene = element("div", { class: "scene" }, viewer.isAble ? drawn() : createMissing());
  return element("div", { class: "panel" },
    element("div", { class: "stage" },
      element("div", { class: "toolbar" }, choice.host, options), scene, viewer.isAble ? viewer.bar : null, player.host),
    plots.host);
}

// What stands in place of a scene that cannot be drawn: the reason and, where the page carries it, folded.png.
function createMissing() {
  const picture = document.getElementById("picture");
  const notice = element("p", { class: "notice" }, "This browser offers no WebGL 2, which the scene needs.",
    picture ? " Below is the last state, as folded.png in the run folder shows it." : null);
  if (!picture) return notice;
  const canvas = element("canvas", { class: "still", role: "img", "aria-label": "the folded body from three sides, and cut across" });
  createImageBitmap(new Blob([fromBase64(picture.textContent)], { type: "image/png" })).then((image) => {
    [canvas.width, canvas.height] = [image.width, image.height];
    canvas.getContext("2d").drawImage(image, 0, 0);
  });
  return [notice, canvas];
}
