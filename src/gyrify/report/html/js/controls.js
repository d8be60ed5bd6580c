// Choices of what the scene shows: field, range of its colours, mesh, critical mode.

const SHORT_LABELS = {
  region: "tissue",
  growth_stretch: "λ_g",
  J: "J",
  von_mises: "von Mises",
  mean_stress: "mean stress",
  circumferential_stress: "circumferential",
  thickness: "thickness",
  curvature: "curvature",
  contact_force: "contact force",
  depth: "depth",
};

// One choice out of several, as native radio buttons: tab to the group, arrows within it.
function createChoice(label, options, chosen, onChange) {
  const name = freshId("choice");
  const inputs = new Map();
  const chips = options.map(({ value, text, title }) => {
    const input = element("input", {
      type: "radio", name, value, checked: value === chosen, change: () => onChange(value),
    });
    inputs.set(value, input);
    return element("label", { class: "chip", title }, input, element("span", {}, subscripted(text)));
  });
  const host = element("fieldset", { class: "choice" }, element("legend", {}, label), chips);
  return { host, set: (value) => { inputs.get(value).checked = true; } };
}

// "λ_g" with a true subscript.
function subscripted(text) {
  const [stem, index] = text.split("_");
  return index ? [stem, element("sub", {}, index)] : [stem];
}

function createSwitch(label, title, isOn, onChange) {
  const input = element("input", { type: "checkbox", checked: isOn, change: () => onChange(input.checked) });
  return { host: element("label", { class: "switch", title }, input, element("span", {}, label)), input };
}

function createFieldChoice(fields, chosen, onChange) {
  const options = [{ value: "region", text: "tissue", title: "Grey and white matter" }];
  for (const field of fields) {
    options.push({
      value: field.name,
      text: SHORT_LABELS[field.name] || field.label,
      title: `${field.label}${field.unit ? ` [${field.unit}]` : ""}. ${field.about}`,
    });
  }
  return createChoice("Colour by", options, chosen, onChange);
}

function createZoomButtons(pointer, what) {
  const button = (text, label, action) =>
    element("button", { type: "button", class: "zoom", "aria-label": label, title: label, click: action }, text);
  return element("div", { class: "zoom-buttons" },
    button("+", "zoom in", () => pointer.zoom(1.4)),
    button("−", "zoom out", () => pointer.zoom(1 / 1.4)),
    button("⤢", `whole ${what}`, pointer.fit));
}

// The critical mode: the state that lost stability, displaced to and fro along its mode.
function createModeSwitch(viewer, onset, onChange) {
  let request = 0;
  const swing = (start) => (now) => {
    const part = Math.round(40 * Math.cos((now - start) / 450)) / 40;
    amplitude.value = part;
    viewer.set({ mode: part });
    request = requestAnimationFrame(swing(start));
  };
  const amplitude = element("input", {
    type: "range", min: -1, max: 1, step: 0.05, value: 1, "aria-label": "amplitude of the mode",
    input: () => {
      cancelAnimationFrame(request);
      viewer.set({ mode: Number(amplitude.value) });
    },
  });
  const number = onset.is_degree ? `degree ${onset.mode_number}, waves` : `${onset.mode_number} waves`;
  const waves = onset.mode_number ? `${number} of ${brief(onset.wavelength_mm, 3)} mm` : onset.kind;
  const about = `Critical mode: ${waves} at growth time ` +
    `${brief(onset.growth_time)}. ${viewer.what === "slice" ? "Orange: the state itself. " : ""}The amplitude is arbitrary.`;
  const bar = element("div", { class: "mode-bar", hidden: true }, element("span", {}, about),
    element("label", {}, "amplitude ", amplitude));
  const choice = createSwitch("critical mode", `The shape along which the ${viewer.what} lost stability`, false, (isOn) => {
    cancelAnimationFrame(request);
    show(bar, isOn);
    viewer.set({ mode: isOn ? 1 : null });
    if (isOn) amplitude.value = 1;
    const isStill = matchMedia("(prefers-reduced-motion: reduce)").matches;
    if (isOn && !isStill) request = requestAnimationFrame(swing(performance.now()));
    onChange(isOn);
  });
  const leave = () => {
    if (choice.input.checked) choice.input.click();
  };
  return { host: choice.host, bar, leave };
}
