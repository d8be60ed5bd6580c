// The page of a study.

const report = JSON.parse(document.getElementById("document").textContent);
const MOST_WARNINGS = 12;
// For scripts and tests: what the page shows.
window.gyrify = { report };

function showStudy({ study, colours }) {
  document.title = `${study.name} · gyrify`;
  const selection = createSelection(study.runs);
  const routes = createRoutes(study, colours);
  const open = (index) => routes.go("run", [index]);
  const redraw = () => [window.gyrify.panel && window.gyrify.panel.viewer, ...(window.gyrify.pair || [])]
    .forEach((viewer) => viewer && viewer.redraw());
  const page = document.getElementById("page");
  page.replaceChildren(createStudyHeader(study, createThemeSwitch(redraw)), ...createStudyNotices(study));
  if (study.axes.length >= 2) {
    page.append(block("Phase diagram", createPhase(study, colours, open)));
  }
  page.append(
    block("Runs", createFilter(study, selection), createCompareBar(study, selection, routes), createTable(study, selection, open),
      createPager(selection)),
    block("Shapes, at one scale", createGallery(study, selection, open), createPager(selection)));
  routes.follow();
}

function block(title, ...content) {
  return element("section", { class: "block" }, element("h2", {}, title), content);
}

function createStudyHeader(study, themeSwitch) {
  const varied = study.columns.filter((column) => column.is_given).map((column) => column.label);
  const ended = study.runs.filter((run) => run.status === "completed").length;
  return element("header", { class: "page-header" },
    element("div", {}, element("p", { class: "brand" }, "gyrify · study"), element("h1", {}, study.name),
      element("p", { class: "subtitle" }, `${ended} of ${study.runs.length} runs completed` +
        (varied.length ? ` · ${varied.join(", ")}` : ""))),
    themeSwitch);
}

function createStudyNotices(study) {
  return [createEarly(study), createWarnings(study), createMeshes(study)].filter(Boolean);
}

function createEarly(study) {
  const early = study.runs.filter((run) => run.status !== "completed");
  if (early.length === 0) return null;
  const shown = early.slice(0, 5).map((run) => element("li", {}, `${run.title}: ${run.status}. ${run.reason}`));
  return element("div", { class: "notice early", role: "alert" },
    element("strong", {}, `${early.length} of ${study.runs.length} runs did not complete.`),
    element("ul", {}, shown, early.length > 5 ? element("li", {}, `and ${early.length - 5} more`) : null));
}

// Each sentence once, with how many runs have it; a click opens them.
function createWarnings(study) {
  const [counts, count] = [new Map(), study.runs.length];
  for (const run of study.runs) for (const warning of run.warnings) counts.set(warning, (counts.get(warning) || 0) + 1);
  if (counts.size === 0) return null;
  const warned = study.runs.filter((run) => run.warnings.length).length;
  const shown = [...counts].sort((a, b) => b[1] - a[1]).slice(0, MOST_WARNINGS);
  const more = counts.size - shown.length;
  return element("details", { class: "notice" }, element("summary", {}, `${warned} of ${count} runs have warnings`),
    element("ul", {}, shown.map(([warning, n]) => element("li", {}, `${n} of ${count} runs: ${warning}`)),
      more > 0 ? element("li", {}, `and ${more} more: open a run to see its own`) : null));
}

// For how many runs the mesh is known to be converged.
function createMeshes(study) {
  const [count, counts] = [study.runs.length, new Map()];
  for (const { mesh } of study.runs) {
    const word = !mesh || mesh.converged === null ? "not checked" : mesh.converged ? "converged" : "not converged";
    counts.set(word, (counts.get(word) || 0) + 1);
  }
  return element("p", { class: "remark checked" },
    `Meshes: ${[...counts].map(([word, n]) => `${n} of ${count} ${word}`).join(", ")}.`);
}

function createCompareBar(study, selection, routes) {
  const button = element("button", {
    type: "button", class: "plain", click: () => routes.go("compare", selection.compared),
  }, "Show side by side");
  const text = element("span", { class: "faint" });
  const update = () => {
    const chosen = selection.compared.map((k) => study.runs[k]);
    const isReady = chosen.length === 2 && chosen.every((run) => run.payload);
    button.disabled = !isReady;
    text.textContent = chosen.length ? chosen.map((run) => run.title).join("  |  ") : "Tick two runs to compare them.";
  };
  selection.changed.listen(update);
  update();
  return element("div", { class: "filter" }, button, text);
}

// Thumbnails follow the table: the same runs in the same order.
function createGallery(study, selection, onOpen) {
  const largest = Math.max(...study.runs.map((run) => (run.outline ? run.outline.width_mm : 0)));
  const thumbnails = new Map();
  const thumbnail = (k) => {
    if (!thumbnails.has(k)) thumbnails.set(k, createThumbnail(study.runs[k], k, largest, onOpen));
    return thumbnails.get(k);
  };
  const host = element("div", { class: "gallery" });
  const update = () => host.replaceChildren(...selection.shown().map(thumbnail));
  selection.changed.listen(update);
  update();
  return host;
}

showStudy(report);
