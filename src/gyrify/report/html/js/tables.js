// What a page says besides the scene: numbers, warnings, settings, solver, how to run it again.

const ENDINGS = {
  failed: "This run failed",
  stopped: "This run was stopped by a limit",
  interrupted: "This run was interrupted",
  running: "This run has not ended",
};

function createHeader(run, themeSwitch) {
  return element("header", { class: "page-header" },
    element("div", {}, element("p", { class: "brand" }, "gyrify · run"), element("h1", {}, run.name),
      element("p", { class: "subtitle" }, run.subtitle)),
    themeSwitch);
}

// An early end comes first and cannot be overlooked.
function createNotices(run) {
  const notices = [];
  if (run.status !== "completed") {
    const ending = ENDINGS[run.status] || `This run is ${run.status}`;
    notices.push(element("div", { class: "notice early", role: "alert" },
      element("strong", {}, `${ending} at ${brief(100 * run.grown, 3)} % of growth.`),
      element("p", {}, `${run.reason} ${run.advice}`.trim() || "Everything below is of the states that it reached.")));
  }
  // Several would push the scene out of sight: they are opened by a click.
  if (run.warnings.length === 1) notices.push(element("div", { class: "notice" }, run.warnings[0]));
  if (run.warnings.length > 1)
    notices.push(element("details", { class: "notice" }, element("summary", {}, `${run.warnings.length} warnings about this run`),
      element("ul", {}, run.warnings.map((warning) => element("li", {}, warning)))));
  return notices;
}

function createNumbers(run) {
  return element("dl", { class: "numbers" }, run.numbers.map(([label, value, unit, decimals, about]) =>
    element("div", { title: about }, element("dt", {}, label), element("dd", {}, decimals === null ? brief(value) : fixed(value, decimals),
      unit ? element("span", { class: "faint" }, ` ${unit}`) : null))));
}

// Whether the mesh is known to be converged for the numbers, and how to find out.
function createChecked(run) {
  if (!run.mesh) return null;
  return element("p", { class: "remark checked" }, `${run.mesh.sentence} Check: `, element("code", {}, run.mesh.command));
}

function section(title, isOpen, ...content) {
  return element("details", { class: "section", open: isOpen }, element("summary", {}, element("h2", {}, title)), content);
}

function createSettings(run) {
  const body = element("tbody", {});
  const search = element("input", { type: "search", placeholder: "Find a setting", "aria-label": "find a setting" });
  const changedOnly = createSwitch("changed from the default only", "", false, () => fill());
  const fill = () => {
    const words = search.value.toLowerCase();
    body.replaceChildren(...run.settings
      .filter((s) => (!changedOnly.input.checked || s.changed) && `${s.key} ${s.about} ${s.value}`.toLowerCase().includes(words))
      .map((s) => element("tr", { class: s.changed && "changed" }, element("th", { scope: "row" }, s.key),
        element("td", { class: "value" }, s.value), element("td", {}, s.unit), element("td", {}, s.about),
        element("td", { class: "faint" }, s.source))));
  };
  search.addEventListener("input", fill);
  fill();
  const head = ["key", "value", "unit", "what it is", "source"].map((text) => element("th", { scope: "col" }, text));
  return section("Configuration", false, element("div", { class: "filter" }, search, changedOnly.host),
    element("div", { class: "scroll" }, element("table", { class: "settings" }, element("thead", {}, element("tr", {}, head)), body)));
}

function pairs(rows) {
  return element("table", { class: "pairs" }, element("tbody", {}, rows.map(([label, value, unit]) =>
    element("tr", {}, element("th", { scope: "row" }, label), element("td", {}, withUnit(brief(value, 5), unit))))));
}

function createSolver(run) {
  return section("Solution and versions", false, element("div", { class: "columns" },
    element("div", {}, element("h3", {}, "Solution"), pairs(run.solver),
      run.note ? element("p", { class: "remark" }, run.note) : null),
    element("div", {}, element("h3", {}, "Versions"), pairs(run.versions)),
    element("div", {}, element("h3", {}, "Hashes"), element("dl", { class: "hashes" }, run.hashes.map(([label, hash]) =>
      [element("dt", {}, label), element("dd", {}, element("code", {}, hash))])))));
}

// The configuration as a file, and the command that takes it.
function createRerun(run) {
  const copy = (text) => {
    const button = element("button", { type: "button", class: "plain" }, "Copy");
    button.addEventListener("click", () => copyText(text).then((done) => { button.textContent = done ? "Copied" : "Select and copy"; }));
    return button;
  };
  const save = element("button", { type: "button", class: "plain", click: () => saveText(run.toml, "config.toml") }, "Save config.toml");
  return section("Run it again", false,
    element("p", {}, "Equal configurations and versions give equal results, to the last byte."),
    element("div", { class: "code" }, element("pre", {}, run.command), copy(run.command)),
    element("div", { class: "code" }, element("pre", {}, run.toml), element("div", {}, copy(run.toml), save)));
}

async function copyText(text) {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    return false;
  }
}

function saveText(text, name) {
  const url = URL.createObjectURL(new Blob([text], { type: "application/toml" }));
  element("a", { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 1000);
}
