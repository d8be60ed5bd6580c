// Colour maps as arrays of bytes and as CSS.

const UNDEFINED_COLOUR = "#9a8fb0";

function bytesOf(hex) {
  return [1, 3, 5].map((k) => parseInt(hex.slice(k, k + 2), 16));
}

// 256 colours between the samples of a map; tissues are not blended.
function mapBytes(samples, isStepped) {
  const colours = samples.map(bytesOf);
  const bytes = new Uint8Array(256 * 4);
  for (let k = 0; k < 256; k += 1) {
    const place = (k / 255) * (colours.length - 1);
    const below = isStepped ? Math.round(place) : Math.min(Math.floor(place), colours.length - 2);
    const part = isStepped ? 0 : place - below;
    const above = colours[Math.min(below + 1, colours.length - 1)];
    for (let c = 0; c < 3; c += 1) {
      bytes[4 * k + c] = Math.round(colours[below][c] * (1 - part) + above[c] * part);
    }
    bytes[4 * k + 3] = 255;
  }
  return bytes;
}

function cssGradient(samples, direction) {
  return `linear-gradient(${direction}, ${samples.join(", ")})`;
}

// Colour of a value between two ends, for pictures that are not drawn by WebGL.
function colourAt(samples, value, [low, high]) {
  if (value === null || Number.isNaN(value)) return UNDEFINED_COLOUR;
  const part = high > low ? clamp((value - low) / (high - low), 0, 1) : 0.5;
  return samples[Math.round(part * (samples.length - 1))];
}

// A colour that CSS variables define, as three numbers from 0 to 1.
function themeColour(name) {
  const text = getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  return bytesOf(text).map((byte) => byte / 255);
}
