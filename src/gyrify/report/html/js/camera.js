// Where the scene is looked at from: a point of the plane [mm] and a scale [CSS pixels per mm].

function createCamera(bounds) {
  const camera = { x: 0, y: 0, scale: 1, width: 1, height: 1, isFitted: true, natural: Infinity, ceiling: () => Infinity };
  const [left, low, right, high] = bounds;

  addMoves(camera);
  camera.fit = () => {
    const [wide, tall] = [Math.max(right - left, 1e-9), Math.max(high - low, 1e-9)];
    // A wide slice keeps clear of the colour bar at the right.
    const bar = Math.min(BAR_WIDTH, 0.25 * camera.width);
    camera.natural = 0.92 * Math.min((camera.width - bar) / wide, camera.height / tall);
    camera.scale = Math.min(camera.natural, camera.ceiling());
    const overlap = (wide * camera.scale) / 2 + bar - camera.width / 2;
    camera.x = (left + right) / 2 + clamp(overlap, 0, bar / 2) / camera.scale;
    camera.y = (low + high) / 2;
    camera.least = 0.4 * camera.scale;
    camera.most = 200 * camera.scale;
    camera.isFitted = true;
  };
  camera.toScreen = (x, y) => [
    camera.width / 2 + (x - camera.x) * camera.scale,
    camera.height / 2 - (y - camera.y) * camera.scale,
  ];
  camera.drag = camera.pan;
  camera.copyFrom = (other) => {
    [camera.x, camera.y, camera.isFitted] = [other.x, other.y, false];
    camera.scale = other.scale;
  };
  return camera;
}
