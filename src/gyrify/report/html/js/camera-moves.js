// What cameras in the plane and in space have in common: the part of the screen's plane [mm] that is shown.

const BAR_WIDTH = 130; // pixels that the colour bar takes at the right

function addMoves(camera) {
  camera.resize = (width, height) => {
    [camera.width, camera.height] = [width, height];
    if (camera.isFitted) camera.fit();
  };
  camera.toPlane = (px, py) => [
    camera.x + (px - camera.width / 2) / camera.scale,
    camera.y - (py - camera.height / 2) / camera.scale,
  ];
  camera.pan = (dx, dy) => {
    camera.x -= dx / camera.scale;
    camera.y += dy / camera.scale;
    camera.isFitted = false;
  };
  // Keeps the point under the pointer where it is.
  camera.zoom = (factor, px = camera.width / 2, py = camera.height / 2) => {
    const [x, y] = camera.toPlane(px, py);
    const scale = clamp(camera.scale * factor, camera.least, camera.most);
    camera.x = x + (camera.x - x) * (camera.scale / scale);
    camera.y = y + (camera.y - y) * (camera.scale / scale);
    camera.scale = scale;
    camera.isFitted = false;
  };
}
