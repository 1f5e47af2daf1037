#!/usr/bin/env bash
# Installs what is missing, builds if needed, and runs `tapstudy ARGS…`; without arguments, the demo:
# the paper's discrimination study with ten simulated participants.
calling_directory=$PWD
source "$(dirname "$0")/cmake/set_up.sh"
root=$PWD
install_packages packages.txt
build_program
tapstudy="$root/$build/tapstudy"

if [ $# -gt 0 ]; then
  cd "$calling_directory"
  exec "$tapstudy" "$@"
fi

study="demo/$(date +%Y-%m-%d_%H-%M-%S)"
while [ -e "$study" ]; do study="$study+"; done
"$tapstudy" simulate protocols/paper/discrimination.yaml --participants 10 --seed 1 --out "$study"
echo
"$tapstudy" report "$study"
