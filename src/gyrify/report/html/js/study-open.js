// Runs opened from a study, in a dialog over the page: one, or two side by side.

// A dialog that lets go of its scenes when it closes: browsers keep only a few.
function openDialog(title, content, panels) {
  const close = element("button", { type: "button", class: "theme", "aria-label": "close", title: "Close (Esc)" }, "✕");
  const dialog = element("dialog", { class: "opened", "aria-label": title },
    element("div", { class: "opened-header" }, element("h2", {}, title), close), content);
  close.addEventListener("click", () => dialog.close());
  dialog.addEventListener("close", () => {
    for (const panel of panels()) panel.release();
    dialog.remove();
  });
  document.body.append(dialog);
  dialog.showModal();
  return dialog;
}

function openRun(study, index, colours) {
  const run = study.runs[index];
  const panels = [];
  const place = element("div", {});
  const content = [createNotices({ grown: grownPart(run), ...run }), createChecked(run), place, createRunFooter(run)];
  const dialog = openDialog(run.title, content, () => panels);
  if (!run.payload) {
    place.append(element("div", { class: "large-outline" }, createOutline(run.outline, run.title)),
      element("p", { class: "remark" }, run.missing || "This page has no room for the scene of this run; its own report has it."));
    return { dialog };
  }
  const drawn = createPanel(run, run.payload, colours, { isActive: () => dialog.open }).then((panel) => {
    if (!dialog.isConnected) {
      panel.release(); // it was closed before it was drawn
      return;
    }
    panels.push(panel);
    show(panel.player.host, panel.model.nFrames > 1);
    panel.host.querySelector(".plots").append(createValues(study, run));
    place.append(panel.host);
    window.gyrify.panel = panel;
  });
  return { dialog, drawn };
}

function grownPart(run) {
  const times = run.plots ? run.plots[0].times : [0];
  return times[times.length - 1] / (run.duration || 1);
}

function createValues(study, run) {
  return pairs(study.columns.map(({ key, label, decimals }) => {
    const value = run.values[key];
    return [label, typeof value === "number" && decimals ? fixed(value, decimals) : value, ""];
  }));
}

// What is not on this page, and how to get it.
function createRunFooter(run) {
  if (!run.toml) return null;
  const isLast = run.frames && run.frames.indices.length === 1;
  return element("div", { class: "opened-footer" },
    element("p", { class: "faint" }, isLast ? "The study keeps the last state of each run. All of them, with depth, energy and contact:" :
      "All states and fields of this run:"),
    element("div", { class: "code" }, element("pre", {}, run.command)),
    element("button", { type: "button", class: "plain", click: () => saveText(run.toml, "config.toml") }, "Save config.toml"));
}
