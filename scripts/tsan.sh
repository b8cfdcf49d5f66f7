#!/usr/bin/env bash
# Usage: scripts/tsan.sh [TEST...]
#
# Runs unit tests under the thread sanitizer (preset tsan; docs/design/robustness.md). TBB hands the work to
# the threads, and what the sanitizer cannot see there looks like races everywhere: so TBB is built
# with it, too, from Debian's source package, which needs the network once.
#
#   TEST...   test programs to build and run
#             (default: those of the modules that work in threads)
#   --help    print this text
#
# PHOTOHULL_TBB_SOURCE=DIR names oneTBB's unpacked sources where they cannot be fetched.

# shellcheck source=scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

tests=()
while [ $# -gt 0 ]; do
  case $1 in
    -h | --help)
      print_help "${BASH_SOURCE[0]}"
      exit 0
      ;;
    -*) die "Unknown option '$1'. See scripts/tsan.sh --help." ;;
    *) tests+=("$1") ;;
  esac
  shift
done
[ ${#tests[@]} -gt 0 ] || tests=(core_test io_test io_mesh_test raycast_test photo_test masks_test views_test
  frontier_test volume_test mesh_test assess_test carving_test refine_test pipeline_test)

cd "$root"
export CCACHE_BASEDIR=$root
build=$root/build/tsan
tbb=$build/onetbb
mkdir -p "$tbb"

# Fetches the source package of the TBB that is installed and unpacks it in $tbb.
fetch_tbb() {
  local suite lists=$tbb/lists
  suite=$(sed -n 's/^VERSION_CODENAME=//p' /etc/os-release)
  mkdir -p "$lists/partial" "$tbb/cache/archives/partial"
  echo "deb-src http://deb.debian.org/debian $suite main" >"$tbb/sources.list"
  local apt=(apt-get -q -o "Dir::Etc::sourcelist=$tbb/sources.list" -o Dir::Etc::sourceparts=/dev/null
    -o "Dir::State::Lists=$lists" -o "Dir::Cache=$tbb/cache")
  (cd "$tbb" && "${apt[@]}" update && "${apt[@]}" source --download-only onetbb &&
    tar -xf onetbb_*.orig.tar.*)
}

# Builds libtbb.so in $tbb/build.
build_tbb() {
  cmake -S "$1" -B "$tbb/build" -G Ninja \
    -DCMAKE_BUILD_TYPE=RelWithDebInfo -DTBB_TEST=OFF -DTBB_STRICT=OFF -DTBBMALLOC_BUILD=OFF \
    -DCMAKE_CXX_FLAGS="-fsanitize=thread -fno-omit-frame-pointer" &&
    cmake --build "$tbb/build" --parallel "$jobs"
}

find_source() { find "$tbb" -maxdepth 1 -iname 'onetbb-*' -type d | head -n 1; }

find_tbb() { find "$tbb/build" -name 'libtbb.so.12' 2>/dev/null | head -n 1; }

if [ -z "$(find_tbb)" ]; then
  source=${PHOTOHULL_TBB_SOURCE:-$(find_source)}
  if [ -z "$source" ]; then
    say "Fetching TBB's sources"
    fetch_tbb >"$tbb/log" 2>&1 || die "TBB's sources cannot be fetched; see $tbb/log
Without Debian's archive, unpack oneTBB's sources and name their folder: PHOTOHULL_TBB_SOURCE=DIR scripts/tsan.sh"
    source=$(find_source)
  fi
  say "Building TBB with the thread sanitizer"
  build_tbb "$source" >"$tbb/log" 2>&1 || die "TBB does not build; see $tbb/log"
fi
cmake --preset tsan >"$build/configure.log" 2>&1 || die "CMake failed; see $build/configure.log"
cmake --build --preset tsan --parallel "$jobs" --target "${tests[@]}" -- --quiet ||
  die "The tests do not build."

LD_LIBRARY_PATH=$(dirname "$(find_tbb)")
export LD_LIBRARY_PATH
export TSAN_OPTIONS="suppressions=$root/tests/tsan.supp:history_size=4"
# Other programs that a test starts cannot load this TBB.
export GTEST_FILTER=-WriteVdb.OtherProgramsReadIt
failed=()
for test in "${tests[@]}"; do
  log=$build/$test.log
  if "$(find "$build/tests" -name "$test" -type f)" --gtest_brief=1 >"$log" 2>&1; then
    say "ok      $test"
  else
    say "FAILED  $test: $(grep -c 'WARNING: ThreadSanitizer' "$log") reports in $log"
    failed+=("$test")
  fi
done
[ ${#failed[@]} -eq 0 ]
