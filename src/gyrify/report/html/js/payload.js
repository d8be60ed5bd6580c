// The arrays of a run: base 64, deflated, in planes of bytes, differenced along the rows (see packing.py).

// Reads the element with this id; an array is decoded when it is first asked for.
async function openPayload(id, entries) {
  const bytes = await inflated(fromBase64(document.getElementById(id).textContent));
  const places = new Map();
  let offset = 0;
  for (const entry of entries) {
    places.set(entry.name, { entry, offset });
    offset += entry.rows * entry.columns * entry.bytes;
  }
  const decodedArrays = new Map();
  return (name) => {
    if (!decodedArrays.has(name)) {
      const place = places.get(name);
      decodedArrays.set(name, place ? decoded(bytes, place.offset, place.entry) : null);
    }
    return decodedArrays.get(name);
  };
}

function fromBase64(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const characters = atob(text.trim());
  const bytes = new Uint8Array(characters.length);
  for (let k = 0; k < bytes.length; k += 1) bytes[k] = characters.charCodeAt(k);
  return bytes;
}

async function inflated(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Joins the planes, unfolds the signs and sums the differences up, modulo the width of the numbers.
function decoded(bytes, offset, { rows, columns, bytes: width, order }) {
  const n = rows * columns;
  const values = width === 2 ? new Uint16Array(n) : new Uint32Array(n);
  for (let plane = 0; plane < width; plane += 1) {
    const start = offset + plane * n;
    const shift = 8 * plane;
    for (let k = 0; k < n; k += 1) values[k] |= bytes[start + k] << shift;
  }
  for (let k = 0; k < n; k += 1) values[k] = (values[k] >>> 1) ^ -(values[k] & 1);
  for (let pass = 0; pass < order; pass += 1) {
    for (let k = columns; k < n; k += 1) values[k] += values[k - columns];
  }
  return { values, rows, columns };
}
