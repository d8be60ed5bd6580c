// Where a plane across an axis cuts the body: the cut face, in triangles that each lie in one tetrahedron, and the
// lines in which it meets surfaces.

// `corners` are those of all tetrahedra, of which so many make a cell.
function cutCells(corners, perCell, axis, place) {
  const [points, cells, edges] = [[], [], []];
  const height = new Float64Array(4);
  for (let part = 0; part < corners.length / 12; part += 1) {
    let above = 0;
    for (let k = 0; k < 4; k += 1) {
      height[k] = corners[12 * part + 3 * k + axis] - place;
      if (height[k] >= 0) above += 1;
    }
    if (above === 0 || above === 4) continue;
    const polygon = crossings(corners, 12 * part, height);
    for (let k = 0; k < polygon.length; k += 1) edges.push(...polygon[k], ...polygon[(k + 1) % polygon.length]);
    for (let k = 2; k < polygon.length; k += 1) {
      points.push(...polygon[0], ...polygon[k - 1], ...polygon[k]);
      cells.push(Math.floor(part / perCell));
    }
  }
  return { points: new Float32Array(points), cells: Uint32Array.from(cells), edges: new Float32Array(edges) };
}

// Corners of the polygon in which a tetrahedron is cut, in order round it.
function crossings(corners, start, height) {
  const [high, low] = [[], []];
  for (let k = 0; k < 4; k += 1) (height[k] >= 0 ? high : low).push(k);
  const pairs = high.flatMap((i) => low.map((j) => [i, j]));
  // Around it, neighbours have a corner of the tetrahedron in common.
  if (pairs.length === 4) [pairs[2], pairs[3]] = [pairs[3], pairs[2]];
  return pairs.map(([i, j]) => between(corners, start + 3 * i, start + 3 * j, height[i] / (height[i] - height[j])));
}

function between(corners, a, b, part) {
  return [0, 1, 2].map((k) => corners[a + k] + part * (corners[b + k] - corners[a + k]));
}

// Pairs of points, end to end, in which the plane meets triangles.
function cutTriangles(corners, axis, place) {
  const found = [];
  for (let t = 0; t < corners.length; t += 9) {
    for (let k = 0; k < 3; k += 1) {
      const [a, b] = [t + 3 * k, t + 3 * ((k + 1) % 3)];
      const [p, q] = [corners[a + axis] - place, corners[b + axis] - place];
      if (p >= 0 !== q >= 0) found.push(...between(corners, a, b, p / (p - q)));
    }
  }
  return new Float32Array(found);
}

// Lines of a width on the screen as triangles that face the reader: `half` is half of it in mm.
function ribbons(segments, { right, up }, half) {
  const corners = new Float32Array(3 * segments.length);
  const order = [[0, 1], [3, 1], [3, -1], [0, 1], [3, -1], [0, -1]];
  for (let s = 0; s < segments.length; s += 6) {
    const along = [0, 1, 2].map((k) => segments[s + 3 + k] - segments[s + k]);
    const [x, y] = [dot(along, right), dot(along, up)];
    const size = Math.hypot(x, y) || 1;
    order.forEach(([end, side], corner) => {
      for (let k = 0; k < 3; k += 1) {
        const aside = (side * half * (x * up[k] - y * right[k])) / size;
        corners[3 * (s + corner) + k] = segments[s + end + k] + aside;
      }
    });
  }
  return corners;
}
