// Positions and values of a frame, in mm and in the field's unit.

// Keeps the last answer: a scene asks for the same frame several times.
function remembered(compute) {
  let lastKey;
  let last;
  return (...key) => {
    const text = key.join();
    if (text !== lastKey) [lastKey, last] = [text, compute(...key)];
    return last;
  };
}

// Coordinates one after the other, as many for each point as `low` has numbers.
function positionsOf({ low, step }, { values, columns }, row) {
  const n = low.length;
  const found = new Float32Array(columns);
  for (let k = 0; k < columns; k += 1) found[k] = low[k % n] + (values[row * columns + k] - 1) * step;
  return found;
}

// One number per cell, or per point of the contour or the outer surface; NaN where it is undefined.
function valuesOf(field, { values, columns }, row) {
  const found = new Float64Array(columns);
  for (let k = 0; k < columns; k += 1) {
    const code = values[row * columns + k];
    found[k] = code === 0 ? NaN : field.low[row] + (code - 1) * field.step[row];
  }
  return found;
}
