#!/bin/sh
# Computes the shares of one simulation as a job array of Slurm, a share a task:
#
#   sbatch --array=1-20 slurm_array.sh 20 OUT simulate study.yaml --participants 2000 --no-traces
#   sbatch --array=1-20 slurm_array.sh 20 OUT check study.yaml --simulations 1000
#
# OUT is a directory that all nodes see. A task that was killed left no share: the same line sent
# again computes what is missing, and nothing else. `tapstudy merge OUT/share-* --out WHOLE` (of
# `check`: without --out) puts the shares together, and refuses while one is missing. All tasks need
# the same build of tapstudy, in PATH or named by TAPSTUDY.
#SBATCH --job-name=tapstudy
set -eu
shares=$1
out=$2
shift 2
mkdir -p "$out"
exec "${TAPSTUDY:-tapstudy}" "$@" --share "$SLURM_ARRAY_TASK_ID/$shares" \
  --out "$out/share-$SLURM_ARRAY_TASK_ID"
