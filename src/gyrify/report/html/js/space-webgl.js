// The smallest drawing layer that a body in space needs: triangles whose corners have a position, a normal, a value
// and a shade; the value becomes a colour of the current map, or all have one colour, and light falls on it.

const SPACE_VERTEX_SHADER = `#version 300 es
in vec3 position;
in vec3 normal;
in float value;
in float gloom;         // 0 on crowns, 1 at the bottom of the deepest sulcus
uniform vec3 right, up, near, centre;
uniform vec4 view;      // place of the middle of the screen [mm], then clip units per mm
uniform vec2 range;     // mm towards the reader of the middle of the scene, and clip units per mm
uniform float lift;     // mm towards the reader
uniform vec4 cut;       // the part of the body with dot(cut.xyz, position) above cut.w is taken away
centroid out vec3 turned; // at a place within the triangle, also where its edge is sampled
centroid out float shade;
centroid out float dark;
centroid out float height;
void main() {
  vec3 from = position - centre;
  turned = vec3(dot(right, normal), dot(up, normal), dot(near, normal));
  shade = value;
  dark = gloom;
  height = dot(cut.xyz, position) - cut.w;
  vec2 place = (vec2(dot(right, from), dot(up, from)) - view.xy) * view.zw;
  gl_Position = vec4(place, -(dot(near, from) + lift - range.x) * range.y, 1.0);
}`;

// Light over the left shoulder of the reader; what it does not reach is not black.
const SPACE_FRAGMENT_SHADER = `#version 300 es
precision highp float;
centroid in vec3 turned;
centroid in float shade;
centroid in float dark;
centroid in float height;
uniform sampler2D map;
uniform vec2 limits;
uniform vec4 plain;     // colour, and 1 where it is to be used
uniform vec3 undefinedColour;
uniform float ambient;  // share of the light that comes from everywhere; 1: light makes no difference
out vec4 colour;
const vec3 LIGHT = vec3(-0.4509, 0.5511, 0.7014);
void main() {
  if (height > 0.0) discard;
  float part = clamp((shade - limits.x) / (limits.y - limits.x), 0.0, 1.0);
  vec3 mapped = texture(map, vec2((part * 255.0 + 0.5) / 256.0, 0.5)).rgb;
  mapped = shade > 1e37 ? undefinedColour : mapped;
  vec3 body = plain.a > 0.5 ? plain.rgb : mapped;
  float size = length(turned);
  vec3 n = size > 0.0 ? turned / size : LIGHT;
  n = gl_FrontFacing ? n : -n;
  float light = ambient + (1.0 - ambient) * max(dot(n, LIGHT), 0.0);
  colour = vec4(body * mix(1.0, light, step(0.0, size - 1e-9)) * (1.0 - 0.55 * dark), 1.0);
}`;

const SPACE_UNIFORMS = [
  "right", "up", "near", "centre", "view", "range", "lift", "cut", "limits", "plain", "undefinedColour", "ambient",
];

function createPainter(canvas) {
  const options = { antialias: false, depth: true, stencil: false, powerPreference: "low-power" };
  const gl = canvas.getContext("webgl2", options);
  if (!gl) return null;
  const program = linked(gl, SPACE_VERTEX_SHADER, SPACE_FRAGMENT_SHADER);
  gl.useProgram(program);
  gl.enable(gl.DEPTH_TEST);
  gl.depthFunc(gl.LEQUAL);
  const uniforms = placesOf(gl, program, SPACE_UNIFORMS);
  const map = createMap(gl);
  gl.uniform3fv(uniforms.undefinedColour, bytesOf(UNDEFINED_COLOUR).map((byte) => byte / 255));
  const fine = createFineTarget(gl, true);
  return {
    gl,
    map,
    buffer: () => createBuffer(gl, program),
    begin(background, camera, isFine) {
      if (isFine) fine.bind();
      begin(gl, uniforms, background, camera);
    },
    end: (isFine) => isFine && fine.show(),
    cut: (axis, place) => gl.uniform4f(uniforms.cut, ...[0, 1, 2].map((k) => (k === axis ? 1 : 0)), axis === null ? 1 : place),
    style: ({ colour = null, limits = [0, 1], ambient = 1, lift = 0 }) => {
      gl.uniform4fv(uniforms.plain, colour ? [...colour, 1] : [0, 0, 0, 0]);
      gl.uniform2f(uniforms.limits, limits[0], limits[1]);
      gl.uniform1f(uniforms.ambient, ambient);
      gl.uniform1f(uniforms.lift, lift);
    },
  };
}

function begin(gl, uniforms, background, camera) {
  const { drawingBufferWidth: width, drawingBufferHeight: height } = gl;
  gl.viewport(0, 0, width, height);
  gl.clearColor(...background, 1);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  for (const [name, axis] of Object.entries(camera.axes)) gl.uniform3fv(uniforms[name], axis);
  gl.uniform3fv(uniforms.centre, camera.centre);
  const scale = camera.scale * (width / camera.width);
  gl.uniform4f(uniforms.view, camera.x, camera.y, (2 * scale) / width, (2 * scale) / height);
  gl.uniform2f(uniforms.range, 0, 1 / (2 * camera.radius));
}

// Corners of triangles, and optionally pairs of them that make lines. A part that was never set is zero.
function createBuffer(gl, program) {
  const array = gl.createVertexArray();
  const buffers = {};
  const parts = { position: 3, normal: 3, value: 1, gloom: 1 };
  let edges = null;
  return {
    set(name, data) {
      gl.bindVertexArray(array);
      const location = gl.getAttribLocation(program, name);
      if (!buffers[name]) buffers[name] = gl.createBuffer();
      gl.bindBuffer(gl.ARRAY_BUFFER, buffers[name]);
      gl.bufferData(gl.ARRAY_BUFFER, data, gl.DYNAMIC_DRAW);
      gl.vertexAttribPointer(location, parts[name], gl.FLOAT, false, 0, 0);
      gl.enableVertexAttribArray(location);
    },
    setEdges(indices) {
      gl.bindVertexArray(array);
      edges = gl.createBuffer();
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, edges);
      gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, indices, gl.STATIC_DRAW);
    },
    triangles(first, n) {
      gl.bindVertexArray(array);
      gl.drawArrays(gl.TRIANGLES, first, n);
    },
    lines(n) {
      gl.bindVertexArray(array);
      if (edges) gl.drawElements(gl.LINES, n, gl.UNSIGNED_INT, 0);
      else gl.drawArrays(gl.LINES, 0, n);
    },
  };
}
