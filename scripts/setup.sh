#!/usr/bin/env bash
# Usage: scripts/setup.sh [--preset NAME] [--target NAME] [--no-install | --only-install]
#
# Installs what photohull needs and this machine lacks (Debian packages, through apt as root or
# with sudo), then configures and builds it to build/NAME/photohull. Run again, it only builds
# what changed.
#
#   --preset NAME   release (default), debug, asan or coverage; see CMakePresets.json
#   --target NAME   build this alone: photohull (the program without its lab and the tests), installed (all that
#                   packages hold), unit_tests, program_tests (the program and all other tests)
#   --no-install    build with what is there; install nothing
#   --only-install  install, and build nothing
#   --help          print this text

# shellcheck source=scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

packages=(
  # Tools: compiler, build, shader check; studies and the test of the docs.
  g++ cmake ninja-build ccache git glslang-tools mold python3
  # OpenGL through EGL, and Mesa's software rasterizer for machines without a GPU.
  libegl-dev libopengl-dev libegl1 libegl-mesa0 libgl1-mesa-dri
  # Volumes; OpenVDB's CMake module asks for Boost.
  libopenvdb-dev libopenvdb-tools libtbb-dev libboost-iostreams-dev
  # Meshes in other formats; distances to meshes; fewer triangles; nearest neighbours; convex hulls.
  libassimp-dev libembree-dev libmeshoptimizer-dev libnanoflann-dev libqhull-dev
  # Images; OpenImageIO's CMake files ask for its tools. Imath has half floats.
  libimath-dev libopenimageio-dev openimageio-tools libopencv-dev libjpeg-dev
  libglm-dev libcli11-dev nlohmann-json3-dev
  # Scenes of other programs; camera refinement.
  libpugixml-dev zlib1g-dev libceres-dev libeigen3-dev
  # Charts: JavaScript engine, SVG to PNG, hashes.
  duktape-dev librsvg2-dev libxxhash-dev pkg-config
  libgtest-dev libgmock-dev
)

preset=release
target=all
install=yes
only_install=no
while [ $# -gt 0 ]; do
  case $1 in
    --preset)
      [ $# -ge 2 ] || die "--preset needs a name: release, debug, asan or coverage."
      preset=$2
      shift
      ;;
    --target)
      [ $# -ge 2 ] || die "--target needs a name, such as photohull."
      target=$2
      shift
      ;;
    --no-install) install=no ;;
    --only-install) only_install=yes ;;
    -h | --help)
      print_help "${BASH_SOURCE[0]}"
      exit 0
      ;;
    *) die "Unknown option '$1'. See scripts/setup.sh --help." ;;
  esac
  shift
done

cd "$root"
case $preset in
  release | debug | asan | coverage) ;;
  *) die "There is no preset '$preset'; use release, debug, asan or coverage." ;;
esac
if [ $install = yes ]; then
  install_missing "${packages[@]}"
  if [ "$preset" = asan ]; then install_missing clang lld; fi
fi
[ $only_install = no ] || exit 0

# OpenVDB's templates take a compiler more than a gigabyte: fewer jobs than cores where memory is short.
available_kb=$(awk '/^MemAvailable:/ {print $2}' /proc/meminfo 2>/dev/null || echo 0)
fitting=$((available_kb / 1500000))
if [ "$fitting" -lt "$jobs" ]; then
  jobs=$((fitting > 1 ? fitting : 1))
fi

# Checkouts in different folders share what they compile alike.
export CCACHE_BASEDIR=$root

build=build/$preset
mkdir -p "$build" || die "The folder $build cannot be made; is this checkout writable?"
say "Configuring $build"
if ! cmake --preset "$preset" >"$build/configure.log" 2>&1; then
  tail -n 25 "$build/configure.log" >&2
  die "CMake could not configure the project (the whole log: $build/configure.log).
If a package is missing, run scripts/setup.sh without --no-install. If this checkout was moved or
its packages were upgraded, delete the folder $build and run this script again."
fi

say "Building $build with $jobs jobs"
quiet=()
[ -t 1 ] || quiet=(-- --quiet) # one line a file is for terminals
if ! cmake --build "$build" --target "$target" --parallel "$jobs" "${quiet[@]}"; then
  die "The build failed; the first error above is the cause. If the compiler was killed, memory ran
short: close other programs and run this script again, it goes on where it stopped."
fi
say "Ready: $build/photohull"
