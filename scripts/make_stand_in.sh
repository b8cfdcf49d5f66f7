#!/usr/bin/env bash
# Usage: scripts/make_stand_in.sh READER LIBRARY OUT
#
# Makes a shared library in the place of another: with the name of LIBRARY, and with those of its functions that
# READER, a third library, calls. Each of them fails: it returns -1.

set -euo pipefail
[ $# -eq 3 ] || { sed -n '2,5s/^# \{0,1\}//p' "$0" >&2; exit 2; }
reader=$1
library=$2
out=$3
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

nm -D --undefined-only --with-symbol-versions "$reader" | awk '{ print $2 }' | sort >"$scratch/wanted"
nm -D --defined-only --with-symbol-versions "$library" | awk '$2 ~ /[TW]/ { sub("@@", "@", $3); print $3 }' |
  sort | comm -12 - "$scratch/wanted" >"$scratch/symbols"
versions=$(sed -n 's/.*@//p' "$scratch/symbols" | sort -u)
if [ -n "$versions" ]; then echo "$versions { global: *; };" >"$scratch/map"; fi
while IFS=@ read -r symbol _; do
  echo "long $symbol(void) { return -1; }"
done <"$scratch/symbols" >"$scratch/functions.c"
soname=$(objdump -p "$library" | awk '$1 == "SONAME" { print $2 }')
cc -shared -nostdlib -s -O1 -fno-builtin -o "$out" -Wl,-soname,"$soname" -Wl,--build-id=none \
  ${versions:+"-Wl,--version-script=$scratch/map"} "$scratch/functions.c"
