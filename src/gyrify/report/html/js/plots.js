// Small plots against growth time with a common marker; a click or a drag moves it.

const PLOT = { width: 360, height: 178, left: 46, right: 10, top: 8, bottom: 36 };
const DASHES = ["", "5 3", "1.5 2.5", "8 3 2 3"];

// `plots` of one run or, to compare, of several: each line may carry a `run` number.
function createPlots(plots, { duration, onset, onSeek }) {
  const drawn = plots.map((plot) => createPlot(plot, duration, onset && onset.growth_time, onSeek));
  const key = (name, text) => element("span", {}, svg("svg", { viewBox: "0 0 8 14", class: "key-upright", "aria-hidden": "true" },
    svg("line", { class: name, x1: 4, x2: 4, y1: 0, y2: 14 })), text);
  const keys = element("p", { class: "line-keys" }, key("marker-key", "growth time on view"),
    onset ? key("onset-key", `onset: stability lost at ${brief(onset.growth_time)}`) : null);
  return {
    host: element("div", { class: "plots" }, keys, drawn.map((plot) => plot.host)),
    mark: (time) => drawn.forEach((plot) => plot.mark(time)),
  };
}

function createPlot(plot, duration, onset, onSeek) {
  const range = valueRange(plot.lines);
  const inner = { w: PLOT.width - PLOT.left - PLOT.right, h: PLOT.height - PLOT.top - PLOT.bottom };
  const x = (time) => PLOT.left + (inner.w * time) / duration;
  const y = (value) => PLOT.top + inner.h * (1 - (value - range[0]) / (range[1] - range[0]));
  const marker = svg("line", { class: "marker", y1: PLOT.top, y2: PLOT.top + inner.h });
  const dots = plot.lines.map((_, k) => svg("circle", { class: `dot line-${k}`, r: 3.2 }));
  const legend = plot.lines.map((line, k) => legendEntry(line, k));
  const label = `${plot.title}${plot.unit ? ` in ${plot.unit}` : ""} against growth time`;
  const picture = svg("svg", { viewBox: `0 0 ${PLOT.width} ${PLOT.height}`, class: "plot", role: "img", "aria-label": label },
    axes(x, y, range, duration),
    onset ? svg("line", { class: "onset", x1: x(onset), x2: x(onset), y1: PLOT.top, y2: PLOT.top + inner.h }) : null,
    plot.lines.map((line, k) => svg("path", {
      class: `curve line-${k}`, d: pathOf(line.times || plot.times, line.values, x, y), "stroke-dasharray": DASHES[k % 4],
    })),
    marker, dots);
  keepTextLegible(picture, PLOT.width);
  connectSeek(picture, (part) => onSeek(clamp((part * PLOT.width - PLOT.left) / inner.w, 0, 1) * duration));
  const mark = (time) => {
    marker.setAttribute("x1", x(time));
    marker.setAttribute("x2", x(time));
    plot.lines.forEach((line, k) => placeDot(dots[k], legend[k], line, line.times || plot.times, time, x, y));
  };
  const heading = element("h3", {}, plot.title, plot.unit ? element("span", { class: "faint" }, ` ${plot.unit}`) : null);
  return { host: element("figure", {}, heading, element("div", { class: "legend" }, legend.map((e) => e.host)), picture), mark };
}

function legendEntry(line, k) {
  const value = element("strong", {});
  const key = svg("svg", { viewBox: "0 0 18 6", class: "key" },
    svg("line", { class: `curve line-${k}`, x1: 0, x2: 18, y1: 3, y2: 3, "stroke-dasharray": DASHES[k % 4] }));
  return { host: element("span", {}, key, `${line.label} `, value), value };
}

function placeDot(dot, entry, line, times, time, x, y) {
  const value = interpolated(times, line.values, time);
  entry.value.textContent = brief(value, 3);
  dot.setAttribute("visibility", value === null ? "hidden" : "visible");
  if (value === null) return;
  dot.setAttribute("cx", x(time));
  dot.setAttribute("cy", y(value));
}

// States are stored at some times; frames are among them, so that this hits one but for other runs' times.
function interpolated(times, values, time) {
  const after = times.findIndex((t) => t >= time - 1e-9);
  if (after < 0) return null;
  if (after === 0 || Math.abs(times[after] - time) < 1e-9 * Math.abs(time)) return values[after];
  const [a, b] = [values[after - 1], values[after]];
  if (a === null || b === null) return null;
  return a + ((b - a) * (time - times[after - 1])) / (times[after] - times[after - 1]);
}

function valueRange(lines) {
  const values = lines.flatMap((line) => line.values).filter((value) => value !== null);
  if (values.length === 0) return [0, 1];
  const [low, high] = [Math.min(...values), Math.max(...values)];
  if (low === 0 && high === 0) return [0, 1];
  // A flat line is drawn in the middle of a range that does not make noise of its rounding.
  const pad = Math.max(0.06 * (high - low), 0.01 * Math.abs(high), 1e-9);
  return [low === 0 ? 0 : low - pad, high + pad];
}

function axes(x, y, range, duration) {
  const found = [];
  for (const value of ticks(range[0], range[1], 3)) {
    found.push(svg("line", { class: "grid", x1: x(0), x2: x(duration), y1: y(value), y2: y(value) }));
    found.push(svg("text", { class: "tick", x: PLOT.left - 6, y: y(value) + 3.5, "text-anchor": "end" }, brief(value)));
  }
  for (const time of ticks(0, duration, 5)) {
    const anchor = time === 0 ? "start" : time > 0.98 * duration ? "end" : "middle";
    found.push(svg("text", { class: "tick", x: x(time), y: PLOT.height - 20, "text-anchor": anchor }, brief(time)));
  }
  const middle = PLOT.left + (PLOT.width - PLOT.left - PLOT.right) / 2;
  found.push(svg("text", { class: "tick", x: middle, y: PLOT.height - 4, "text-anchor": "middle" }, "growth time"));
  return found;
}

function pathOf(times, values, x, y) {
  let isPenDown = false;
  return values.map((value, k) => {
    const step = value === null ? "" : `${isPenDown ? "L" : "M"}${x(times[k]).toFixed(1)} ${y(value).toFixed(1)}`;
    isPenDown = value !== null;
    return step;
  }).join("");
}

// Text of a picture that is drawn smaller than it was made for is made larger, to stay as large on the screen.
function keepTextLegible(picture, width) {
  new ResizeObserver(() => {
    const shown = picture.getBoundingClientRect().width;
    if (shown > 0) picture.style.setProperty("--text-scale", Math.max(width / shown, 0.5));
  }).observe(picture);
}

function connectSeek(picture, onSeek) {
  const seek = (event) => {
    const box = picture.getBoundingClientRect();
    onSeek((event.clientX - box.left) / box.width);
  };
  picture.addEventListener("pointerdown", (event) => {
    picture.setPointerCapture(event.pointerId);
    seek(event);
  });
  picture.addEventListener("pointermove", (event) => {
    if (picture.hasPointerCapture(event.pointerId)) seek(event);
  });
}
