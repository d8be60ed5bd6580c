// The table of a study: sorted by any column, filtered by words and by how runs ended.

const PAGE_SIZES = [24, 96, Infinity];

// What is shown, and in which order; others listen to it.
function createSelection(runs) {
  const selection = {
    words: "", status: "all", key: null, isRising: true, compared: [], page: 0, pageSize: PAGE_SIZES[0], changed: signal(),
  };
  // What is sought are beginnings of words: "36" is not to find 1.36, or a name with these digits in it.
  const known = runs.map((run) =>
    [run.name, run.title, run.status, run.reason, run.values.phenotype || ""].join(" ").toLowerCase().split(/\s+/));
  selection.indices = () => {
    const words = selection.words.toLowerCase().split(/\s+/).filter(Boolean);
    const found = runs.map((_, k) => k).filter((k) =>
      (selection.status === "all" || runs[k].status === selection.status) &&
      words.every((word) => known[k].some((token) => token.startsWith(word))));
    return selection.key === null ? found : sorted(found, runs, selection);
  };
  // Those on the page of the table that is open; what is sought or sorted begins at the first one.
  selection.nPages = () => Math.max(Math.ceil(selection.indices().length / selection.pageSize), 1);
  selection.shown = () => {
    selection.page = clamp(selection.page, 0, selection.nPages() - 1);
    const start = selection.page ? selection.page * selection.pageSize : 0; // 0 times infinity is no number
    return selection.indices().slice(start, start + selection.pageSize);
  };
  selection.restart = () => {
    selection.page = 0;
    selection.changed.emit();
  };
  selection.compare = (index) => {
    const { compared } = selection;
    const place = compared.indexOf(index);
    if (place >= 0) compared.splice(place, 1);
    else compared.push(index);
    while (compared.length > 2) compared.shift();
    selection.changed.emit();
  };
  return selection;
}

// Numbers by size, words by alphabet; what is missing comes last either way.
function sorted(indices, runs, { key, isRising }) {
  const value = (k) => (key === "status" || key === "name" ? runs[k][key] : runs[k].values[key]);
  const isMissing = (v) => v === null || v === undefined;
  return indices.slice().sort((a, b) => {
    const [x, y] = [value(a), value(b)];
    if (isMissing(x) || isMissing(y)) return isMissing(x) - isMissing(y) || a - b;
    const order = typeof x === "number" && typeof y === "number" ? x - y : String(x).localeCompare(String(y), "en");
    return (isRising ? order : -order) || a - b;
  });
}

function createTable(study, selection, onOpen) {
  const body = element("tbody", {});
  const columns = [{ key: "status", label: "status" }, ...study.columns];
  const heads = columns.map((column) => createHead(column, selection));
  const update = () => {
    heads.forEach((head) => head.update());
    body.replaceChildren(...selection.shown().map((k) => createRow(study.runs[k], k, columns, selection, onOpen)));
  };
  selection.changed.listen(update);
  update();
  const lead = [element("th", { scope: "col" }, "compare"), element("th", { scope: "col" }, "run")];
  return withScrollHint(element("table", { class: "results" },
    element("thead", {}, element("tr", {}, lead, heads.map((head) => head.host))), body));
}

// A wide table in a box of its own, which says so while there is more to its right.
function withScrollHint(table) {
  const box = element("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": "results, scrolls sideways" }, table);
  const hint = element("button", { type: "button", class: "scroll-hint", hidden: true,
    click: () => box.scrollBy({ left: 0.7 * box.clientWidth, behavior: "smooth" }) }, "more columns →");
  const update = () => show(hint, box.scrollLeft + box.clientWidth < box.scrollWidth - 2);
  box.addEventListener("scroll", update);
  new ResizeObserver(update).observe(box);
  new ResizeObserver(update).observe(table);
  return element("div", { class: "scroll-frame" }, box, hint);
}

// Which runs of how many are on view, and the way to the others; nothing where all have room.
function createPager(selection) {
  const text = element("span", { "aria-live": "polite" });
  const turn = (by, label, sign) => element("button", {
    type: "button", class: "plain", "aria-label": label, title: label, click: () => {
      selection.page += by;
      selection.changed.emit();
    },
  }, sign);
  const [before, after] = [turn(-1, "previous runs", "‹"), turn(1, "next runs", "›")];
  const size = element("select", { "aria-label": "runs on a page", change: () => {
    selection.pageSize = PAGE_SIZES[size.selectedIndex];
    selection.restart();
  } }, PAGE_SIZES.map((n) => element("option", {}, Number.isFinite(n) ? `${n} on a page` : "all on one page")));
  const host = element("nav", { class: "pager", "aria-label": "pages of runs" }, before, text, after, size);
  const update = () => {
    const [count, shown] = [selection.indices().length, selection.shown()];
    const start = selection.page * (Number.isFinite(selection.pageSize) ? selection.pageSize : 0);
    text.textContent = shown.length ? `${start + 1} to ${start + shown.length} of ${count}` : "no run";
    before.disabled = selection.page === 0;
    after.disabled = selection.page >= selection.nPages() - 1;
    show(host, count > PAGE_SIZES[0]);
  };
  selection.changed.listen(update);
  update();
  return host;
}

function createHead({ key, label, is_number: isNumber }, selection) {
  const button = element("button", { type: "button", class: "sort" }, label);
  const host = element("th", { scope: "col", class: isNumber && "number" }, button);
  button.addEventListener("click", () => {
    selection.isRising = selection.key === key ? !selection.isRising : true;
    selection.key = key;
    selection.restart();
  });
  const update = () => {
    const isSorted = selection.key === key;
    host.setAttribute("aria-sort", isSorted ? (selection.isRising ? "ascending" : "descending") : "none");
  };
  return { host, update };
}

function createRow(run, index, columns, selection, onOpen) {
  const box = element("input", {
    type: "checkbox", checked: selection.compared.includes(index), "aria-label": `compare ${run.title}`,
    change: () => selection.compare(index),
  });
  const open = element("button", { type: "button", class: "link", click: () => onOpen(index) }, run.name);
  const cells = columns.map(({ key, decimals, is_number: isNumber }) => {
    const value = key === "status" ? run.status : run.values[key];
    const isMissing = value === null || value === undefined;
    const text = isMissing ? "–" : typeof value === "number" && decimals ? fixed(value, decimals) : brief(value);
    return element("td", { class: isNumber && "number" }, text);
  });
  return element("tr", { class: run.status !== "completed" && "is-early", title: run.reason || null },
    element("td", {}, box), element("th", { scope: "row" }, open), cells);
}

function createFilter(study, selection) {
  const search = element("input", {
    type: "search", placeholder: "Filter runs", "aria-label": "filter runs",
    input: () => {
      selection.words = search.value;
      selection.restart();
    },
  });
  const states = ["all", ...new Set(study.runs.map((run) => run.status))];
  const status = element("select", {
    "aria-label": "filter by status",
    change: () => {
      selection.status = status.value;
      selection.restart();
    },
  }, states.map((value) => element("option", { value }, value === "all" ? "any status" : value)));
  const count = element("span", { class: "faint", "aria-live": "polite" });
  const update = () => { count.textContent = `${selection.indices().length} of ${study.runs.length} runs`; };
  selection.changed.listen(update);
  update();
  return element("div", { class: "filter" }, search, states.length > 2 ? status : null, count);
}
