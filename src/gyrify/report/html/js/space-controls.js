// Choices that only a body in space has: where it is cut open, and from where it is looked at.

const AXES = ["x", "y", "z"];
// From where the face of a cut across each axis is seen well: azimuth and height [degrees].
const FACING = [[-28, 18], [62, 18], [-60, 48]];

function createCutBar(viewer) {
  const { model, state, camera } = viewer;
  const { low, high } = model.bounds;
  const look = (direction) => {
    camera.look(direction);
    viewer.redraw();
  };
  const text = element("output", { class: "cut-place" });
  const slider = element("input", {
    type: "range", min: 0, max: 1000, step: 1, value: 500, "aria-label": "position of the cut", input: () => move(),
  });
  const move = () => {
    const { axis } = state;
    const place = axis === null ? 0 : low[axis] + (slider.value / 1000) * (high[axis] - low[axis]);
    const said = axis === null ? "" : `${AXES[axis]} = ${withUnit(fixed(place, 1), "mm")}`;
    slider.setAttribute("aria-valuetext", said);
    text.textContent = said;
    viewer.set({ place });
  };
  const choice = createChoice("Cut", [
    { value: "whole", text: "none", title: "The whole body" },
    ...AXES.map((name) => ({ value: name, text: name, title: `Cut it open by a plane across ${name}` })),
  ], "whole", (value) => {
    state.axis = value === "whole" ? null : AXES.indexOf(value);
    show(sliding, state.axis !== null);
    if (state.axis !== null) camera.look(FACING[state.axis]);
    move();
  });
  const sliding = element("div", { class: "cut-slider", hidden: true }, slider, text);
  const views = ["side", "above", "front"].map((name) => element("button", {
    type: "button", class: "plain", title: `Look at it from ${name === "above" ? name : `the ${name}`}`, click: () => look(VIEWS[name]),
  }, name));
  return element("div", { class: "cut-bar" }, choice.host, sliding,
    element("div", { class: "views", role: "group", "aria-label": "look at it from" }, element("span", { class: "faint" }, "From"), views));
}
