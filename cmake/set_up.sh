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

preset=${TAPSTUDY_PRESET:-release}  # of CMakePresets.json; checks build the same with another
build=build/$preset

build_program() {
  [ -f "$build/build.ninja" ] || cmake --preset "$preset" -DBUILD_TESTING=OFF >&2
  cmake --build "$build" --target tapstudy >&2
}

build_program_and_tests() {
  grep -qs 'BUILD_TESTING:BOOL=ON' "$build/CMakeCache.txt" ||
    cmake --preset "$preset" -DBUILD_TESTING=ON >&2
  cmake --build "$build" >&2
}
