#!/usr/bin/env bash
# Installs what is missing, builds, and runs every test, as many at once as there are processors.
# Arguments go to the test programs instead, for example `./test.sh "[core]"`.
source "$(dirname "$0")/cmake/set_up.sh"
install_packages packages.txt tests/packages.txt
build_program_and_tests
programs=("$build"/tests/{core,device,protocols,results,analysis,runner,end_to_end}_tests)
if [ $# -eq 0 ]; then
  exec tests/run_in_parallel '' "${programs[@]}"
fi
failed=0
for program in "${programs[@]}"; do
  "$program" --list-tests "$@" | grep '^0 ' >/dev/null ||  # none of its own
    "$program" --order rand --rng-seed time "$@" || failed=1
done
exit $failed
