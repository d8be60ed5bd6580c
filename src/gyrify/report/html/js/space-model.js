// A run of a body in space as the scene needs it: positions and values of any frame, in mm and in the field's unit.

async function loadModel(run, payloadId) {
  const { frames } = run;
  const array = await openPayload(payloadId, frames.arrays);
  const values = (name) => array(name).values;
  const model = {
    run,
    nFrames: frames.indices.length,
    nPoints: frames.n_points,
    nCells: frames.n_cells,
    times: frames.times,
    nOuter: frames.n_outer, // triangles of the outer surface, the first of `faces`
    periods: frames.periods,
    cells: values("cells"),
    perCell: frames.parts_per_cell,
    faces: values("faces"),
    faceCells: values("face_cells"),
    interfaceFaces: values("interface_faces"),
    region: values("region"),
    contour: values("contour"),
    fields: new Map(frames.fields.map((field) => [field.name, field])),
    hasMode: frames.has_mode,
  };
  model.place = new Int32Array(model.nPoints).fill(-1); // of a point in the list of those of the outer surface
  model.contour.forEach((point, k) => { model.place[point] = k; });
  model.positions = remembered((frame) => positionsOf(frames.position, array("positions"), frame));
  model.modePositions = (row) => positionsOf(frames.position, array("mode"), row);
  model.values = remembered((frame, name) => valuesOf(model.fields.get(name), array(name), frame));
  const start = model.positions(0);
  model.cornersOf = (simplices, n) => cornersOf(model, start, simplices, n);
  model.bounds = boundsOf(frames.position, array("positions"));
  return model;
}

// A function that gives the corners of triangles (n = 3) or tetrahedra (4) at any positions, those of one next to
// each other: in a periodic body a corner may be an image of its point.
function cornersOf(model, start, simplices, n) {
  const shifts = [0, 1].map((axis) => {
    const period = model.periods && model.periods[axis];
    if (!period) return null;
    return Float32Array.from(simplices, (point, k) =>
      -period * Math.round((start[3 * point + axis] - start[3 * simplices[k - (k % n)] + axis]) / period));
  });
  return (x) => {
    const corners = new Float32Array(3 * simplices.length);
    for (let k = 0; k < simplices.length; k += 1) {
      for (let axis = 0; axis < 3; axis += 1) corners[3 * k + axis] = x[3 * simplices[k] + axis];
      for (const axis of [0, 1]) if (shifts[axis]) corners[3 * k + axis] += shifts[axis][k];
    }
    return corners;
  };
}

// The box around all frames, its middle, and the radius of a ball about it that holds every point: the camera stands
// still while the body grows, and nothing leaves the picture when it turns.
function boundsOf({ low, step }, { values, rows, columns }) {
  const ends = [65535, 65535, 65535, 0, 0, 0];
  for (let k = 0; k < rows * columns; k += 1) {
    const axis = (k % columns) % 3;
    if (values[k] < ends[axis]) ends[axis] = values[k];
    if (values[k] > ends[3 + axis]) ends[3 + axis] = values[k];
  }
  const [least, most] = [0, 3].map((side) => low.map((value, axis) => value + (ends[side + axis] - 1) * step));
  const centre = least.map((value, axis) => (value + most[axis]) / 2);
  let square = 0;
  for (let k = 0; k < rows * columns; k += 3) {
    const away = centre.map((value, axis) => low[axis] + (values[k + axis] - 1) * step - value);
    square = Math.max(square, dot(away, away));
  }
  return { low: least, high: most, centre, radius: Math.sqrt(square) || 1 };
}
