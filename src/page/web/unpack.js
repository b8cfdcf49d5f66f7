// From the page's packed texts back to bytes, code and numbers (src/page/encode_model.h).

async function unpackBytes(id) {
  const text = atob(byId(id).textContent), packed = new Uint8Array(text.length);
  for (let i = 0; i < packed.length; ++i) packed[i] = text.charCodeAt(i);
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
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

/** A stream's numbers, element by element. Differences are summed up to what they are of. */
function readStream(bytes, from, count, stream) {
  const all = new Uint32Array(count * stream.components);
  let at = from;
  for (let c = 0; c < stream.components; ++c)
    for (let b = 0; b < stream.bytes; ++b)
      for (let i = 0; i < count; ++i) all[i * stream.components + c] |= bytes[at++] << (8 * b);
  if (stream.name === "triangles") return all;
  const mask = 2 ** (8 * stream.bytes) - 1;
  for (let c = 0; c < stream.components; ++c) {
    let value = 0;
    for (let i = c; i < all.length; i += stream.components) {
      const code = all[i];
      value = (value + ((code >>> 1) ^ -(code & 1))) & mask;
      all[i] = value;
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

/** The streams by their names; `table` describes them. */
function readModel(bytes, table) {
  const model = {};
  let from = 0;
  for (const stream of table.streams) {
    const count = stream.name === "triangles" ? 3 * table.triangles : table.vertices;
    const numbers = readStream(bytes, from, count, stream);
    model[stream.name] = stream.name === "triangles" ? readCorners(numbers) : numbers;
    from += count * stream.components * stream.bytes;
  }
  return model;
}
