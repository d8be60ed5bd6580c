// The phase diagram: any quantity over two of the parameters that vary.

const PHASE = { width: 640, height: 420, left: 70, right: 14, top: 12, bottom: 52 }; // CSS pixels
const PHASE_NARROWEST = 280;

function createPhase(study, colours, onOpen) {
  const choices = { x: study.axes[0], y: study.axes[1] };
  const quantities = study.columns.filter((column) => !column.is_given && column.is_number && column.key !== "n_warnings");
  choices.quantity = quantities[0] && quantities[0].key;
  const picture = element("div", { class: "phase-picture" });
  const bar = element("div", { class: "phase-bar" });
  const label = (key) => study.columns.find((column) => column.key === key);
  let width = PHASE.width;
  const update = () => {
    const cells = phaseCells(study.runs, choices);
    const found = cells.map((cell) => cell.mean).filter((value) => value !== null);
    const range = found.length ? [Math.min(...found), Math.max(...found)] : [0, 1];
    picture.replaceChildren(drawPhase(cells, choices, range, { label, colours, onOpen, width }));
    bar.replaceChildren(phaseBar(label(choices.quantity), range, colours.sequential));
  };
  const select = (name, options) => {
    const host = element("select", { change: () => { choices[name] = host.value; update(); } },
      options.map((column) => element("option", { value: column.key, selected: column.key === choices[name] }, column.label)));
    return host;
  };
  const axes = study.axes.map(label);
  const controls = element("div", { class: "filter" },
    element("label", {}, "quantity ", select("quantity", quantities)),
    axes.length > 2 ? element("label", {}, "across ", select("x", axes)) : null,
    axes.length > 2 ? element("label", {}, "up ", select("y", axes)) : null);
  update();
  // A pixel of the picture is one of the screen, so that its text is as large as that of the page.
  new ResizeObserver(() => {
    const found = Math.max(Math.round(picture.clientWidth), PHASE_NARROWEST);
    if (found === width || picture.clientWidth < 2) return;
    width = found;
    update();
  }).observe(picture);
  return element("div", {}, controls, element("div", { class: "phase" }, picture, bar));
}

// Runs of equal parameters make one cell, with the mean of those that completed.
function phaseCells(runs, { x, y, quantity }) {
  const cells = new Map();
  runs.forEach((run, index) => {
    const key = `${run.values[x]} ${run.values[y]}`;
    if (!cells.has(key)) cells.set(key, { x: run.values[x], y: run.values[y], runs: [], values: [] });
    const cell = cells.get(key);
    cell.runs.push(index);
    const value = run.values[quantity];
    if (run.status === "completed" && typeof value === "number") cell.values.push(value);
  });
  return [...cells.values()].map((cell) => ({
    ...cell,
    mean: cell.values.length ? cell.values.reduce((a, b) => a + b, 0) / cell.values.length : null,
  }));
}

// Few distinct values make a grid of cells; scattered ones are points on linear axes.
function drawPhase(cells, { x, y, quantity }, range, { label, colours, onOpen, width }) {
  const values = (name) => [...new Set(cells.map((cell) => cell[name]))].sort((a, b) => a - b);
  const [xs, ys] = [values("x"), values("y")];
  const isGrid = xs.length * ys.length <= 2 * cells.length && xs.length <= 24 && ys.length <= 24;
  const inner = { w: width - PHASE.left - PHASE.right, h: PHASE.height - PHASE.top - PHASE.bottom };
  const place = {
    x: isGrid ? gridPlace(xs, PHASE.left, inner.w) : linearPlace(xs, PHASE.left, inner.w),
    y: isGrid ? gridPlace(ys, PHASE.top + inner.h, -inner.h) : linearPlace(ys, PHASE.top + inner.h, -inner.h),
  };
  const size = isGrid ? [inner.w / xs.length - 3, inner.h / ys.length - 3] : [16, 16];
  const marks = cells.map((cell) => phaseMark(cell, [place.x(cell.x), place.y(cell.y)], size, {
    fill: colourAt(colours.sequential, cell.mean, range), isGrid, onOpen,
    says: `${label(x).label} ${brief(cell.x)}, ${label(y).label} ${brief(cell.y)}`, column: label(quantity),
  }));
  const text = (at, content, extra = {}) => svg("text", { class: "tick", x: at[0], y: at[1], "text-anchor": "middle", ...extra }, content);
  const bottom = PHASE.top + inner.h;
  return svg("svg", { viewBox: `0 0 ${width} ${PHASE.height}`, class: "phase-svg", role: "group", "aria-label": "phase diagram" },
    thinned(isGrid ? xs : ticks(xs[0], xs[xs.length - 1], 6), inner.w, 44).map((v) => text([place.x(v), bottom + 18], brief(v, 3))),
    thinned(isGrid ? ys : ticks(ys[0], ys[ys.length - 1], 6), inner.h, 18).map((v) => text([PHASE.left - 8, place.y(v) + 4], brief(v, 3), { "text-anchor": "end" })),
    text([PHASE.left + inner.w / 2, PHASE.height - 10], label(x).label, { class: "axis-title" }),
    text([16, PHASE.top + inner.h / 2], label(y).label, { class: "axis-title", transform: `rotate(-90 16 ${PHASE.top + inner.h / 2})` }),
    marks);
}

// So many of the labels that each has room.
function thinned(labels, length, room) {
  const every = Math.max(1, Math.ceil((labels.length * room) / length));
  return labels.filter((_, k) => k % every === 0);
}

function gridPlace(values, start, length) {
  return (value) => start + (length * (values.indexOf(value) + 0.5)) / values.length;
}

function linearPlace(values, start, length) {
  const [low, high] = [values[0], values[values.length - 1]];
  return (value) => start + length * (0.04 + (0.92 * (value - low)) / (high - low || 1));
}

function phaseMark(cell, [px, py], [width, height], { fill, isGrid, onOpen, says, column }) {
  const told = cell.mean === null ? "no run completed" : `${column.label} ${valueText(cell.mean, column)}`;
  const several = cell.runs.length > 1 ? ` (mean of ${cell.values.length} runs)` : "";
  const open = () => onOpen(cell.runs[0]);
  const shape = svg("rect", {
    x: px - width / 2, y: py - height / 2, width, height, rx: isGrid ? 4 : 8, class: cell.mean === null ? "phase-none" : "phase-cell",
  });
  if (cell.mean !== null) shape.style.fill = fill;
  const ink = svg("text", { x: px, y: py + 4.5, "text-anchor": "middle", class: "phase-text" }, cell.mean === null ? "×" : valueText(cell.mean, column));
  ink.style.fill = cell.mean === null ? "" : inkOn(fill);
  return svg("g", {
    tabindex: 0, role: "button", class: "phase-mark", "aria-label": `open ${says}: ${told}${several}`, click: open,
    keydown: (event) => { if (event.key === "Enter") open(); },
  }, svg("title", {}, `${says}\n${told}${several}`), shape, isGrid && width > 34 ? ink : null);
}

function valueText(value, { decimals }) {
  return decimals ? fixed(value, Math.min(decimals, 2)) : brief(value, 3);
}

// Black or white, whichever stands out.
function inkOn(hex) {
  const [r, g, b] = bytesOf(hex);
  return 0.299 * r + 0.587 * g + 0.114 * b > 140 ? "#111111" : "#ffffff";
}

function phaseBar(column, range, samples) {
  const strip = element("div", { class: "bar-strip" });
  const labels = element("div", { class: "bar-labels" });
  drawBar(strip, labels, samples, range[1] > range[0] ? range : [range[0] - 0.5, range[0] + 0.5]);
  return element("div", {}, element("div", { class: "bar-title" }, column ? column.label : ""),
    element("div", { class: "bar-body" }, strip, labels));
}
