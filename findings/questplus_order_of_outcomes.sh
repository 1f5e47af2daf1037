#!/usr/bin/env bash
# questplus 2019.4 (Debian 12, python3-questplus 2019.4-6): which answer is the right one is decided
# by its place in the list of outcomes, not by its name or number.
#
# Seen: eight answers to a stimulus of -20 dB, each reported to update() as "Correct". With
# outcome_domain {"response": ["Correct", "Incorrect"]} the estimated threshold falls to -30.7 dB and
# the next stimulus is weaker, -30 dB. With ["Incorrect", "Correct"], the same outcomes in the other
# order, it rises to -6.9 dB, and the next stimulus is stronger. Numbers fare no better: in [0, 1] an
# outcome of 1 counts as a miss. There is no warning; the answers are looked up by their names, the
# likelihoods are filled in by place.
#
# So 0 and 1 in ascending order, or answers sorted by name, run the whole track backwards: towards
# stimuli that everybody or nobody perceives, with a posterior that looks as sharp.
. "$(dirname "$0")/support"
unpack python3-questplus=2019.4-6

cat >track.py <<'PYTHON'
import numpy as np
from questplus import QuestPlus

def threshold_after_eight(outcomes, answer):
    track = QuestPlus(stim_domain={"intensity": np.arange(-40.0, 1.0)},
                      param_domain={"threshold": np.arange(-40.0, 1.0), "slope": [3.5],
                                    "lower_asymptote": [0.5], "lapse_rate": [0.02]},
                      outcome_domain={"response": outcomes}, func="weibull", stim_scale="dB",
                      stim_selection_method="min_entropy", param_estimation_method="mean")
    for _ in range(8):
        track.update(stim={"intensity": -20.0}, outcome={"response": answer})
    return track.param_estimate["threshold"], track.next_stim["intensity"]

for outcomes, answer in ((["Correct", "Incorrect"], "Correct"),
                         (["Incorrect", "Correct"], "Correct"), ([0, 1], 1)):
    print(*threshold_after_eight(outcomes, answer))
PYTHON
# xarray and SciPy, which it imports, are the system's.
PYTHONPATH=$root/usr/lib/python3/dist-packages /usr/bin/python3 -W ignore track.py >seen
{ read -r first first_next; read -r second second_next; read -r number number_next; } <seen
echo "threshold and next stimulus: $first, $first_next; $second, $second_next; $number, $number_next"

still "the first of the outcomes is taken to be right" is "$first < -30 and $first_next == -30"
still "in the other order the same answers are misses" is "$second > -7.5 and $second_next == -7"
still "1 of [0, 1] is a miss" [ "$number $number_next" = "$second $second_next" ]
