# Sourced by run.sh and test.sh: installs what packages.txt lists and builds the release.
# All chatter goes to stderr.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

install_packages() {
  local wanted missing=() sudo=""
  wanted=$(grep -v '^#' packages.txt)
  for package in $wanted; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return
  [ "$(id -u)" -eq 0 ] || sudo="sudo"
  echo "tapstudy: installing ${missing[*]}" >&2
  $sudo apt-get update -q >&2
  $sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "${missing[@]}" >&2
}

# build PRESET [TARGET]
build() {
  if [ ! -f "build/$1/build.ninja" ]; then
    cmake --preset "$1" >&2
  fi
  cmake --build "build/$1" --target "${2:-all}" >&2
}
