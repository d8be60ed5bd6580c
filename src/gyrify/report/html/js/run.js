// The page of one run.

const report = JSON.parse(document.getElementById("document").textContent);
// For scripts and tests: what the page shows, once it is drawn.
window.gyrify = { report };

async function showRun({ run, colours }) {
  document.title = `${run.name} · gyrify`;
  const page = document.getElementById("page");
  const themeSwitch = createThemeSwitch(() => window.gyrify.panel && window.gyrify.panel.viewer.redraw());
  const place = element("main", { class: "main" });
  page.replaceChildren(createHeader(run, themeSwitch), ...createNotices(run), createNumbers(run), createChecked(run), place,
    createSettings(run), createSolver(run), createRerun(run), createHints(run));
  try {
    const panel = await createPanel(run, "payload-0", colours);
    place.append(panel.host);
    window.gyrify.panel = panel;
  } catch (error) {
    place.append(element("p", { class: "notice" }, `The scene cannot be shown: ${error.message}`));
    throw error;
  }
}

function createHints(run) {
  const { indices, fields, n_dim, position } = run.frames;
  const key = (text) => element("kbd", {}, text);
  return element("footer", { class: "hints" },
    element("p", {}, key("←"), " ", key("→"), " state by state, ", key("space"), " play, ", key("+"), " ", key("−"), " ",
      key("0"), n_dim === 3 ? " zoom and arrows turn on the scene, drag to turn, with shift to pan" : " zoom on the scene, drag to pan",
      ", click into a plot to go there."),
    element("p", {}, `${indices.length} of ${run.plots[0].times.length} states, ${fields.length} fields. ` +
      `Positions are stored to 1/${position.codes - 1} of the ${n_dim === 3 ? "body" : "slice"}'s size; every value under the pointer says how exact it is.`));
}

showRun(report);
