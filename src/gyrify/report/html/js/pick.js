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
