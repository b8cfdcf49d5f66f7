#!/usr/bin/env bash
# Usage: scripts/fuzz.sh [--seconds N] [--target NAME]
#
# Feeds every reader of foreign files (scenes, images, meshes, specs, plans, option values) with damaged
# input under the address and undefined-behaviour sanitizers, by clang's libFuzzer. Input that
# crashes a reader, makes it throw anything but photohull::Error, takes 5 seconds or asks for 512
# MiB at once is kept in build/asan/found/ and fails the run. docs/design/robustness.md tells more.
#
#   --seconds N    for each target (default: 10)
#   --target NAME  only this one; build/asan/tests/fuzz/photohull_fuzz --list prints the names
#   --help         print this text

# shellcheck source=scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

seconds=10
targets=()
while [ $# -gt 0 ]; do
  case $1 in
    --seconds | --target)
      [ $# -ge 2 ] || die "$1 needs a value."
      if [ "$1" = --seconds ]; then seconds=$2; else targets=("$2"); fi
      shift
      ;;
    -h | --help)
      print_help "${BASH_SOURCE[0]}"
      exit 0
      ;;
    *) die "Unknown option '$1'. See scripts/fuzz.sh --help." ;;
  esac
  shift
done
[[ $seconds =~ ^[1-9][0-9]*$ ]] || die "--seconds $seconds: expected a whole number above 0."

cd "$root"
install_missing clang lld
build=build/asan
mkdir -p $build
if ! cmake --preset asan >$build/configure.log 2>&1; then
  tail -n 25 $build/configure.log >&2
  die "CMake could not configure the fuzzers; run scripts/setup.sh first."
fi
cmake --build --preset asan --target photohull_fuzz --parallel "$jobs" -- --quiet || die "The fuzzers do not build."
fuzzer=$root/$build/tests/fuzz/photohull_fuzz

# run_target NAME: what it found new is kept in corpus/ for the next run.
run_target() {
  local name=$1 found=$build/found corpus=$build/corpus/$1 log=$build/logs/$1
  mkdir -p "$found" "$corpus" $build/logs
  if "$fuzzer" --target="$name" -max_total_time="$seconds" -timeout=5 -malloc_limit_mb=512 \
    -rss_limit_mb=2560 -max_len=4096 -print_final_stats=1 -artifact_prefix="$found/$name-" "$corpus" \
    "tests/fuzz/seeds/$name" >"$log" 2>&1; then
    printf 'ok      %-22s %9s inputs\n' "$name" \
      "$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")"
    return 0
  fi
  { grep -E -A 12 'ERROR|runtime error|what\(\)|Check failed' "$log" || tail -n 20 "$log"; } | head -n 25
  printf 'FAILED  %s: the input is in %s\n' "$name" \
    "$(sed -n 's/.*Test unit written to //p' "$log" | tail -n 1)"
  return 1
}
export -f run_target
export fuzzer seconds build
# Leaks are the sanitized tests' business (tests/lsan.supp): looking for them here takes half the time.
export ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=0 UBSAN_OPTIONS=print_stacktrace=1

[ ${#targets[@]} -gt 0 ] || mapfile -t targets < <("$fuzzer" --list)
say "Fuzzing ${#targets[@]} targets, $seconds s each"
if ! printf '%s\n' "${targets[@]}" | xargs -P "$jobs" -I {} bash -c 'run_target {}'; then
  die "Some targets failed; mend the reader and keep the input in tests/fuzz/seeds/."
fi
