// Lines of any width as triangles. A corner's offset is in units of the width, so that a line keeps its width
// in pixels at any zoom without being built again.

// Corners of a line through points of the mesh. `from` and `to` say how far it reaches to the left and to the
// right of its path: -0.5 to 0.5 is a line astride, 0 to 1 a band on its left.
function lineCorners(points, { from = -0.5, to = 0.5, values = null, isClosed = false }) {
  const n = points.length / 2;
  const normals = miters(points, isClosed);
  const nSegments = isClosed ? n : n - 1;
  const corners = {
    position: new Float32Array(12 * nSegments),
    offset: new Float32Array(12 * nSegments),
    value: new Float32Array(6 * nSegments),
    count: 6 * nSegments,
  };
  const order = [[0, from], [1, from], [1, to], [0, from], [1, to], [0, to]];
  let k = 0;
  for (let s = 0; s < nSegments; s += 1) {
    for (const [end, side] of order) {
      const p = (s + end) % n;
      corners.position[2 * k] = points[2 * p];
      corners.position[2 * k + 1] = points[2 * p + 1];
      corners.offset[2 * k] = side * normals[2 * p];
      corners.offset[2 * k + 1] = side * normals[2 * p + 1];
      corners.value[k] = values ? drawable(values[p]) : 0;
      k += 1;
    }
  }
  return corners;
}

// At each point, where the left edges of its two segments meet; sharp corners are cut.
function miters(points, isClosed) {
  const n = points.length / 2;
  const normals = new Float32Array(2 * n);
  const normal = (a, b) => {
    const [dx, dy] = [points[2 * b] - points[2 * a], points[2 * b + 1] - points[2 * a + 1]];
    const length = Math.hypot(dx, dy) || 1;
    return [-dy / length, dx / length];
  };
  for (let p = 0; p < n; p += 1) {
    const before = p > 0 || isClosed ? normal((p + n - 1) % n, p) : normal(p, p + 1);
    const after = p < n - 1 || isClosed ? normal(p, (p + 1) % n) : before;
    const bend = Math.max(1 + before[0] * after[0] + before[1] * after[1], 0.5);
    normals[2 * p] = (before[0] + after[0]) / bend;
    normals[2 * p + 1] = (before[1] + after[1]) / bend;
  }
  return normals;
}

// The points of a line of the mesh; that of a strip goes on to where its next period begins.
function linePoints(positions, line, period) {
  const n = line.length;
  const found = new Float32Array(2 * n + (period === null ? 0 : 2));
  for (let k = 0; k < n; k += 1) {
    found[2 * k] = positions[2 * line[k]];
    found[2 * k + 1] = positions[2 * line[k] + 1];
  }
  if (period !== null) {
    const direction = Math.sign(found[2] - found[0]) || 1;
    found[2 * n] = found[0] + direction * period;
    found[2 * n + 1] = found[1];
  }
  return found;
}
