// Charts of textured GLB files beside those that xatlas makes for the same triangles (decision 0029).
//
//     npm install --no-save watlas@1.0.1 @gltf-transform/core@4
//     node bench/chart_atlas.mjs MESH.glb...
//
// Says of both how long the borders between charts are, in diagonals of the mesh, and how much of the page the triangles
// cover; xatlas gets as many texels as the file has.
import { NodeIO } from "@gltf-transform/core";
import * as watlas from "watlas";

/** Corners of triangles, places on the page beside them, and vertices by their positions alone. */
async function readMesh(file) {
  const document = await new NodeIO().read(file);
  const corners = [], places = [], positions = [], numbers = new Map();
  for (const part of document.getRoot().listMeshes()[0].listPrimitives()) {
    const at = part.getAttribute("POSITION").getArray(), place = part.getAttribute("TEXCOORD_0").getArray();
    for (const v of part.getIndices().getArray()) {
      const position = [...at.slice(3 * v, 3 * v + 3)], key = position.join(" ");
      if (!numbers.has(key)) numbers.set(key, positions.push(position) - 1);
      corners.push(numbers.get(key));
      places.push([place[2 * v], place[2 * v + 1]]);
    }
  }
  return { corners, places, positions, size: document.getRoot().listTextures()[0].getSize() };
}

const distance = (p, q) => Math.hypot(...p.map((x, i) => x - q[i]));

function diagonal(positions) {
  const ends = [Math.min, Math.max].map(end => [0, 1, 2].map(i => positions.reduce((so, p) => end(so, p[i]), positions[0][i])));
  return distance(...ends);
}

/** Length of the edges whose two triangles have them at different places. */
function borderLength({ corners, positions }, places) {
  const seen = new Map();
  let sum = 0;
  for (let c = 0; c < corners.length; ++c) {
    const next = c % 3 === 2 ? c - 2 : c + 1;
    const [from, to] = corners[c] < corners[next] ? [c, next] : [next, c];
    const edge = corners[from] + " " + corners[to];
    const place = [...places[from], ...places[to]].map(x => x.toFixed(6)).join(" ");
    if (!seen.has(edge)) seen.set(edge, place);
    else if (seen.get(edge) !== place) sum += distance(positions[corners[from]], positions[corners[to]]);
  }
  return sum;
}

/** Area of all triangles at places in a plane. */
function areaOf(places) {
  let sum = 0;
  for (let c = 0; c < places.length; c += 3) {
    const [[ax, ay], [bx, by], [cx, cy]] = places.slice(c, c + 3);
    sum += Math.abs((bx - ax) * (cy - ay) - (cx - ax) * (by - ay)) / 2;
  }
  return sum;
}

function surfaceArea({ corners, positions }) {
  let sum = 0;
  for (let c = 0; c < corners.length; c += 3) {
    const [p, q, r] = corners.slice(c, c + 3).map(v => positions[v]);
    const u = q.map((x, i) => x - p[i]), v = r.map((x, i) => x - p[i]);
    sum += Math.hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]) / 2;
  }
  return sum;
}

function say(name, mesh, places, size, more) {
  const borders = borderLength(mesh, places) / diagonal(mesh.positions), covered = areaOf(places) / (size[0] * size[1]);
  console.log(`  ${name}: borders ${borders.toFixed(1)} diagonals, page ${size.join(" x ")}, ${(100 * covered).toFixed(0)} % covered${more}`);
}

await watlas.Initialize();
for (const file of process.argv.slice(2)) {
  const mesh = await readMesh(file), own = mesh.places.map(([x, y]) => [x * mesh.size[0], y * mesh.size[1]]);
  console.log(`${file}: ${mesh.corners.length / 3} triangles`);
  say("photohull", mesh, own, mesh.size, "");
  const atlas = new watlas.Atlas();
  atlas.addMesh({ vertexPositionData: new Float32Array(mesh.positions.flat()), vertexCount: mesh.positions.length,
    vertexPositionStride: 12, indexData: new Uint32Array(mesh.corners), indexCount: mesh.corners.length });
  const before = process.cpuUsage();
  atlas.generate({}, { padding: 3, texelsPerUnit: Math.sqrt(areaOf(own) / surfaceArea(mesh)) });
  const { user, system } = process.cpuUsage(before);
  const made = atlas.getMesh(0), indices = new Uint32Array(made.indexCount);
  made.getIndexArray(indices);
  const places = [...indices].map(v => [...made.getVertex(v).uv]);
  say("xatlas", mesh, places, [atlas.width, atlas.height], `, ${atlas.chartCount} charts, ${((user + system) / 1e6).toFixed(1)} CPU s`);
  atlas.delete();
}
