# Sourced by run.sh and test.sh: installs packages and builds the release. All chatter goes to stderr.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

is_installed() { dpkg-query -W -f='${Status}' "$1" 2>/dev/null | grep -q 'ok installed'; }
# Not by a pipe: apt-cache fails if its reader ends at the first match, which pipefail would take for
# a package that the release has not.
is_available() { grep -q '^  Candidate: [^(]' <<<"$(LC_ALL=C apt-cache policy "$1" 2>/dev/null)"; }

# missing_lines LIST…: the lines none of whose alternatives is installed (packages.txt says how they
# are written). packages_to_install LIST…: the first alternative of each that this release has.
missing_lines() {
  local line package
  for line in $(grep -hv '^#' "$@"); do
    for package in ${line//[|?]/ }; do is_installed "$package" && continue 2; done
    echo "$line"
  done
}
packages_to_install() {
  local line package
  for line in $(missing_lines "$@"); do
    for package in ${line//[|?]/ }; do is_available "$package" && echo "$package" && continue 2; done
    [[ $line == *\? ]] || echo "${line%%|*}"  # apt-get says that there is none
  done
}

# install_packages LIST…: what the files name and this machine lacks.
install_packages() {
  local missing packages sudo=""
  missing=$(missing_lines "$@")
  [ -n "$missing" ] || return 0
  [ "$(id -u)" -eq 0 ] || sudo="sudo"
  if grep -qv '?$' <<<"$missing"; then $sudo apt-get update -q >&2; fi
  packages=$(packages_to_install "$@")
  [ -n "$packages" ] || return 0
  echo "tapstudy: installing" $packages >&2
  $sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends $packages >&2
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
