#!/usr/bin/env bash
# Installs what is missing, builds, and runs every test, as many at once as there are processors.
# Arguments go to the test program instead, for example `./test.sh "[core]"`.
source "$(dirname "$0")/cmake/set_up.sh"
install_packages packages.txt tests/packages.txt
build_program_and_tests
tests=$build/tests/tapstudy_tests
if [ $# -gt 0 ]; then
  exec "$tests" --order rand --rng-seed time "$@"
fi
exec tests/run_in_parallel "$tests"
