// What lies under a point of the plane: a triangle, or the nearest point of the contour.

// Triangles of one frame, sorted into square boxes of about two triangles each.
function createPicker(corners) {
  const n = corners.length / 6;
  const [left, low, right, high] = boxOf(corners);
  const size = Math.sqrt(((right - left) * (high - low) * 2) / n) || 1;
  const columns = Math.floor((right - left) / size) + 1;
  const boxes = new Map();
  for (let t = 0; t < n; t += 1) {
    const [a, b, c, d] = boxOf(corners.subarray(6 * t, 6 * t + 6));
    for (let j = Math.floor((b - low) / size); j <= Math.floor((d - low) / size); j += 1) {
      for (let i = Math.floor((a - left) / size); i <= Math.floor((c - left) / size); i += 1) {
        const key = j * columns + i;
        if (!boxes.has(key)) boxes.set(key, []);
        boxes.get(key).push(t);
      }
    }
  }
  return (x, y) => {
    if (x < left || x > right || y < low || y > high) return -1;
    const key = Math.floor((y - low) / size) * columns + Math.floor((x - left) / size);
    const found = (boxes.get(key) || []).find((t) => contains(corners, t, x, y));
    return found === undefined ? -1 : found;
  };
}

function boxOf(points) {
  const box = [Infinity, Infinity, -Infinity, -Infinity];
  for (let k = 0; k < points.length; k += 1) {
    box[k & 1] = Math.min(box[k & 1], points[k]);
    box[2 + (k & 1)] = Math.max(box[2 + (k & 1)], points[k]);
  }
  return box;
}

function contains(corners, triangle, x, y) {
  let isInside = true;
  for (let k = 0; k < 3; k += 1) {
    const [a, b] = [6 * triangle + 2 * k, 6 * triangle + 2 * ((k + 1) % 3)];
    const cross = (corners[b] - corners[a]) * (y - corners[a + 1]) - (corners[b + 1] - corners[a + 1]) * (x - corners[a]);
    isInside = isInside && cross >= 0;
  }
  return isInside;
}

// Place in the line of its point nearest to (x, y), or -1 if none is within `reach` [mm].
function nearestPoint(points, x, y, reach) {
  let [best, least] = [-1, reach * reach];
  for (let k = 0; k < points.length / 2; k += 1) {
    const distance = (points[2 * k] - x) ** 2 + (points[2 * k + 1] - y) ** 2;
    if (distance <= least) [best, least] = [k, distance];
  }
  return best;
}

// The value of the shown field at a place of the canvas, or null: what it is, how exact, and of what.
function probe(viewer, px, py) {
  const { model, state, camera } = viewer;
  const field = viewer.field();
  const [x, y] = camera.toPlane(px, py);
  if (field.place === "contour" && state.mode === null) {
    const points = linePoints(viewer.positions(), model.lines.contour, model.period);
    const place = nearestPoint(points, x, y, 14 / camera.scale);
    if (place < 0) return null;
    const k = place % model.lines.contour.length;
    const value = model.values(state.frame, field.name)[k];
    return { field, value, frame: state.frame, x: points[2 * place], y: points[2 * place + 1], node: `contour node ${model.lines.contour[k]}` };
  }
  const triangle = triangleAt(viewer, x, y);
  if (triangle < 0) return null;
  const cell = Math.floor(triangle / model.perCell);
  const isTissue = field === REGION || state.mode !== null;
  const value = isTissue ? null : model.values(state.frame, field.name)[cell];
  return { field: isTissue ? REGION : field, value, frame: state.frame, x, y, cell, region: model.region[cell] };
}

// The sorted triangles are kept for as long as the shape is the same.
function triangleAt(viewer, x, y) {
  const key = `${viewer.state.frame} ${viewer.state.mode}`;
  if (viewer.pickerKey !== key) {
    viewer.pickerKey = key;
    viewer.picker = createPicker(viewer.corners().slice());
  }
  return viewer.picker(x, y);
}
