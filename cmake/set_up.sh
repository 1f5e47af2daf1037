# Sourced by run.sh and test.sh: installs packages and builds the release. All chatter goes to stderr.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# install_packages LIST…: what the files name and this machine lacks.
install_packages() {
  local wanted missing=() sudo=""
  wanted=$(cat "$@" | grep -v '^#')
  for package in $wanted; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return
  [ "$(id -u)" -eq 0 ] || sudo="sudo"
  echo "tapstudy: installing ${missing[*]}" >&2
  $sudo apt-get update -q >&2
  $sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "${missing[@]}" >&2
}

build_program() {
  [ -f build/release/build.ninja ] || cmake --preset release -DBUILD_TESTING=OFF >&2
  cmake --build build/release --target tapstudy >&2
}

build_program_and_tests() {
  grep -qs 'BUILD_TESTING:BOOL=ON' build/release/CMakeCache.txt ||
    cmake --preset release -DBUILD_TESTING=ON >&2
  cmake --build build/release >&2
}
