#!/usr/bin/env bash
# Usage: scripts/check_glb.sh [FILE.glb...]
#
# Validates glTF files by the Khronos Group's glTF Validator, which npm installs into
# build/gltf-validator. Without arguments build/release/photohull writes one with a texture and
# one with colours at vertices first, from datasets/templeSparseRing. Errors and warnings fail.
#
#   --help   print this text

# shellcheck source=scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

version=2.0.0-dev.3.10
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
  for texture in auto off; do
    "$root/build/release/photohull" reconstruct "$root/datasets/templeSparseRing" --quality draft \
      --resolution 48 --export glb --texture $texture --out "$scratch/$texture" >/dev/null 2>&1 ||
      die "the reconstruction with --texture $texture failed"
    files+=("$scratch/$texture/mesh.glb")
  done
fi

folder=$root/build/gltf-validator
[ -d "$folder/node_modules/gltf-validator" ] ||
  npm install --no-audit --no-fund --silent --prefix "$folder" gltf-validator@$version

cat >"$scratch/validate.js" <<'SCRIPT'
const fs = require('fs');
const validator = require(process.argv[2]);
(async () => {
  for (const file of process.argv.slice(3)) {
    const {issues} = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)));
    console.log(`${file}: ${issues.numErrors} errors, ${issues.numWarnings} warnings`);
    for (const {code, message, pointer} of issues.messages) console.log(`  ${code} ${pointer}: ${message}`);
    if (issues.numErrors + issues.numWarnings > 0) process.exitCode = 1;
  }
})();
SCRIPT
node "$scratch/validate.js" "$folder/node_modules/gltf-validator" "${files[@]}"
