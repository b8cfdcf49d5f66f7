// From the page's packed texts back to bytes, code and numbers (src/page/encode_model.h).

/** The bytes of a text of base64. */
function bytesOf(text) {
  const letters = atob(text), bytes = new Uint8Array(letters.length);
  for (let i = 0; i < letters.length; ++i) bytes[i] = letters.charCodeAt(i);
  return bytes;
}

async function unpackBytes(id) {
  const stream = new Blob([bytesOf(byId(id).textContent)]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

async function unpackModule(id) {
  const address = URL.createObjectURL(new Blob([await unpackBytes(id)], { type: "text/javascript" }));
  try {
    return await import(address);
  } finally {
    URL.revokeObjectURL(address);
  }
}

/** A stream's numbers, element by element. Differences are summed up to what they are of, modulo what the array's elements hold. */
function readStream(bytes, from, count, { name, components, bytes: width }) {
  const all = new (width === 1 ? Uint8Array : width === 2 ? Uint16Array : Uint32Array)(count * components);
  for (let c = 0; c < components; ++c) {
    const start = from + c * width * count;
    let value = 0;
    for (let i = 0, at = c; i < count; ++i, at += components) {
      let code = bytes[start + i];
      if (width > 1) code |= bytes[start + count + i] << 8;
      if (width > 2) code |= bytes[start + 2 * count + i] << 16 | bytes[start + 3 * count + i] << 24;
      if (name !== "triangles") code = value = value + ((code >>> 1) ^ -(code & 1)) | 0;
      all[at] = code;
    }
  }
  return all;
}

function readCorners(codes) {
  let next = 0;
  for (let i = 0; i < codes.length; ++i) {
    const code = codes[i];
    codes[i] = next - code;
    if (code === 0) ++next;
  }
  return codes;
}

/** Unit normals of the vertices, as whole numbers up to 32767: of those at one place, whatever their places on a texture,
    the mean of all triangles there by area. */
function normalsOf(positions, triangles) {
  const first = firstAtPlace(positions), sums = new Float64Array(positions.length);
  for (let i = 0; i < triangles.length; i += 3) {
    const a = 3 * triangles[i], b = 3 * triangles[i + 1], c = 3 * triangles[i + 2];
    const ux = positions[b] - positions[a], uy = positions[b + 1] - positions[a + 1], uz = positions[b + 2] - positions[a + 2];
    const vx = positions[c] - positions[a], vy = positions[c + 1] - positions[a + 1], vz = positions[c + 2] - positions[a + 2];
    const x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
    for (let k = 0; k < 3; ++k) {
      const at = 3 * first[triangles[i + k]];
      sums[at] += x;
      sums[at + 1] += y;
      sums[at + 2] += z;
    }
  }
  const normals = new Int16Array(positions.length);
  for (let v = 0; v < first.length; ++v) {
    const at = 3 * first[v], x = sums[at], y = sums[at + 1], z = sums[at + 2];
    const scale = 32767 / (Math.sqrt(x * x + y * y + z * z) || 1);
    normals[3 * v] = scale * x;
    normals[3 * v + 1] = scale * y;
    normals[3 * v + 2] = scale * z;
  }
  return normals;
}

/** For each vertex the first one at its place. */
function firstAtPlace(positions) {
  const count = positions.length / 3, first = new Uint32Array(count);
  let slots = 1;
  while (slots < 2 * count) slots *= 2;
  const table = new Uint32Array(slots);  // a vertex, counted from 1
  for (let v = 0; v < count; ++v) {
    const x = positions[3 * v], y = positions[3 * v + 1], z = positions[3 * v + 2];
    let at = (Math.imul(x, 73856093) ^ Math.imul(y, 19349663) ^ Math.imul(z, 83492791)) & (slots - 1);
    for (;; at = (at + 1) & (slots - 1)) {
      const other = table[at] - 1;
      if (other >= 0 && (positions[3 * other] !== x || positions[3 * other + 1] !== y || positions[3 * other + 2] !== z)) continue;
      if (other < 0) table[at] = v + 1;
      first[v] = other < 0 ? v : other;
      break;
    }
  }
  return first;
}

/** The picture of a text of base64; nothing for an empty one. A browser takes longer to decode an Image whose address is a data: URL. */
async function unpackImage(id) {
  const text = byId(id).textContent;
  return text ? createImageBitmap(new Blob([bytesOf(text)], { type: "image/jpeg" })) : null;
}

/** The streams by their names; `table` describes them. */
function readModel(bytes, table) {
  const model = {};
  let from = 0;
  for (const stream of table.streams) {
    const count = stream.name === "triangles" ? 3 * table.triangles : table.vertices;
    const numbers = readStream(bytes, from, count, stream);
    model[stream.name] = stream.name === "triangles" ? readCorners(numbers) : numbers;
    model[stream.name].step = stream.step;
    from += count * stream.components * stream.bytes;
  }
  return model;
}
