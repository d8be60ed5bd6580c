// Pointer and keys on the scene: drag to pan, wheel or + and - to zoom, hover or tap to read a value.

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

// What a drag moves, and what a hover or a tap reads.
function connectReading(viewer, tooltip, change) {
  const { canvas, camera } = viewer;
  let [grip, start, last] = [null, null, null]; // where the drag is, where it began, and the place to read
  const forget = () => {
    last = null;
    tooltip.hide();
  };
  const read = () => {
    if (!last || grip) return;
    const found = probe(viewer, ...last);
    if (found) tooltip.show(found, ...last, camera);
    else tooltip.hide();
  };
  canvas.addEventListener("pointerdown", (event) => {
    grip = start = [event.clientX, event.clientY];
    canvas.setPointerCapture(event.pointerId);
    tooltip.hide();
  });
  canvas.addEventListener("pointermove", (event) => {
    last = [event.offsetX, event.offsetY];
    if (grip) {
      change(() => camera.pan(event.clientX - grip[0], event.clientY - grip[1]));
      grip = [event.clientX, event.clientY];
    } else read();
  });
  // What is touched and let go without a move is read, as what the mouse is over.
  canvas.addEventListener("pointerup", (event) => {
    const isTap = start && Math.hypot(event.clientX - start[0], event.clientY - start[1]) < TAP;
    grip = start = null;
    last = isTap ? [event.offsetX, event.offsetY] : null;
    read();
  });
  canvas.addEventListener("pointercancel", () => {
    grip = start = null;
    forget();
  });
  // A finger is gone once it has tapped; what it has read stays until it taps elsewhere.
  canvas.addEventListener("pointerleave", (event) => event.pointerType === "mouse" && forget());
  document.addEventListener("pointerdown", (event) => event.target !== canvas && forget());
  viewer.drawn.listen(read);
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
  };
}
