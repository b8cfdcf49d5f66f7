#!/usr/bin/env bash
# Usage: scripts/demo.sh
#
# Sets photohull up (see scripts/setup.sh) and reconstructs the temple of datasets/templeSparseRing
# from its 16 photographs into out/temple/.

# shellcheck source=scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

case ${1-} in
  "") ;;
  -h | --help)
    print_help "${BASH_SOURCE[0]}"
    exit 0
    ;;
  *) die "Unknown option '$1'. See scripts/demo.sh --help." ;;
esac

cd "$root"
scripts/setup.sh --target photohull

say "" "Reconstructing datasets/templeSparseRing"
build/release/photohull reconstruct datasets/templeSparseRing --out out/temple || die \
  "The demo failed; the message above says why. 'build/release/photohull devices' shows whether
OpenGL works here."

cat <<'TEXT'

Open in out/temple/:
  report.html   the model to turn, its cameras, and what to think of it    any browser
  preview.png   what was made, beside a photograph    any image viewer
  mesh.ply      the surface with colours              MeshLab, Blender (Import > Stanford PLY)
  volume.vdb    surface, colour and confidence grids  Blender (Add > Volume), Houdini (File node)
  report.json   what each stage did and cost          any editor
TEXT
