# Sourced by the scripts beside it: messages, and packages that install themselves when missing.
# shellcheck shell=bash disable=SC2034
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
jobs=$(nproc 2>/dev/null || echo 2)
interactive=no # may a password be asked for?
if [ -t 0 ]; then interactive=yes; fi

say() { printf '%s\n' "$@"; } # one line an argument

die() {
  printf '\n%s\n' "$*" >&2
  exit 1
}

is_installed() {
  [ "$(dpkg-query --show --showformat='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]
}

# Runs a command as root: directly or through sudo.
as_root() {
  if [ "$(id -u)" -eq 0 ]; then
    "$@"
  elif [ $interactive = yes ]; then
    sudo "$@"
  else
    sudo -n "$@"
  fi
}

can_be_root() {
  [ "$(id -u)" -eq 0 ] || { command -v sudo >/dev/null && as_root true; }
}

# Installs those of the named packages that are not there yet. Needs no network when all are.
install_missing() {
  local package missing=()
  if ! command -v apt-get >/dev/null; then
    say "This system has no apt, so nothing is installed. Needed are the counterparts of these" \
      "Debian packages: $*"
    return 0
  fi
  for package in "$@"; do
    is_installed "$package" || missing+=("$package")
  done
  [ ${#missing[@]} -gt 0 ] || return 0

  can_be_root || die "These packages are missing, and this user may not install them:
  ${missing[*]}
Run the script as root or as a user who may use sudo, or ask an administrator for:
  apt-get install --no-install-recommends ${missing[*]}"
  say "Installing ${#missing[@]} packages: ${missing[*]}"
  local log
  log=$(mktemp)
  if ! apt_get update >"$log" 2>&1; then
    say "The package lists could not be refreshed; trying with those at hand."
  fi
  if ! apt_get install --yes --no-install-recommends "${missing[@]}" >"$log" 2>&1; then
    tail -n 15 "$log" >&2
    die "apt-get could not install them (the whole log: $log).
Check the network and the package sources, then run this script again."
  fi
  rm -f "$log"
}

apt_get() {
  as_root env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=300 -q "$@" </dev/null
}

# The comment at the head of a script is its --help.
print_help() { awk 'NR > 1 && !/^#/ {exit} NR > 1 {sub(/^# ?/, ""); print}' "$1"; }
