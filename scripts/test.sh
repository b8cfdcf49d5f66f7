#!/usr/bin/env bash
# Usage: scripts/test.sh [--all]
#
# Sets photohull up (see scripts/setup.sh) and runs its tests but for those labelled slow.
#
#   --all    run these, too: every command of the docs, every way to go wrong, faults, random runs,
#            long ones, cameras by COLMAP. Also check what tests cannot: formatting, scripts,
#            citations, links in the docs, glTF files (npm installs their validator), installation
#            and the Debian package; and build once more with clang and the address and
#            undefined-behaviour sanitizers, to run the unit tests so instead of without them, the
#            fuzzers and clang-tidy
#   --help   print this text

# shellcheck source=scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

with_all=no
while [ $# -gt 0 ]; do
  case $1 in
    --all) with_all=yes ;;
    -h | --help)
      print_help "${BASH_SOURCE[0]}"
      exit 0
      ;;
    *) die "Unknown option '$1'. See scripts/test.sh --help." ;;
  esac
  shift
done

cd "$root"
build=build/release
scratch=$(mktemp -d)
# Mesa keeps compiled kernels below the user's home, which may not be writable; each run would compile them anew.
export MESA_SHADER_CACHE_DIR=$root/$build/shader_cache
mkdir -p "$MESA_SHADER_CACHE_DIR"
trap 'rm -rf "$scratch"' EXIT
passed=0
failed=()

# check NAME COMMAND...: runs the command; its output is shown when it fails.
check() {
  begin "$@"
  finish "$1"
}

# begin NAME COMMAND...: the same, while other things are done; finish NAME waits for it.
declare -A begun
begin() {
  local name=$1
  shift
  (
    local start=$SECONDS status=0
    set +e
    (set -e; "$@") >"$scratch/$name.log" 2>&1
    status=$?
    echo $((SECONDS - start)) >"$scratch/$name.seconds"
    exit $status
  ) &
  begun[$name]=$!
}
finish() {
  local name=$1
  if wait "${begun[$name]}"; then
    say "ok      $name ($(cat "$scratch/$name.seconds") s)"
    passed=$((passed + 1))
  else
    tail -n 60 "$scratch/$name.log"
    say "FAILED  $name"
    failed+=("$name")
  fi
}

# The same for a command whose output people want to follow.
check_aloud() {
  local name=$1
  shift
  if "$@"; then passed=$((passed + 1)); else failed+=("$name"); fi
}

run_tests() { ctest --preset "$1" --parallel "$jobs" --no-tests=error "${@:2}"; }

# C++ files under the folders given that exist. shaders/ is left out: the GLSL compiler reads it too.
cpp_files() {
  local folder
  for folder in "$@"; do
    if [ -d "$folder" ]; then find "$folder" -name '*.cpp' -o -name '*.h'; fi
  done | sort
}

formatting() {
  local file files
  files=$(cpp_files src cli python tests bench | xargs -P "$jobs" -n 50 clang-format --dry-run -Werror 2>&1 |
    sed -n 's/^\(.*\):[0-9]*:[0-9]*: error: code should be clang-formatted.*/\1/p' | sort -u)
  for file in $files; do say "to mend: clang-format -i $file"; done
  [ -z "$files" ]
}

shell_scripts() { shellcheck -x scripts/*.sh .ci/run; }

# Prints the [Key] and [Key; Key] that comments cite, once each. A citation may span lines.
cited_keys() {
  # shellcheck disable=SC2016
  find src shaders cli python tests -type f -print0 | xargs -0 perl -0777 -ne '
    s{\s*\n\s*//[/ ]*}{ }g;
    my $key = qr/[A-Z][A-Za-z]+\d\d[a-z]?/;
    while (/\[($key(?:[;,] ?$key)*)\]/g) { print "$_\n" for split /[;,] ?/, $1 }' | sort -u
}

citations() {
  local key status=0
  for key in $(cited_keys); do
    grep -qF "[$key]" BIBLIOGRAPHY.md && continue
    say "BIBLIOGRAPHY.md has no entry [$key], which is cited in:"
    grep -rlw "$key" src shaders cli python tests
    status=1
  done
  return $status
}

installation() {
  cmake --install $build --prefix "$scratch/prefix"
  "$scratch/prefix/bin/photohull" --version | grep -F "$(project_version)"
  "$scratch/prefix/bin/photohull" --version --json | grep -F OpenVDB
  "$scratch/prefix/bin/photohull" chart --help | grep -F -- --draw-only
  man --warnings -l "$scratch/prefix/share/man/man1/photohull-measure.1.gz" | grep -F -- --sections
  # The library, as another program finds and uses it.
  cmake -S examples -B "$scratch/examples" -DCMAKE_PREFIX_PATH="$scratch/prefix"
  cmake --build "$scratch/examples"
  "$scratch/examples/reconstruct_in_memory" datasets/templeSparseRing | grep -F "signed distance"
  PYTHONPATH="$scratch/prefix/lib/python3/dist-packages" /usr/bin/python3 -c "import photohull; print(photohull.devices())"
}

project_version() { sed -n 's/^project(photohull VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt; }

debian_package() {
  (cd $build && cpack -G DEB -B "$scratch/package")
  lintian --fail-on error "$scratch"/package/*.deb
  dpkg -I "$scratch"/package/photohull_*.deb
  local program
  for program in photohull photohull-main photohull-lab; do
    dpkg -c "$scratch"/package/photohull_*.deb | grep -F "./usr/bin/$program"
  done
  dpkg-deb -f "$scratch"/package/photohull_*.deb Depends | grep -F libopenvdb
  dpkg-deb -f "$scratch"/package/python3-photohull_*.deb Depends | grep -F "libphotohull0.1 (="
  dpkg -c "$scratch"/package/libphotohull-dev_*.deb | grep -F ./usr/include/photohull/photohull.h
  # All of them beside each other, as apt would lay them.
  local package
  for package in "$scratch"/package/*.deb; do dpkg -x "$package" "$scratch/debian"; done
  "$scratch/debian/usr/bin/photohull" demo --resolution 32 --out "$scratch/demo" | grep -F "16 views"
  LD_LIBRARY_PATH="$scratch/debian/usr/lib" PYTHONPATH="$scratch/debian/usr/lib/python3/dist-packages" /usr/bin/python3 -c \
    "import photohull; print(photohull.__file__, photohull.devices())"
}

# The archive, in a folder whose name has a space, by its own renderer; and no library but the C library's is the system's.
bundle() {
  scripts/bundle.sh --no-build --level 0 --out "$scratch/bundle.tar.xz"
  mkdir "$scratch/any folder"
  tar -xf "$scratch/bundle.tar.xz" -C "$scratch/any folder"
  cd "$scratch/any folder"/photohull-*
  local file foreign
  for file in libexec/photohull-main lib/*.so* lib/mesa/*.so* lib/mesa/dri/*.so; do
    foreign=$(LD_LIBRARY_PATH="$PWD/lib/gcc" ldd "$file" | grep -vF "$PWD/" |
      grep -vE 'linux-vdso|ld-linux|lib(c|m|dl|pthread|rt|resolv|util)\.so|statically linked' || true)
    if [ -n "$foreign" ]; then
      say "$file takes from the system:" "$foreign"
      return 1
    fi
  done
  PHOTOHULL_EGL=bundled ./photohull doctor | grep -F "llvmpipe"
  PHOTOHULL_EGL=bundled ./photohull demo --resolution 32 --out "$scratch/bundled" | grep -F "16 views"
  # A picture that is none must be refused by name; the readers of films that stand-ins replace must not be run into.
  mkdir "$scratch/damaged"
  cp share/photohull/templeSparseRing/* "$scratch/damaged"
  echo "no picture" >"$scratch/damaged/templeSR0001.png"
  if PHOTOHULL_EGL=bundled ./photohull reconstruct "$scratch/damaged" --strict --out "$scratch/never" 2>"$scratch/said"; then return 1; fi
  grep -F templeSR0001.png "$scratch/said"
}

# Python's package, which is built where these are there.
install_missing python3-dev python3-numpy python3-pytest pybind11-dev

# Every test runs once: unit tests are built where they run.
target=all
tools=(ffmpeg colmap) # films, and cameras without a sheet: 14 MB
if [ $with_all = yes ]; then
  target=program_tests
  tools+=(clang lld clang-format clang-tidy shellcheck dpkg-dev file lintian patchelf xz-utils man-db groff python3
    chromium python3-pil opencv-doc parallel openmpi-bin slurm-wlm munge)
  command -v npm >/dev/null || tools+=(npm)
fi
scripts/setup.sh --only-install
if [ $interactive = yes ]; then
  install_missing "${tools[@]}" # may ask for a password
  scripts/setup.sh --no-install --target $target
else
  # While the program is compiled.
  install_missing "${tools[@]}" >"$scratch/installed" 2>&1 &
  installing=$!
  scripts/setup.sh --no-install --target $target
  wait $installing || die "$(cat "$scratch/installed")"
  cat "$scratch/installed"
fi
started=$SECONDS

if [ $with_all = yes ]; then
  check_aloud "tests of the program" run_tests release --label-exclude unit
else
  check_aloud "tests" run_tests release --label-exclude slow
fi
if [ $with_all = yes ]; then
  check "clang-format" formatting
  check "shellcheck" shell_scripts
  check "citations" citations
  check "links in the docs" scripts/check_links.py
  # Packing takes one core; what else there is to check, the other.
  begin "cpack -G DEB" debian_package
  check "glTF files" scripts/check_glb.sh
  check "USDZ files" scripts/check_usdz.sh
  check "cmake --install" installation
  check "bundle" bundle
  finish "cpack -G DEB"
  check_aloud "build with sanitizers" scripts/setup.sh --preset asan --target unit_tests
  check_aloud "unit tests with sanitizers" run_tests asan --label-regex unit
  check_aloud "fuzzers" scripts/fuzz.sh --seconds 2
  check "clang-tidy" scripts/check_tidy.py build/asan "$jobs"
fi

say "" "Took $((SECONDS - started)) s after the build."
for name in "${failed[@]}"; do say "FAILED  $name"; done
say "Checks: $passed passed, ${#failed[@]} failed"
[ ${#failed[@]} -eq 0 ]
