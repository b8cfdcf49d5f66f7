#!/usr/bin/env bash
# Usage: scripts/bundle.sh [--out FILE] [--level N] [--no-build]
#
# Packs photohull into one archive that runs from any folder, without root and without any package:
# programs, manual, the demo's photographs, all libraries but the C library's, and Mesa's software
# renderer, which is taken where the system has no Mesa of its own. Drivers of a GPU are the
# system's. The archive runs where the C library is glibc 2.35 or newer (Ubuntu 22.04, Debian 12).
#
#   --out FILE   default: photohull-VERSION-linux-MACHINE.tar.xz
#   --level N    of xz, 0 to 9 (default); 0 is for tests
#   --no-build   take build/release as it is, and install nothing
#   --help       print this text
#
# In it, bin/photohull starts the program. PHOTOHULL_EGL=bundled has it take the archive's renderer alone,
# PHOTOHULL_EGL=system the system's drivers alone.

# shellcheck source=scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

cd "$root"
machine=$(uname -m)
version=$(sed -n 's/^project(photohull VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
name=photohull-$version-linux-$machine
out=$name.tar.xz
level=9
build=yes
while [ $# -gt 0 ]; do
  case $1 in
    --out | --level)
      [ $# -ge 2 ] || die "$1 needs a value. See scripts/bundle.sh --help."
      if [ "$1" = --out ]; then out=$2; else level=$2; fi
      shift
      ;;
    --no-build) build=no ;;
    -h | --help)
      print_help "${BASH_SOURCE[0]}"
      exit 0
      ;;
    *) die "Unknown option '$1'. See scripts/bundle.sh --help." ;;
  esac
  shift
done
[[ $level =~ ^[0-9]$ ]] || die "--level $level: give a number from 0 to 9."
[ -d "$(dirname "$out")" ] || die "--out $out: there is no folder $(dirname "$out")."

if [ $build = yes ]; then
  install_missing patchelf xz-utils binutils gcc
  scripts/setup.sh --target installed
fi
for tool in patchelf xz objdump cc ldd python3; do
  command -v $tool >/dev/null || die "$tool is missing; run scripts/bundle.sh without --no-build."
done
[ -x build/release/photohull-lab ] || die "build/release has no photohull-lab; run scripts/setup.sh first."

scratch=$(mktemp -d)
trap 'rm -rf "$scratch" "$out.part"' EXIT
top=$scratch/$name
lib=$top/lib
notes=$top/share/doc/bundled

# The C library's own, which every system has, and which must be the system's.
is_system_library() { [[ $1 =~ ^(ld-linux|lib(c|m|mvec|dl|pthread|rt|resolv|util|anl|nss_[a-z]*)\.so) ]]; }

# "SONAME PATH" of all libraries that the files need.
libraries_of() {
  ldd "$@" | awk '$2 == "=>" && $3 ~ /^\// { print $1, $3 }' | sort -u |
    while read -r soname path; do is_system_library "$soname" || echo "$soname $path"; done
}

# find_library NAME: its path, as the linker finds it.
find_library() {
  local path
  path=$(ldconfig -p | awk -v name="$1" '$1 == name { print $NF; exit }')
  [ -n "$path" ] || die "$1 is missing on this machine; run scripts/setup.sh first."
  echo "$path"
}

# take PATH FILE: copies a library, and notes its Debian package.
take() {
  install -m 644 "$1" "$2"
  readlink -f "$1" >>"$scratch/sources"
}

say "Collecting files"
umask 022
mkdir -p "$lib/mesa/dri" "$lib/gcc" "$notes"
cmake --install build/release --component photohull --prefix "$top" --strip >"$scratch/log" || die "$(tail "$scratch/log")"
mv "$top/bin" "$top/libexec"
mkdir "$top/bin"
# The stand-ins (cmake/StandIns.cmake).
mv "$lib"/photohull/* "$lib"
rmdir "$lib/photohull"

# What the programs need, but for what only the libraries behind those stand-ins need: by their NEEDED entries, from the
# programs on.
declare -A seen=()
waiting=("$top"/libexec/photohull*)
while [ ${#waiting[@]} -gt 0 ]; do
  file=${waiting[0]}
  waiting=("${waiting[@]:1}")
  for soname in $(objdump -p "$file" | awk '$1 == "NEEDED" { print $2 }'); do
    if is_system_library "$soname" || [ -n "${seen[$soname]-}" ]; then continue; fi
    seen[$soname]=yes
    path=$(find_library "$soname")
    case $soname in
      libstdc++.so.6 | libgcc_s.so.1) take "$path" "$lib/gcc/$soname" ;;
      *)
        if [ -e "$lib/$soname" ]; then continue; fi
        take "$path" "$lib/$soname"
        ;;
    esac
    waiting+=("$path")
  done
done

# Mesa: its vendor library under a name of its own, so that a Mesa of the system is found by the usual one.
mesa=$(find_library libEGL_mesa.so.0)
driver=$(dirname "$mesa")/dri/swrast_dri.so
[ -e "$driver" ] || die "$driver is missing: install libgl1-mesa-dri."
take "$mesa" "$lib/mesa/libEGL_photohull.so.0"
patchelf --set-soname libEGL_photohull.so.0 "$lib/mesa/libEGL_photohull.so.0"
take "$driver" "$lib/mesa/dri/swrast_dri.so"
libraries_of "$mesa" "$driver" >"$scratch/needed"
while read -r soname path; do
  if [ ! -e "$lib/$soname" ] && [ ! -e "$lib/gcc/$soname" ]; then take "$path" "$lib/mesa/$soname"; fi
done <"$scratch/needed"
cat >"$lib/mesa/egl_vendor.json" <<'TEXT'
{
    "file_format_version" : "1.0.0",
    "ICD" : {
        "library_path" : "libEGL_photohull.so.0"
    }
}
TEXT

# Each file finds those beside it, wherever the folder lies; nothing of that holds for the system's
# drivers, as an RPATH would.
patchelf --set-rpath "\$ORIGIN/../lib" "$top"/libexec/*
patchelf --set-rpath "\$ORIGIN" "$lib"/*.so*
patchelf --set-rpath "\$ORIGIN:\$ORIGIN/mesa" "$lib/libEGL.so.1"
patchelf --set-rpath "\$ORIGIN:\$ORIGIN/.." "$lib"/mesa/*.so*
patchelf --set-rpath "\$ORIGIN/..:\$ORIGIN/../.." "$lib"/mesa/dri/*.so

# Debian 12's libraries take random numbers from functions that glibc has from 2.36 on. Where it is older,
# they find them in a library of ours.
newer_symbols() { objdump -T "$1" | sed -n 's/.*(\{0,1\}GLIBC_2\.\(3[6-9]\|[4-9][0-9]\))\{0,1\} *//p'; }
cat >"$scratch/random.c" <<'TEXT'
#include <errno.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <sys/random.h>

void arc4random_buf(void* to, size_t bytes) {
  for (unsigned char* at = to; bytes > 0;) {
    const ssize_t got = getrandom(at, bytes, 0);
    if (got < 0 && errno != EINTR) abort();
    if (got > 0) at += got, bytes -= (size_t)got;
  }
}

uint32_t arc4random(void) {
  uint32_t number;
  arc4random_buf(&number, sizeof number);
  return number;
}
TEXT
cc -shared -fPIC -s -O1 -o "$lib/libphotohull_random.so" -Wl,-soname,libphotohull_random.so -Wl,--build-id=none "$scratch/random.c"
for file in "$top"/libexec/* "$lib"/*.so* "$lib"/*/*.so* "$lib"/mesa/dri/*.so; do
  symbols=$(newer_symbols "$file")
  [ -n "$symbols" ] || continue
  other=$(grep -vxE 'arc4random(_buf)?' <<<"$symbols" || true)
  [ -z "$other" ] || die "$(basename "$file") needs a C library newer than glibc 2.35 for $other; the archive would not run on Ubuntu 22.04."
  patchelf --add-needed libphotohull_random.so "$file"
  scripts/replace_version.py GLIBC_2.36 "$file"
done
patchelf --set-rpath "\$ORIGIN/.." "$lib"/gcc/*.so*

# The number at the end of libstdc++.so.6.0.30 tells which of two is newer.
ours=$(basename "$(readlink -f "$(find_library libstdc++.so.6)")")
cat >"$top/bin/photohull" <<TEXT
#!/bin/sh
# Starts photohull from the folder above this one, wherever that lies.
set -eu
here=\$(cd "\$(dirname "\$(readlink -f "\$0")")/.." && pwd)
machine=$machine
ours=${ours##*.}
TEXT
cat >>"$top/bin/photohull" <<'TEXT'

# Drivers of a GPU want a C++ library that is at least as new as the system's.
newest=-1
for file in "/usr/lib/$machine-linux-gnu" /usr/lib64 "/lib/$machine-linux-gnu" /lib64 /usr/lib /lib; do
  [ -e "$file/libstdc++.so.6" ] || continue
  file=$(readlink -f "$file/libstdc++.so.6")
  newest=${file##*.}
  break
done
case $newest in *[!0-9]* | '') newest=-1 ;; esac
if [ "$newest" -lt "$ours" ]; then
  export LD_LIBRARY_PATH="$here/lib/gcc${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"
fi

# Drivers of the system, and the renderer of this folder where none of them is Mesa's.
if [ -z "${__EGL_VENDOR_LIBRARY_FILENAMES-}${__EGL_VENDOR_LIBRARY_DIRS-}" ]; then
  vendors=
  mesa=no
  for file in /etc/glvnd/egl_vendor.d/*.json /usr/share/glvnd/egl_vendor.d/*.json; do
    [ -e "$file" ] || continue
    vendors=$vendors$file:
    if grep -q libEGL_mesa "$file"; then mesa=yes; fi
  done
  case ${PHOTOHULL_EGL-} in
    bundled) vendors= mesa=no ;;
    system) mesa=yes ;;
  esac
  if [ $mesa = no ]; then
    export __EGL_VENDOR_LIBRARY_FILENAMES="$vendors$here/lib/mesa/egl_vendor.json"
    export LIBGL_DRIVERS_PATH="$here/lib/mesa/dri"
  fi
fi
exec "$here/libexec/photohull" "$@"
TEXT
chmod 755 "$top/bin/photohull"
ln -s bin/photohull "$top/photohull"

# Licences: of every package, what Debian says of it.
sort -u "$scratch/sources" | while read -r path; do
  package=$(dpkg -S "$path" 2>/dev/null || dpkg -S "${path#/usr}") || die "$path belongs to no package, so its licence is not known."
  echo "${package%%:*}"
done | sort -u >"$scratch/packages"
while read -r package; do
  [ -e "/usr/share/doc/$package/copyright" ] || die "/usr/share/doc/$package/copyright is missing."
  install -D -m 644 "/usr/share/doc/$package/copyright" "$notes/$package/copyright"
  # shellcheck disable=SC2016
  dpkg-query --show --showformat='${Package} ${Version} (source ${source:Package} ${source:Version})\n' "$package" | sort -u | head -n 1
done <"$scratch/packages" >"$notes/packages.txt"
cat >"$notes/README.txt" <<'TEXT'
The libraries in lib/ are copies of those of Debian's packages that packages.txt lists, with another path to
look for libraries in. Their licences lie beside this file; their sources are at https://snapshot.debian.org.
TEXT
cat >"$top/README.txt" <<TEXT
photohull $version turns photographs into a solid 3D model. Nothing has to be installed: this folder may lie anywhere.

    ./photohull demo --out temple      reconstructs a temple from 16 photographs, in half a minute
    ./photohull doctor                 tells of this machine what a report of a fault needs, and tests it
    ./photohull --help                 lists the commands

share/doc/photohull has the manual, share/doc/bundled the licences of the libraries in lib.
A GPU is used where the system has a driver for it (EGL, OpenGL 4.5); else Mesa's software renderer does the work.
PHOTOHULL_EGL=bundled takes the renderer of this folder in any case, PHOTOHULL_EGL=system never.
TEXT

threads=1 # one block packs best
[ "$level" -ge 6 ] || threads=0
say "Packing $(du -sm "$top" | cut -f 1) MiB with xz -$level"
when=$(git log -1 --format=%ct 2>/dev/null || echo 0)
tar --create --sort=name --mtime="@${SOURCE_DATE_EPOCH:-$when}" --owner=0 --group=0 --numeric-owner \
  --format=gnu -C "$scratch" "$name" |
  xz --threads="$threads" --x86 --lzma2="preset=$level$([ "$level" -lt 9 ] || echo ,dict=128MiB)" >"$out.part"
mv "$out.part" "$out"
say "Ready: $out, $(($(stat -c %s "$out") / 1000000)) MB"
