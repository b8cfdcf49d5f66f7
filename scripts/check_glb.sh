#!/usr/bin/env bash
# Usage: scripts/check_glb.sh [FILE.glb...]
#
# Validates glTF files by the Khronos Group's glTF Validator, which npm installs into
# build/gltf-validator. Compressed ones are decoded by glTF-Transform and meshoptimizer's own decoder,
# and what comes out is validated, too. Without arguments build/release/photohull writes four files
# first, from datasets/templeSparseRing: with a texture, with one as JPEG, compressed, and with
# colours at vertices; the second and the third must have the first's triangles and its bounds.
# Errors and warnings fail.
#
#   --help   print this text

# shellcheck source=scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

packages=(gltf-validator@2.0.0-dev.3.10 @gltf-transform/core@4.5.1 @gltf-transform/extensions@4.5.1 meshoptimizer@1.3.0)
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
same=0  # of the files, how many must have the same triangles
if [ ${#files[@]} -eq 0 ]; then
  for options in "" "--texture-format jpeg" "--compress --unit m" "--texture off"; do
    name=run_${#files[@]}
    # shellcheck disable=SC2086 # options are words
    "$root/build/release/photohull" reconstruct "$root/datasets/templeSparseRing" --quality draft \
      --resolution 48 --export glb $options --out "$scratch/$name" >/dev/null 2>&1 ||
      die "the reconstruction with '$options' failed"
    files+=("$scratch/$name/mesh.glb")
  done
  same=3
fi

folder=$root/build/gltf-validator
[ -d "$folder/node_modules/meshoptimizer" ] ||
  npm install --no-audit --no-fund --silent --prefix "$folder" "${packages[@]}"

cat >"$folder/validate.mjs" <<'SCRIPT'
import fs from 'fs';
import validator from 'gltf-validator';
import {NodeIO, getBounds} from '@gltf-transform/core';
import {ALL_EXTENSIONS} from '@gltf-transform/extensions';
import {MeshoptDecoder} from 'meshoptimizer';

// The validator knows neither this extension nor the buffer that stands for decoded data.
const MESHOPT = 'EXT_meshopt_compression';
const ofCompression = ({code, message, pointer}) => code === 'UNSUPPORTED_EXTENSION' && message.includes(MESHOPT);
let failed = false;

async function validate(name, bytes, ignored = () => false) {
  const {issues} = await validator.validateBytes(new Uint8Array(bytes));
  const found = issues.messages.filter((m) => m.severity < 2 && !ignored(m));
  console.log(`${name}: ${found.length} errors and warnings`);
  for (const {code, message, pointer} of issues.messages) console.log(`  ${code} ${pointer}: ${message}`);
  failed ||= found.length > 0;
}

await MeshoptDecoder.ready;
const io = new NodeIO().registerExtensions(ALL_EXTENSIONS).registerDependencies({'meshopt.decoder': MeshoptDecoder});
const [same, ...files] = process.argv.slice(2);
let first;
for (const [i, file] of files.entries()) {
  const bytes = fs.readFileSync(file);
  await validate(file, bytes, ofCompression);
  const document = await io.readBinary(new Uint8Array(bytes));
  const root = document.getRoot();
  const primitives = root.listMeshes().flatMap((mesh) => mesh.listPrimitives());
  const triangles = primitives.reduce((sum, p) => sum + p.getIndices().getCount() / 3, 0);
  const {min, max} = getBounds(root.listScenes()[0]);
  console.log(`  ${bytes.length} bytes, ${triangles} triangles from ${min.map((x) => x.toFixed(6))} to ${max.map((x) => x.toFixed(6))}`);
  const compression = root.listExtensionsUsed().find((e) => e.extensionName === MESHOPT);
  if (compression) {
    compression.dispose();
    await validate(`${file}, decoded`, await io.writeBinary(document));
  }
  first ??= {triangles, min, max};
  const apart = Math.max(...[0, 1, 2].flatMap((c) => [min[c] - first.min[c], max[c] - first.max[c]]).map(Math.abs));
  const step = Math.max(...[0, 1, 2].map((c) => first.max[c] - first.min[c])) / 65535;
  if (i < same && (triangles !== first.triangles || apart > step)) {
    console.log('  it is not the mesh of the first file');
    failed = true;
  }
}
process.exitCode = failed ? 1 : 0;
SCRIPT
node "$folder/validate.mjs" "$same" "${files[@]}"
