// Where a body in space is looked at from: a direction (azimuth about z, and height above the horizon), a point of
// the screen's plane [mm] and a scale [CSS pixels per mm]. It is seen from far away, so that lengths are true.

const TURN = 0.4; // degrees per pixel of a drag
const KEY_TURN = 7.5; // degrees per press of a key
// Directions from which a body is looked at: azimuth and height [degrees].
const VIEWS = { start: [-60, 22], side: [-90, 0], above: [-90, 90], front: [0, 0] };

function createCamera({ centre, radius }) {
  const camera = { x: 0, y: 0, scale: 1, width: 1, height: 1, isFitted: true, radius, axes: null };

  addMoves(camera);
  camera.look = ([azimuth, height]) => {
    [camera.azimuth, camera.elevation] = [azimuth, clamp(height, -90, 90)];
    const [a, h] = [camera.azimuth, camera.elevation].map((angle) => (angle * Math.PI) / 180);
    camera.axes = {
      right: [-Math.sin(a), Math.cos(a), 0],
      up: [-Math.sin(h) * Math.cos(a), -Math.sin(h) * Math.sin(a), Math.cos(h)],
      near: [Math.cos(h) * Math.cos(a), Math.cos(h) * Math.sin(a), Math.sin(h)],
    };
  };
  camera.turn = (right, up) => camera.look([camera.azimuth - right, camera.elevation + up]);
  // Whole and in the middle; the direction stays.
  camera.fit = () => {
    const bar = Math.min(BAR_WIDTH, 0.25 * camera.width);
    camera.scale = (0.94 * Math.min(camera.width - bar, camera.height)) / (2 * radius);
    const overlap = radius * camera.scale + bar - camera.width / 2;
    [camera.x, camera.y] = [clamp(overlap, 0, bar / 2) / camera.scale, 0];
    [camera.least, camera.most] = [0.4 * camera.scale, 100 * camera.scale];
    camera.isFitted = true;
  };
  // Millimetres to the right, up and towards the reader from the middle of the body.
  camera.toView = (point) => {
    const from = point.map((value, k) => value - centre[k]);
    return [camera.axes.right, camera.axes.up, camera.axes.near].map((axis) => dot(axis, from));
  };
  camera.toScreen = (...point) => {
    const [x, y] = camera.toView(point);
    return [camera.width / 2 + (x - camera.x) * camera.scale, camera.height / 2 - (y - camera.y) * camera.scale];
  };
  camera.drag = (dx, dy, isShifted) => (isShifted ? camera.pan(dx, dy) : camera.turn(TURN * dx, TURN * dy));
  camera.centre = centre;
  camera.keys = {
    ArrowLeft: () => camera.turn(-KEY_TURN, 0),
    ArrowRight: () => camera.turn(KEY_TURN, 0),
    ArrowUp: () => camera.turn(0, -KEY_TURN),
    ArrowDown: () => camera.turn(0, KEY_TURN),
  };
  camera.look(VIEWS.start);
  return camera;
}

function dot(a, b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
