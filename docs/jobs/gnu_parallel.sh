#!/bin/sh
# Computes the shares of one simulation by GNU parallel, one at a time on each machine, since each
# keeps all processors of its machine busy:
#
#   PARALLEL="--sshlogin one,two,three --workdir ." \
#     ./gnu_parallel.sh 20 OUT simulate study.yaml --participants 2000 --no-traces
#   ./gnu_parallel.sh 20 OUT check study.yaml --simulations 1000
#
# OUT is a directory that all machines see. A share that was killed is run again, up to three times;
# so it is when the same line is given once more, which computes nothing else. `tapstudy merge
# OUT/share-* --out WHOLE` (of `check`: without --out) puts the shares together, and refuses while
# one is missing. All machines need the same build of tapstudy, in PATH or named by TAPSTUDY.
set -eu
shares=$1
out=$2
shift 2
mkdir -p "$out"
seq "$shares" | parallel --jobs 1 --retries 3 --quote "${TAPSTUDY:-tapstudy}" "$@" \
  --share "{}/$shares" --out "$out/share-{}"
