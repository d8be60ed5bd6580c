// What lies over the scene: colour bar, scale bar, and the value under the pointer.

function createColourBar(viewer, colours) {
  const title = element("div", { class: "bar-title" });
  const strip = element("div", { class: "bar-strip" });
  const labels = element("div", { class: "bar-labels" });
  const swatches = element("div", { class: "swatches" });
  const host = element("div", { class: "colour-bar", "aria-hidden": "true" }, title,
    element("div", { class: "bar-body" }, strip, labels), swatches);
  let shown = "";
  const update = () => {
    const field = viewer.field();
    const isTissue = field === REGION || viewer.state.mode !== null;
    const limits = viewer.limits();
    const beyond = beyondOf(limits, viewer.extremes());
    const key = [field.name, isTissue, ...limits, ...beyond].join();
    if (key === shown) return;
    shown = key;
    title.textContent = isTissue ? "tissue" : field.unit ? `${field.label} [${field.unit}]` : field.label;
    show(strip.parentNode, !isTissue);
    show(swatches, isTissue);
    if (isTissue) drawSwatches(swatches, colours.region);
    else drawBar(strip, labels, colours[field.colours], limits, beyond);
  };
  viewer.drawn.listen(update);
  return host;
}

function drawSwatches(host, [white, grey]) {
  const swatch = (colour, text) => {
    const patch = element("span", { class: "swatch" });
    patch.style.background = colour;
    return element("div", {}, patch, text);
  };
  host.replaceChildren(swatch(grey, "grey matter"), swatch(white, "white matter"));
}

// Whether values lie below and above the ends of the colours.
function beyondOf([low, high], [least, most]) {
  const rounding = 1e-6 * (high - low);
  return [least < low - rounding, most > high + rounding];
}

// A bar whose end is pointed has values beyond it, in the colour of that end.
function drawBar(strip, labels, samples, limits, [isBelow, isAbove] = [false, false]) {
  strip.style.background = cssGradient(samples, "to top");
  const point = (name, colour, isThere) => {
    const tip = element("span", { class: `bar-tip ${name}`, hidden: !isThere });
    tip.style.background = colour;
    return tip;
  };
  strip.replaceChildren(point("above", samples[samples.length - 1], isAbove), point("below", samples[0], isBelow));
  const [low, high] = limits;
  labels.replaceChildren(...ticks(low, high, 5).map((value) => {
    const label = element("span", { class: "bar-label" }, brief(value));
    label.style.bottom = `${(100 * (value - low)) / (high - low)}%`;
    return label;
  }));
}

// A bar of a round length, about a quarter of the scene at most.
function createScaleBar(viewer) {
  const line = element("div", { class: "scale-line" });
  const text = element("span", {});
  const host = element("div", { class: "scale-bar", "aria-hidden": "true" }, line, text);
  viewer.drawn.listen(() => {
    const { scale, width } = viewer.camera;
    const wanted = Math.min(0.25 * width, 140) / scale;
    const power = 10 ** Math.floor(Math.log10(wanted));
    const length = [5, 2, 1].map((k) => k * power).find((l) => l <= wanted * 1.0001);
    line.style.width = `${length * scale}px`;
    text.textContent = withUnit(brief(length), "mm");
  });
  return host;
}

function createTooltip() {
  const host = element("div", { class: "tooltip", role: "status", "aria-live": "off", hidden: true });
  const tissue = (found) => (found.region === 1 ? "grey matter" : "white matter");
  return {
    host,
    hide: () => show(host, false),
    show(found, px, py, { width, height }) {
      const { field } = found;
      const { text, error } = field === REGION ? { text: tissue(found) } : exactly(found);
      const place = `${["x", "y", "z"].filter((axis) => axis in found).map((axis) => `${axis} ${brief(found[axis])}`).join(", ")} mm`;
      const what = found.node === undefined ? `cell ${found.cell} · ${tissue(found)}` : found.node;
      host.replaceChildren(
        element("strong", { class: "tooltip-value" }, field === REGION ? text : withUnit(text, field.unit)),
        element("span", {}, field === REGION ? `cell ${found.cell}` : what),
        element("span", { class: "faint" }, place),
        field === REGION ? null : element("span", { class: "faint" }, `shown to ± ${brief(error, 2)}`));
      show(host, true);
      // Beside the pointer, and wholly within the scene.
      const [w, h] = [host.offsetWidth, host.offsetHeight];
      const left = px + 14 + w <= width - 4 ? px + 14 : px - 14 - w;
      const top = py + 14 + h <= height - 4 ? py + 14 : py - 14 - h;
      host.style.left = `${clamp(left, 4, Math.max(width - w - 4, 4))}px`;
      host.style.top = `${clamp(top, 4, Math.max(height - h - 4, 4))}px`;
    },
  };
}

function exactly({ value, field, frame }) {
  return Number.isNaN(value) ? { text: "undefined", error: 0 } : measured(value, field.step[frame] / 2);
}
