// Pointer and keys on the scene: drag, pinch, wheel or + and - to zoom, hover or tap to read a value. What a drag
// does, to pan or to turn, is the camera's.

const TAP = 8; // pixels that a finger may move and still tap

function connectPointer(viewer, tooltip) {
  const { canvas, camera } = viewer;
  const moved = signal();
  const change = (action) => {
    action();
    viewer.redraw();
    moved.emit();
  };
  connectReading(viewer, tooltip, change);
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    change(() => camera.zoom(Math.exp(-clamp(event.deltaY, -120, 120) / 400), event.offsetX, event.offsetY));
  }, { passive: false });
  canvas.addEventListener("dblclick", () => change(camera.fit));
  canvas.addEventListener("keydown", (event) => {
    const action = sceneKeys(camera)[event.key];
    if (!action || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    change(action);
  });
  return { moved, zoom: (factor) => change(() => camera.zoom(factor)), fit: () => change(camera.fit) };
}

// What a drag moves, what two fingers zoom, and what a hover or a tap reads.
function connectReading(viewer, tooltip, change) {
  const { canvas, camera } = viewer;
  const grips = new Map(); // where each pointer that is down is now
  let [start, last] = [null, null]; // where the drag began, and the place to read
  const forget = () => {
    last = null;
    tooltip.hide();
  };
  const read = () => {
    if (!last || grips.size) return;
    const found = probe(viewer, ...last);
    if (found) tooltip.show(found, ...last, camera);
    else tooltip.hide();
  };
  canvas.addEventListener("pointerdown", (event) => {
    grips.set(event.pointerId, [event.offsetX, event.offsetY]);
    start = grips.size === 1 ? [event.offsetX, event.offsetY] : null;
    canvas.setPointerCapture(event.pointerId);
    tooltip.hide();
  });
  canvas.addEventListener("pointermove", (event) => {
    const now = [event.offsetX, event.offsetY];
    const before = grips.get(event.pointerId);
    last = now;
    if (!before) {
      read();
      return;
    }
    grips.set(event.pointerId, now);
    if (grips.size === 1) change(() => camera.drag(now[0] - before[0], now[1] - before[1], event.shiftKey));
    else change(() => pinch(camera, [...grips].find(([id]) => id !== event.pointerId)[1], before, now));
  });
  // What is touched and let go without a move is read, as what the mouse is over.
  canvas.addEventListener("pointerup", (event) => {
    const isTap = start && Math.hypot(event.offsetX - start[0], event.offsetY - start[1]) < TAP;
    grips.delete(event.pointerId);
    start = null;
    last = isTap ? [event.offsetX, event.offsetY] : null;
    read();
  });
  canvas.addEventListener("pointercancel", (event) => {
    grips.delete(event.pointerId);
    start = null;
    forget();
  });
  // A finger is gone once it has tapped; what it has read stays until it taps elsewhere.
  canvas.addEventListener("pointerleave", (event) => event.pointerType === "mouse" && forget());
  document.addEventListener("pointerdown", (event) => event.target !== canvas && forget());
  viewer.drawn.listen(read);
}

// One of two fingers moves: the point between them goes along, and the scene grows with their distance.
function pinch(camera, other, before, now) {
  const apart = (place) => Math.max(Math.hypot(place[0] - other[0], place[1] - other[1]), 1);
  camera.pan((now[0] - before[0]) / 2, (now[1] - before[1]) / 2);
  camera.zoom(apart(now) / apart(before), (now[0] + other[0]) / 2, (now[1] + other[1]) / 2);
}

function sceneKeys(camera) {
  const step = 40;
  return {
    "+": () => camera.zoom(1.25),
    "=": () => camera.zoom(1.25),
    "-": () => camera.zoom(0.8),
    0: camera.fit,
    w: () => camera.pan(0, step),
    s: () => camera.pan(0, -step),
    a: () => camera.pan(step, 0),
    d: () => camera.pan(-step, 0),
    ...camera.keys,
  };
}
