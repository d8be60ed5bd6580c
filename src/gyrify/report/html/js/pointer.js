// Pointer and keys on the scene: drag to pan, wheel or + and - to zoom, hover to read a value.

function connectPointer(viewer, tooltip) {
  const { canvas, camera } = viewer;
  const moved = signal();
  let grip = null;
  let last = null;
  const read = () => {
    if (!last || grip) return;
    const found = probe(viewer, ...last);
    if (found) tooltip.show(found, ...last, camera.width);
    else tooltip.hide();
  };
  const change = (action) => {
    action();
    viewer.redraw();
    moved.emit();
  };
  canvas.addEventListener("pointerdown", (event) => {
    grip = [event.clientX, event.clientY];
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
  for (const kind of ["pointerup", "pointercancel"]) canvas.addEventListener(kind, () => { grip = null; });
  canvas.addEventListener("pointerleave", () => {
    last = null;
    tooltip.hide();
  });
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
  viewer.drawn.listen(read);
  return { moved, zoom: (factor) => change(() => camera.zoom(factor)), fit: () => change(camera.fit) };
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
