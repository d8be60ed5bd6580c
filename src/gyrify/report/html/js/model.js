// A run as the scene needs it: positions and values of any frame, in mm and in the field's unit.

async function loadModel(run, payloadId) {
  const { frames } = run;
  const array = await openPayload(payloadId, frames.arrays);
  const lines = {};
  for (const name of ["contour", "interface", "clamped"]) lines[name] = array(name).values;
  const model = {
    run,
    nFrames: frames.indices.length,
    nPoints: frames.n_points,
    nCells: frames.n_cells,
    times: frames.times,
    triangles: array("triangles").values,
    perCell: frames.triangles_per_cell,
    period: frames.period,
    inward: frames.inward,
    region: array("region").values,
    lines,
    fields: new Map(frames.fields.map((field) => [field.name, field])),
    hasMode: frames.has_mode,
  };
  model.shifts = model.period === null ? null : periodShifts(model, array);
  model.positions = remembered((frame) => positionsOf(frames.position, array("positions"), frame));
  model.modePositions = (row) => positionsOf(frames.position, array("mode"), row);
  model.values = remembered((frame, name) => valuesOf(model.fields.get(name), array(name), frame));
  model.bounds = boundsOf(model, array("positions"));
  return model;
}

// How many periods each corner of a triangle lies to the right of the point that it is: triangles that run
// over the end of a strip are drawn whole.
function periodShifts(model, array) {
  const x = positionsOf(model.run.frames.position, array("positions"), 0);
  const shifts = new Int8Array(model.triangles.length);
  for (let k = 0; k < shifts.length; k += 1) {
    const first = model.triangles[k - (k % 3)];
    shifts[k] = -Math.round((x[2 * model.triangles[k]] - x[2 * first]) / model.period);
  }
  return shifts;
}

// Smallest box around all frames, so that the camera stands still while the slice grows.
function boundsOf(model, { values, rows, columns }) {
  const { low, step } = model.run.frames.position;
  const ends = [65535, 65535, 0, 0];
  for (let row = 0; row < rows; row += 1) {
    for (const point of model.lines.contour) {
      for (let axis = 0; axis < 2; axis += 1) {
        const code = values[row * columns + 2 * point + axis];
        ends[axis] = Math.min(ends[axis], code);
        ends[2 + axis] = Math.max(ends[2 + axis], code);
      }
    }
  }
  for (const point of model.lines.clamped) {
    for (let axis = 0; axis < 2; axis += 1) ends[axis] = Math.min(ends[axis], values[2 * point + axis]);
  }
  return ends.map((code, k) => low[k % 2] + (code - 1) * step);
}
