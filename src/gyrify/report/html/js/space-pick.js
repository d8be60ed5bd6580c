// What lies under a point of the screen: the nearest triangle of the surface, as far as it is there, or of the face
// where the body is cut.

// The value of the shown field at a place of the canvas, or null: what it is, how exact, and of what.
function probe(viewer, px, py) {
  const { model, state } = viewer;
  const hit = hitOf(viewer, px, py);
  if (!hit) return null;
  const field = viewer.field();
  const isScalar = field !== REGION && state.mode === null;
  const [x, y, z] = hit.point;
  if (isScalar && field.place === "contour" && hit.face >= 0 && hit.face < model.nOuter) return pointValue(viewer, field, hit);
  const isTissue = !isScalar || field.place === "contour";
  const value = isTissue ? null : model.values(state.frame, field.name)[hit.cell];
  return { field: isTissue ? REGION : field, value, frame: state.frame, x, y, z, cell: hit.cell, region: model.region[hit.cell] };
}

// The corner of a triangle that is nearest to the place, with its value.
function pointValue({ model, state }, field, { face, corners, weights }) {
  const nearest = weights.indexOf(Math.max(...weights));
  const point = model.faces[3 * face + nearest];
  const [x, y, z] = corners.subarray(9 * face + 3 * nearest, 9 * face + 3 * nearest + 3);
  const value = model.values(state.frame, field.name)[model.place[point]];
  return { field, value, frame: state.frame, x, y, z, node: `surface node ${point}` };
}

function hitOf(viewer, px, py) {
  const { model, state, camera } = viewer;
  const at = camera.toPlane(px, py);
  const removed = (point) => state.axis !== null && point[state.axis] > state.place;
  const outside = viewer.corners();
  let best = nearestTriangle(outside, camera, at, (point) => !removed(point));
  if (best) best = { ...best, face: best.triangle, cell: model.faceCells[best.triangle], corners: outside };
  const cut = viewer.cutFace();
  const inside = cut && nearestTriangle(cut.points, camera, at, () => true);
  if (inside && (!best || inside.near > best.near)) return { ...inside, face: -1, cell: cut.cells[inside.triangle] };
  return best;
}

// Of the triangles below a point of the screen, the one nearest to the reader that is wanted there.
function nearestTriangle(corners, { axes, centre }, [x, y], isWanted) {
  let best = null;
  const { right, up, near } = axes;
  const offset = [right, up, near].map((axis) => dot(axis, centre));
  const place = new Float64Array(9);
  for (let t = 0; t < corners.length; t += 9) {
    for (let k = 0; k < 9; k += 3) {
      const [p, q, r] = [corners[t + k], corners[t + k + 1], corners[t + k + 2]];
      place[k] = right[0] * p + right[1] * q + right[2] * r - offset[0] - x;
      place[k + 1] = up[0] * p + up[1] * q + up[2] * r - offset[1] - y;
      place[k + 2] = near[0] * p + near[1] * q + near[2] * r - offset[2];
    }
    const c = place[0] * place[4] - place[1] * place[3];
    const a = place[3] * place[7] - place[4] * place[6];
    const b = place[6] * place[1] - place[7] * place[0];
    const total = a + b + c;
    const isInside = (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
    if (total === 0 || !isInside) continue;
    const weights = [a / total, b / total, c / total];
    const depth = weights[0] * place[2] + weights[1] * place[5] + weights[2] * place[8];
    if (best && depth <= best.near) continue;
    const point = [0, 1, 2].map((k) => weights[0] * corners[t + k] + weights[1] * corners[t + 3 + k] + weights[2] * corners[t + 6 + k]);
    if (isWanted(point)) best = { triangle: t / 9, near: depth, weights, point };
  }
  return best;
}
