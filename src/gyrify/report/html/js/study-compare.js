// Two runs side by side: one field, one range of colours, one growth time, one view.

function openComparison(study, [first, second], colours) {
  const runs = [study.runs[first], study.runs[second]];
  const viewers = [];
  const place = element("div", { class: "pair" });
  const controls = element("div", { class: "toolbar" });
  const foot = element("div", {});
  const dialog = openDialog("Side by side", [controls, place, foot, createDifferences(study, runs)], () => viewers.map(releaser));
  return { dialog, drawn: drawPair({ dialog, runs, viewers, place, controls, foot, colours }) };
}

async function drawPair({ dialog, runs, viewers, place, controls, foot, colours }) {
  for (const run of runs) {
    const model = await loadModel(run, run.payload);
    viewers.push(createViewer(model, colours));
  }
  if (!dialog.isConnected) {
    viewers.forEach((viewer) => viewer.release());
    return;
  }
  const tooltips = viewers.map(createTooltip);
  const pointers = viewers.map((viewer, k) => connectPointer(viewer, tooltips[k]));
  viewers.forEach((viewer, k) => place.append(element("figure", {}, element("h3", {}, runs[k].title),
    element("div", { class: "scene" }, viewer.canvas, createColourBar(viewer, colours), createScaleBar(viewer), tooltips[k].host))));
  shareView(viewers, pointers);
  const fields = runs[0].frames.fields.filter((field) => viewers[1].model.fields.has(field.name));
  const setField = (name) => viewers.forEach((viewer) => viewer.set({ field: name, limits: commonLimits(viewers, name) }));
  controls.append(createFieldChoice(fields, "von_mises", setField).host);
  const player = createCommonPlayer(viewers, runs);
  if (player) foot.append(player.host);
  setField("von_mises");
  window.gyrify.pair = viewers;
}

function releaser(viewer) {
  return { release: () => viewer.release() };
}

function commonLimits(viewers, name) {
  if (name === "region") return null;
  const ranges = viewers.map((viewer) => viewer.model.fields.get(name).range);
  return [Math.min(...ranges.map((r) => r[0])), Math.max(...ranges.map((r) => r[1]))];
}

// One scale, so that sizes can be compared; what moves one view moves the other.
function shareView(viewers, pointers) {
  viewers.forEach((viewer, k) => {
    const other = viewers[1 - k];
    viewer.camera.ceiling = () => other.camera.natural;
    // The other fits itself again where this one has come out smaller.
    viewer.drawn.listen(() => {
      if (!other.camera.isFitted || other.camera.scale <= viewer.camera.natural * 1.0001) return;
      other.camera.fit();
      other.redraw();
    });
    pointers[k].moved.listen(() => {
      if (viewer.camera.isFitted) other.camera.fit();
      else other.camera.copyFrom(viewer.camera);
      other.redraw();
    });
  });
}

// Growth time as a part of each run's duration; none where only last states are kept.
function createCommonPlayer(viewers, runs) {
  const parts = viewers.map((viewer, k) => viewer.model.times.map((time) => time / runs[k].duration));
  const longer = parts[0].length >= parts[1].length ? 0 : 1;
  if (parts[longer].length < 2) return null;
  const player = createPlayer(parts[longer].map((part) => part * runs[longer].duration), runs[longer].duration);
  player.changed.listen((frame) => viewers.forEach((viewer, k) => {
    const distances = parts[k].map((part) => Math.abs(part - parts[longer][frame]));
    viewer.set({ frame: distances.indexOf(Math.min(...distances)) });
  }));
  connectKeys(player, () => player.host.isConnected);
  player.seek(parts[longer].length - 1);
  return player;
}

function createDifferences(study, runs) {
  const rows = study.columns.map((column) => element("tr", {}, element("th", { scope: "row" }, column.label),
    runs.map((run) => {
      const value = run.values[column.key];
      return element("td", { class: "number" }, typeof value === "number" && column.decimals ? fixed(value, column.decimals) : brief(value));
    })));
  const head = element("tr", {}, element("th", {}), runs.map((run) => element("th", { scope: "col", class: "number" }, run.name)));
  return element("div", { class: "scroll" }, element("table", { class: "differences" }, element("thead", {}, head), element("tbody", {}, rows)));
}
