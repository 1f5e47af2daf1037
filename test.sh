#!/usr/bin/env bash
# Installs what is missing, builds, and runs every test. Arguments go to the test program, for
# example `./test.sh "[core]"`.
source "$(dirname "$0")/cmake/set_up.sh"
install_packages
build release
exec build/release/tests/tapstudy_tests --order rand --rng-seed time --use-colour no "$@"
