// The scene, whatever it shows: which frame and field, the ends of its colours, and when it is drawn.

const REGION = { name: "region", label: "tissue", place: "cell", unit: "" };
const REST = 120; // milliseconds without a change after which the scene is drawn finely

// `draw` of the viewer is set by who makes it; a painter that is null draws nothing.
function createStage(model, camera, makePainter) {
  const canvas = element("canvas", { class: "scene-canvas", tabindex: 0, role: "img" });
  const painter = makePainter(canvas);
  const state = { frame: model.nFrames - 1, field: "region", scope: "run", limits: null, mesh: false, mode: null };
  const viewer = { canvas, camera, state, model, painter, isAble: painter !== null, gl: painter && painter.gl, drawn: signal() };
  viewer.what = model.run.frames.n_dim === 3 ? "body" : "slice";
  let isWaiting = false;
  let rest = 0;

  viewer.field = () => model.fields.get(state.field) || REGION;
  viewer.limits = () => {
    const field = viewer.field();
    if (field === REGION) return [0, 1];
    return state.limits || (state.scope === "run" ? field.range : field.ranges[state.frame]);
  };
  // Least and greatest value that the colours are to cover: of the run, or of the state on view.
  viewer.extremes = () => {
    const field = viewer.field();
    if (field === REGION) return [0, 1];
    if (state.scope !== "run") return field.extremes[state.frame];
    return [Math.min(...field.extremes.map((e) => e[0])), Math.max(...field.extremes.map((e) => e[1]))];
  };
  viewer.positions = () => (state.mode === null ? model.positions(state.frame) : modeShape(model, state.mode));
  viewer.set = (changes) => {
    Object.assign(state, changes);
    viewer.redraw();
  };
  viewer.redraw = () => {
    if (isWaiting) return;
    isWaiting = true;
    requestAnimationFrame(() => {
      isWaiting = false;
      viewer.drawNow();
    });
  };
  // While things move, quickly; a moment later, finely.
  viewer.drawNow = (isFine = false) => {
    clearTimeout(rest);
    if (!painter || camera.width < 2 || painter.gl.isContextLost()) return;
    painter.begin(themeColour("--scene"), camera, isFine);
    viewer.draw();
    painter.end(isFine);
    if (isFine) return;
    rest = setTimeout(() => viewer.drawNow(true), REST);
    viewer.drawn.emit();
  };
  viewer.release = () => painter && viewer.gl.getExtension("WEBGL_lose_context").loseContext();
  canvas.addEventListener("webglcontextrestored", () => location.reload());
  observeSize(canvas, camera, viewer);
  return viewer;
}

// The drawing buffer follows the size of the element and the density of the screen (up to 2).
function observeSize(canvas, camera, viewer) {
  new ResizeObserver(() => {
    const { clientWidth: width, clientHeight: height } = canvas;
    if (width < 2 || height < 2) return;
    const density = Math.min(devicePixelRatio || 1, 2);
    canvas.width = Math.round(width * density);
    canvas.height = Math.round(height * density);
    camera.resize(width, height);
    viewer.drawNow();
  }).observe(canvas);
}

// The critical state, displaced along its mode by an amplitude from -1 to 1.
function modeShape(model, amplitude) {
  const [base, displaced] = [model.modePositions(0), model.modePositions(1)];
  return base.map((x, k) => x + amplitude * (displaced[k] - x));
}
