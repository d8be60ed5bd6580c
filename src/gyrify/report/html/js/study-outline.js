// Small pictures of slices, drawn from their outlines.

function outlinePath(values, isClosed) {
  const steps = [];
  for (let k = 0; k < values.length; k += 2) steps.push(`${k ? "L" : "M"}${values[k]} ${values[k + 1]}`);
  return steps.join("") + (isClosed ? "Z" : "");
}

// Tissues are filled between their lines: the cortex above the interface, white matter above the clamped side.
// At the scale of the largest slice of the study, down to a quarter of the picture.
function createOutline(outline, label, largest = 0) {
  if (!outline) return element("div", { class: "no-outline" }, "no picture");
  const { size: [width, height], is_closed: isClosed } = outline;
  const area = (upper, lower) => {
    if (isClosed) return outlinePath(upper, true) + outlinePath(lower, true);
    const back = [];
    for (let k = lower.length - 2; k >= 0; k -= 2) back.push(lower[k], lower[k + 1]);
    return outlinePath([...upper, ...back], true);
  };
  const side = 1.04 * Math.max(width, height) * clamp(largest / outline.width_mm, 1, 4);
  return svg("svg", {
    class: "outline", role: "img", "aria-label": label,
    viewBox: `${(width - side) / 2} ${(height - side * 0.86) / 2} ${side} ${side * 0.86}`,
  },
  svg("path", { class: "white-matter", d: area(outline.interface, outline.clamped) }),
  svg("path", { class: "grey-matter", d: area(outline.contour, outline.interface) }),
  svg("path", { class: "outline-line", d: outlinePath(outline.contour, isClosed) }));
}

const ENDED = { completed: "completed", failed: "failed", stopped: "stopped", interrupted: "interrupted" };

function createThumbnail(run, index, largest, onOpen) {
  const gi = run.values.gi_closing ?? run.values.gi_area_closing ?? null;
  const result = run.status === "completed" ? `GI ${fixed(gi, 3)}` : ENDED[run.status] || run.status;
  return element("button", {
    type: "button", class: `thumbnail ${run.status === "completed" ? "" : "is-early"}`, click: () => onOpen(index),
    "aria-label": `open ${run.title}, ${result}`,
  }, createOutline(run.outline, "", largest), element("span", { class: "thumbnail-title" }, run.title),
  element("strong", {}, result));
}
