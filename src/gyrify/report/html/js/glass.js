// What drawing by WebGL in the plane and in space has in common.

// Stands for a value that is not defined.
const UNDEFINED_VALUE = 3e38;

function drawable(value) {
  return Number.isNaN(value) ? UNDEFINED_VALUE : value;
}

function linked(gl, vertexShader, fragmentShader) {
  const program = gl.createProgram();
  for (const [kind, source] of [[gl.VERTEX_SHADER, vertexShader], [gl.FRAGMENT_SHADER, fragmentShader]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  return program;
}

function placesOf(gl, program, names) {
  return Object.fromEntries(names.map((name) => [name, gl.getUniformLocation(program, name)]));
}

// The current map of colours, a texture of 256 by 1.
function createMap(gl) {
  gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
  for (const end of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) {
    gl.texParameteri(gl.TEXTURE_2D, end, gl.NEAREST);
  }
  return (bytes) => gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, 256, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
}

// A picture with smooth edges, four samples to a pixel. Without a graphics card it takes more than twice the time of
// a plain one, so that it is drawn when the scene has come to rest.
function createFineTarget(gl, hasDepth = false) {
  const frame = gl.createFramebuffer();
  const samples = gl.createRenderbuffer();
  const depth = hasDepth ? gl.createRenderbuffer() : null;
  const size = [0, 0];
  return {
    bind() {
      const [width, height] = [gl.drawingBufferWidth, gl.drawingBufferHeight];
      gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
      if (size[0] === width && size[1] === height) return;
      [size[0], size[1]] = [width, height];
      const attach = (buffer, format, place) => {
        gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
        gl.renderbufferStorageMultisample(gl.RENDERBUFFER, 4, format, width, height);
        gl.framebufferRenderbuffer(gl.FRAMEBUFFER, place, gl.RENDERBUFFER, buffer);
      };
      attach(samples, gl.RGBA8, gl.COLOR_ATTACHMENT0);
      if (depth) attach(depth, gl.DEPTH_COMPONENT24, gl.DEPTH_ATTACHMENT);
    },
    show() {
      gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, null);
      gl.blitFramebuffer(0, 0, ...size, 0, 0, ...size, gl.COLOR_BUFFER_BIT, gl.NEAREST);
      gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    },
  };
}
