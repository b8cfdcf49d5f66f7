#!/usr/bin/env bash
# Usage: scripts/check_usdz.sh [FILE.usdz...]
#
# Reads USDZ files by the loader of three.js, which npm installs into build/usdz-reader, and says what it
# found. Without arguments build/release/photohull writes one first, from datasets/templeSparseRing.
# It fails where a file has no triangles, normals, places on a texture or texture.
#
#   --help   print this text

# shellcheck source=scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

case ${1:-} in
  -h | --help)
    print_help "${BASH_SOURCE[0]}"
    exit 0
    ;;
esac
command -v npm >/dev/null || die "npm is missing: apt-get install npm"

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
files=("$@")
if [ ${#files[@]} -eq 0 ]; then
  "$root/build/release/photohull" reconstruct "$root/datasets/templeSparseRing" --quality draft \
    --resolution 48 --export usdz --out "$scratch/run" >/dev/null 2>&1 || die "the reconstruction failed"
  files=("$scratch/run/mesh.usdz")
fi

folder=$root/build/usdz-reader
[ -d "$folder/node_modules/three" ] || npm install --no-audit --no-fund --silent --prefix "$folder" three@0.180.0

cat >"$folder/read.mjs" <<'SCRIPT'
import fs from 'fs';

// Textures are taken as they are, for there is no browser that shows them.
const images = [];
globalThis.document = {createElementNS: () => ({addEventListener() {}, removeEventListener() {}, set src(url) { images.push(String(url)); }})};
globalThis.self = globalThis;
const {USDLoader} = await import('three/examples/jsm/loaders/USDLoader.js');
let failed = false;
for (const file of process.argv.slice(2)) {
  images.length = 0;
  const group = new USDLoader().parse(new Uint8Array(fs.readFileSync(file)).buffer);
  let triangles = 0, whole = true;
  group.traverse(({geometry, material}) => {
    if (!geometry) return;
    triangles += (geometry.index ?? geometry.attributes.position).count / 3;
    whole &&= Boolean(geometry.attributes.normal && geometry.attributes.uv && material.map);
  });
  const sizes = await Promise.all(images.map(async (url) => url.startsWith('blob:') ? (await (await fetch(url)).arrayBuffer()).byteLength : 0));
  console.log(`${file}: ${triangles} triangles, textures of ${sizes.join(', ')} bytes`);
  if (!triangles || !whole || !sizes.length || sizes.includes(0)) {
    console.log('  something is missing');
    failed = true;
  }
}
process.exitCode = failed ? 1 : 0;
SCRIPT
node "$folder/read.mjs" "${files[@]}"
