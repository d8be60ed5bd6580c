// Numbers for people.

const MINUS = "\u2212";

function withMinus(text) {
  return text.replace(/^-/, MINUS).replace(/e\+?(-?)(\d+)$/, (_, sign, digits) =>
    ` × 10${(sign + digits).replace(/[-\d]/g, (c) => "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["-0123456789".indexOf(c)])}`);
}

// So many significant digits, without zeros that say nothing.
function brief(value, digits = 4) {
  if (value === null || value === undefined || Number.isNaN(value)) return "–";
  if (typeof value !== "number") return String(value);
  if (Number.isInteger(value) && Math.abs(value) < 1e7) return withMinus(String(value));
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-3 || size >= 1e7)) return withMinus(value.toExponential(digits - 1));
  return withMinus(String(Number(value.toPrecision(digits))));
}

function fixed(value, decimals) {
  return value === null ? "–" : withMinus(value.toFixed(decimals));
}

function withUnit(text, unit) {
  return unit ? `${text}\u00a0${unit}` : text;
}

// A value with as many decimals as its precision deserves, and how far off it can be.
function measured(value, halfStep) {
  if (value === 0 && halfStep === 0) return { text: "0", error: 0 };
  const size = Math.max(Math.abs(value), halfStep);
  const decimals = halfStep > 0 ? Math.ceil(-Math.log10(2 * halfStep)) : 6 - Math.floor(Math.log10(size));
  if (decimals > 9) return { text: withMinus(value.toExponential(4)), error: halfStep + 1e-5 * size };
  const shown = Math.min(Math.max(decimals, 0), 9);
  return { text: withMinus(value.toFixed(shown)), error: halfStep + 0.5 * 10 ** -shown };
}

// Round numbers inside [low, high], about so many.
function ticks(low, high, about = 4) {
  const span = high - low;
  if (!(span > 0)) return [low];
  const rough = span / about;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 2.5, 5, 10].map((k) => k * power).find((s) => s >= rough * 0.999);
  const found = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * span; k += 1) {
    found.push(Number((k * step).toPrecision(12)));
  }
  return found;
}

function clamp(value, low, high) {
  return Math.min(Math.max(value, low), high);
}
