// The smallest drawing layer that the scene needs: triangles whose corners have a position, an offset in
// pixels and a value; the value becomes a colour of the current map, or all have one colour.

const VERTEX_SHADER = `#version 300 es
in vec2 position;
in vec2 offset;
in float value;
uniform vec4 view;      // centre [mm], then clip units per mm
uniform vec2 pixel;     // clip units per pixel
uniform float width;    // pixels per unit of offset
out float shade;
void main() {
  shade = value;
  gl_Position = vec4((position - view.xy) * view.zw + offset * width * pixel, 0.0, 1.0);
}`;

// Values are constant over a cell or run along a line; what is undefined is marked by a huge value.
const FRAGMENT_SHADER = `#version 300 es
precision highp float;
in float shade;
uniform sampler2D map;
uniform vec2 limits;
uniform vec4 plain;     // colour, and 1 where it is to be used
uniform vec3 undefinedColour;
out vec4 colour;
void main() {
  float part = clamp((shade - limits.x) / (limits.y - limits.x), 0.0, 1.0);
  vec3 mapped = texture(map, vec2((part * 255.0 + 0.5) / 256.0, 0.5)).rgb;
  mapped = shade > 1e37 ? undefinedColour : mapped;
  colour = vec4(plain.a > 0.5 ? plain.rgb : mapped, 1.0);
}`;

function createPainter(canvas) {
  const options = { antialias: false, depth: false, stencil: false, powerPreference: "low-power" };
  const gl = canvas.getContext("webgl2", options);
  if (!gl) return null;
  const program = linked(gl, VERTEX_SHADER, FRAGMENT_SHADER);
  gl.useProgram(program);
  const uniforms = placesOf(gl, program, ["view", "pixel", "width", "limits", "plain", "undefinedColour"]);
  const map = createMap(gl);
  gl.uniform3fv(uniforms.undefinedColour, bytesOf(UNDEFINED_COLOUR).map((byte) => byte / 255));
  const fine = createFineTarget(gl);
  return {
    gl,
    buffer: () => createBuffer(gl, program),
    map,
    begin(background, camera, isFine) {
      if (isFine) fine.bind();
      begin(gl, uniforms, background, camera);
    },
    end: (isFine) => isFine && fine.show(),
    style: ({ colour = null, limits = [0, 1], width = 0 }) => {
      gl.uniform4fv(uniforms.plain, colour ? [...colour, 1] : [0, 0, 0, 0]);
      gl.uniform2f(uniforms.limits, limits[0], limits[1]);
      gl.uniform1f(uniforms.width, width);
    },
  };
}

function begin(gl, uniforms, background, camera) {
  const { drawingBufferWidth: width, drawingBufferHeight: height } = gl;
  gl.viewport(0, 0, width, height);
  gl.clearColor(...background, 1);
  gl.clear(gl.COLOR_BUFFER_BIT);
  const scale = camera.scale * (width / camera.width);
  gl.uniform4f(uniforms.view, camera.x, camera.y, (2 * scale) / width, (2 * scale) / height);
  gl.uniform2f(uniforms.pixel, 2 / camera.width, 2 / camera.height);
}

// Corners of triangles, and optionally pairs of them that make lines.
function createBuffer(gl, program) {
  const array = gl.createVertexArray();
  gl.bindVertexArray(array);
  const parts = { position: 2, offset: 2, value: 1 };
  const buffers = {};
  for (const [name, size] of Object.entries(parts)) {
    const location = gl.getAttribLocation(program, name);
    buffers[name] = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, buffers[name]);
    gl.vertexAttribPointer(location, size, gl.FLOAT, false, 0, 0);
  }
  const enabled = (name) => gl.enableVertexAttribArray(gl.getAttribLocation(program, name));
  let edges = null;
  return {
    set(name, data) {
      gl.bindVertexArray(array);
      enabled(name);
      gl.bindBuffer(gl.ARRAY_BUFFER, buffers[name]);
      gl.bufferData(gl.ARRAY_BUFFER, data, gl.DYNAMIC_DRAW);
    },
    setEdges(indices) {
      gl.bindVertexArray(array);
      edges = gl.createBuffer();
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, edges);
      gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, indices, gl.STATIC_DRAW);
    },
    triangles(n) {
      gl.bindVertexArray(array);
      gl.drawArrays(gl.TRIANGLES, 0, n);
    },
    edges(n) {
      gl.bindVertexArray(array);
      gl.drawElements(gl.LINES, n, gl.UNSIGNED_INT, 0);
    },
  };
}
