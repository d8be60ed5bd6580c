// The scene of a run in the plane: one frame, coloured by one field.

const BAND_WIDTH = 10; // pixels of the band that carries a field of the contour

function createViewer(model, colours) {
  const viewer = createStage(model, createCamera(model.bounds), createPainter);
  const { painter } = viewer;
  const fill = painter && createFill(painter, model);
  const ink = painter && createInk(painter);
  viewer.draw = () => drawScene(painter, viewer, colours, fill, ink);
  viewer.corners = () => fill.corners(viewer);
  return viewer;
}

// Corners of all triangles; what has not changed since the last drawing is not sent again.
function createFill(painter, model) {
  const n = model.triangles.length;
  const corners = new Float32Array(2 * n);
  const values = new Float32Array(n);
  const buffer = painter.buffer();
  const shown = { shape: "", values: "" };
  const edges = cellEdges(model);
  buffer.setEdges(edges);
  const place = (viewer) => {
    const { frame, mode } = viewer.state;
    const key = mode === null ? `frame ${frame}` : `mode ${mode}`;
    if (shown.shape === key) return;
    shown.shape = key;
    const x = viewer.positions();
    for (let k = 0; k < n; k += 1) {
      corners[2 * k] = x[2 * model.triangles[k]] + (model.shifts ? model.shifts[k] * model.period : 0);
      corners[2 * k + 1] = x[2 * model.triangles[k] + 1];
    }
    buffer.set("position", corners);
  };
  const shade = (viewer, name) => {
    const key = name === "region" ? name : `${name} ${viewer.state.frame}`;
    if (shown.values === key) return;
    shown.values = key;
    const cells = name === "region" ? model.region : model.values(viewer.state.frame, name);
    for (let k = 0; k < n; k += 1) values[k] = drawable(cells[Math.floor(k / (3 * model.perCell))]);
    buffer.set("value", values);
  };
  return {
    corners: (viewer) => (place(viewer), corners),
    draw(viewer, name) {
      place(viewer);
      shade(viewer, name);
      buffer.triangles(n);
    },
    drawEdges: () => buffer.edges(edges.length),
  };
}

// Edges of cells, as pairs of corners; those between the four parts of a quadratic cell are left out.
function cellEdges(model) {
  const sides = model.perCell === 4 ? [[0, 1, 2, 0], [0, 1, 1, 2], [1, 2, 2, 0], []] : [[0, 1, 1, 2, 2, 0]];
  const found = [];
  for (let t = 0; t < model.triangles.length / 3; t += 1) {
    for (const corner of sides[t % model.perCell]) found.push(3 * t + corner);
  }
  return new Uint32Array(found);
}

// One buffer for all lines, filled anew for each.
function createInk(painter) {
  const buffer = painter.buffer();
  return (corners, style) => {
    for (const part of ["position", "offset", "value"]) buffer.set(part, corners[part]);
    painter.style(style);
    buffer.triangles(corners.count);
  };
}

function drawScene(painter, viewer, colours, fill, ink) {
  const { model, state } = viewer;
  const field = viewer.field();
  const isBand = field.place === "contour" && state.mode === null;
  const isScalar = field !== REGION && !isBand && state.mode === null;
  painter.map(mapBytes(colours[isScalar || isBand ? field.colours : "region"], !isScalar && !isBand));
  painter.style(isBand ? { colour: themeColour("--tissue") } : { limits: isScalar ? viewer.limits() : [0, 1] });
  fill.draw(viewer, isScalar ? field.name : "region");
  if (state.mesh) {
    painter.style({ colour: themeColour("--edge") });
    fill.drawEdges();
  }
  drawLines(viewer, ink, isBand ? field : null);
}

function drawLines(viewer, ink, bandField) {
  const { model, state } = viewer;
  const isClosed = model.period === null;
  const line = (positions, name, style, width, extra = {}) => {
    const points = linePoints(positions, model.lines[name], model.period);
    ink(lineCorners(points, { isClosed, ...extra }), { width, ...style });
  };
  const x = viewer.positions();
  const dark = { colour: themeColour("--ink") };
  // The contour lies between tissue and page: light on a dark one.
  const outer = { colour: themeColour("--contour") };
  line(x, "interface", dark, 0.8);
  line(x, "clamped", dark, 0.8);
  if (bandField) {
    const values = [...model.values(state.frame, bandField.name)];
    if (!isClosed) values.push(values[0]);
    const sides = model.inward > 0 ? { from: 0, to: 1 } : { from: -1, to: 0 };
    line(x, "contour", { limits: viewer.limits() }, BAND_WIDTH, { values, ...sides });
  }
  if (state.mode !== null) line(model.modePositions(0), "contour", { colour: themeColour("--mark") }, 1.6);
  line(x, "contour", outer, bandField ? 1 : 1.6);
}
