// The scene of a body in space: its surface, lit, and the face where a plane cuts it open.

const LINE = 1.3; // pixels
const FIELD_LIGHT = 0.62; // of the light on a field comes from everywhere, so that its colours can be told

function createViewer(model, colours) {
  const viewer = createStage(model, createCamera(model.bounds), createPainter);
  const { painter, state } = viewer;
  Object.assign(state, { axis: null, place: 0 });
  viewer.canvas.classList.add("turns");
  const shape = createShape(viewer);
  viewer.corners = shape.surface;
  viewer.cutFace = shape.cutFace;
  if (painter) {
    const surface = createSurface(painter, viewer, shape);
    const face = createCutFace(painter, viewer, shape);
    viewer.draw = () => drawBody(painter, viewer, colours, surface, face);
  }
  viewer.bar = createCutBar(viewer);
  return viewer;
}

// Corners of the surface and the cut face, each computed when it has changed.
function createShape(viewer) {
  const { model, state } = viewer;
  const [surfaceOf, cellsOf, interfaceOf] = [
    model.cornersOf(model.faces, 3), model.cornersOf(model.cells, 4), model.cornersOf(model.interfaceFaces, 3)];
  const key = () => (state.mode === null ? `frame ${state.frame}` : `mode ${state.mode}`);
  const surface = remembered(() => surfaceOf(viewer.positions()));
  const cells = remembered(() => cellsOf(viewer.positions()));
  const interfaces = remembered(() => interfaceOf(viewer.positions()));
  const cutFace = remembered((shape, axis, place) => ({
    ...cutCells(cells(shape), model.perCell, axis, place),
    lines: [surface(shape), interfaces(shape)].map((corners) => cutTriangles(corners, axis, place)),
  }));
  return {
    key,
    surface: () => surface(key()),
    cutFace: () => (state.axis === null ? null : cutFace(key(), state.axis, state.place)),
    cutKey: () => `${key()} ${state.axis} ${state.place}`,
  };
}

// Calls a function when its key has changed since the last time.
function onChange(key, action) {
  let last = null;
  return () => {
    const now = key();
    if (now !== last) action();
    last = now;
  };
}

function createSurface(painter, viewer, shape) {
  const { model, state } = viewer;
  const n = model.faces.length;
  const buffer = painter.buffer();
  const edges = [];
  for (let k = 0; k < 3 * model.nOuter; k += 3) edges.push(k, k + 1, k + 1, k + 2, k + 2, k);
  buffer.setEdges(Uint32Array.from(edges));
  const place = onChange(shape.key, () => {
    const corners = shape.surface();
    buffer.set("position", corners);
    buffer.set("normal", smoothNormals(model.faces, corners, model.nPoints));
  });
  const shade = onChange(() => `${shape.key()} ${state.field}`, () => {
    buffer.set("value", surfaceValues(model, viewer.field(), state));
    buffer.set("gloom", sulci(model, viewer.field(), state));
  });
  return {
    prepare() {
      place();
      shade();
    },
    outer: () => buffer.triangles(0, 3 * model.nOuter),
    inner: () => buffer.triangles(3 * model.nOuter, n - 3 * model.nOuter),
    all: () => buffer.triangles(0, n),
    edges: () => buffer.lines(edges.length),
  };
}

// Of each corner the mean normal of the triangles around its point, by their areas.
function smoothNormals(faces, corners, nPoints) {
  const sums = new Float32Array(3 * nPoints);
  for (let k = 0; k < faces.length; k += 3) {
    const c = 3 * k;
    const [ux, uy, uz] = [corners[c + 3] - corners[c], corners[c + 4] - corners[c + 1], corners[c + 5] - corners[c + 2]];
    const [vx, vy, vz] = [corners[c + 6] - corners[c], corners[c + 7] - corners[c + 1], corners[c + 8] - corners[c + 2]];
    for (let i = 0; i < 3; i += 1) {
      const p = 3 * faces[k + i];
      sums[p] += uy * vz - uz * vy;
      sums[p + 1] += uz * vx - ux * vz;
      sums[p + 2] += ux * vy - uy * vx;
    }
  }
  const normals = new Float32Array(corners.length);
  for (let k = 0; k < faces.length; k += 1) {
    for (let axis = 0; axis < 3; axis += 1) normals[3 * k + axis] = sums[3 * faces[k] + axis];
  }
  return normals;
}

// Values at the corners of the surface: of the cell below, or of the point itself.
function surfaceValues(model, field, { frame, mode }) {
  if (field === REGION || mode !== null) return new Float32Array(model.faces.length);
  const values = model.values(frame, field.name);
  const found = new Float32Array(model.faces.length);
  for (let k = 0; k < found.length; k += 1) {
    const place = field.place === "cell" ? model.faceCells[Math.floor(k / 3)] : model.place[model.faces[k]];
    found[k] = drawable(place < 0 ? NaN : values[place]);
  }
  return found;
}

// How deep in sulci the corners lie, over the deepest sulcus of the run: where tissues are shown these are darker.
function sulci(model, field, { frame, mode }) {
  const depth = model.fields.get("depth");
  if (!depth || field !== REGION || mode !== null) return new Float32Array(model.faces.length);
  const deepest = Math.max(0.02 * model.bounds.radius, ...depth.extremes.map((ends) => ends[1]));
  const values = model.values(frame, "depth");
  const found = new Float32Array(model.faces.length);
  for (let k = 0; k < found.length; k += 1) found[k] = values[model.place[model.faces[k]]] / deepest || 0;
  return found;
}

function createCutFace(painter, viewer, shape) {
  const { model, state, camera } = viewer;
  const [fill, mesh, ink] = [painter.buffer(), painter.buffer(), painter.buffer()];
  let found = null;
  const place = onChange(shape.cutKey, () => {
    found = shape.cutFace();
    fill.set("position", found.points);
    mesh.set("position", found.edges);
  });
  const shade = onChange(() => `${shape.cutKey()} ${state.field}`, () => {
    const field = viewer.field();
    const isScalar = field !== REGION && field.place === "cell" && state.mode === null;
    const values = isScalar ? model.values(state.frame, field.name) : model.region;
    fill.set("value", Float32Array.from({ length: 3 * found.cells.length }, (_, k) => drawable(values[found.cells[Math.floor(k / 3)]])));
  });
  return {
    prepare() {
      place();
      shade();
    },
    fill: () => fill.triangles(0, found.points.length / 3),
    edges: () => mesh.lines(found.edges.length / 3),
    ink(half) {
      for (const segments of found.lines) {
        const corners = ribbons(segments, camera.axes, half);
        ink.set("position", corners);
        ink.triangles(0, corners.length / 3);
      }
    },
  };
}

function drawBody(painter, viewer, colours, surface, face) {
  const { state, camera, model } = viewer;
  const field = viewer.field();
  const isScalar = field !== REGION && state.mode === null;
  const tissue = mapBytes(colours.region, true);
  const fieldMap = isScalar ? mapBytes(colours[field.colours], false) : tissue;
  const scalar = { limits: viewer.limits(), ambient: FIELD_LIGHT };
  const bare = { colour: skin(colours.region), ambient: 0.36 };
  painter.cut(state.axis, state.place);
  surface.prepare();
  painter.map(fieldMap);
  painter.style(isScalar ? scalar : bare);
  if (isScalar && field.place === "contour") {
    surface.outer();
    painter.style(bare);
    surface.inner();
  } else surface.all();
  const lift = model.bounds.radius / 1000;
  if (state.mesh) {
    painter.style({ colour: themeColour("--edge"), lift });
    surface.edges();
  }
  if (state.axis === null) return;
  // The face lies in the plane of the cut: nothing of it is to be taken away.
  painter.cut(null, 0);
  face.prepare();
  const isCells = isScalar && field.place === "cell";
  painter.map(isCells ? fieldMap : tissue);
  painter.style(isCells ? { limits: viewer.limits() } : {});
  face.fill();
  if (state.mesh) {
    painter.style({ colour: themeColour("--edge"), lift });
    face.edges();
  }
  painter.style({ colour: themeColour("--ink"), lift: 2 * lift });
  face.ink(LINE / 2 / camera.scale);
}

// The colour of a surface that shows no field: between grey and white matter, as in folded.png.
function skin([white, grey]) {
  const [a, b] = [bytesOf(white), bytesOf(grey)];
  return a.map((byte, k) => Math.min(1, 0.12 + (0.98 * (byte + b[k])) / 510));
}
