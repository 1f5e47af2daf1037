#!/usr/bin/env bash
# psignifit 2.5.6 (Debian 12, psignifit 2.5.6-8+b1, the program of Wichmann and Hill): the fit with a
# free lapse rate can be a second, lower maximum of the likelihood, at half the slope.
#
# Seen: six levels of 40 trials in two-alternative forced choice, a Weibull function, lapse rate
# between 0 and 0.1. psignifit ends without a warning at threshold 2.864, slope 3.505, lapse 0.030.
# Threshold 2.7658, slope 6.5411, lapse 0.0416 is more likely by 0.18 in the logarithm. Both are
# maxima: with the slope held at 4 no threshold and lapse rate are as likely as either. The printed
# deviance and residual correlations look innocent.
#
# So what psignifit calls final is not the fit of greatest likelihood; another program that starts at
# several slopes and lapse rates disagrees with it by a factor of two, and is right.
. "$(dirname "$0")/support"
unpack psignifit=2.5.6-8+b1

cat >answers <<'INPUT'
1 22 40
2 22 40
3 35 40
4 37 40
5 39 40
6 39 40
#shape Weibull
#n_intervals 2
#runs 0
#lambda_limits 0 0.1
INPUT
with_libraries "$root/usr/bin/psignifit" answers >log 2>&1 || { cat log; exit 2; }
grep final log

# The logarithm of the likelihood at psignifit's parameters, at the other maximum, and the greatest
# with slope 4, on a grid.
/usr/bin/python3 - >seen <<'PYTHON'
import math
import re

levels = [(1, 22), (2, 22), (3, 35), (4, 37), (5, 39), (6, 39)]

def log_likelihood(threshold, slope, lapse):
    total = 0.0
    for level, right in levels:
        missed = math.exp(-((level / threshold) ** slope))
        wrong = 0.5 * missed + lapse * (1 - missed)
        total += right * math.log1p(-wrong) + (40 - right) * math.log(wrong)
    return total

final = re.search(r"final: {alpha = (\S+), beta = (\S+), gamma = 0.5, lambda = (\S+)}",
                  open("log").read())
threshold, slope, lapse = map(float, final.groups())
between = max(log_likelihood(2.4 + i / 500, 4, j / 2000) for i in range(401) for j in range(201))
print(slope, log_likelihood(threshold, slope, lapse),
      log_likelihood(2.76580, 6.54111, 0.0416473), between)
PYTHON
read -r slope theirs other between <seen
echo "slope $slope; log likelihood $theirs there, $other at slope 6.54, $between at most at slope 4"
still "psignifit's slope is 3.5" is "abs($slope - 3.505) < 0.01"
still "slope 6.54 is more likely by 0.18" is "0.18 < $other - $theirs < 0.19"
still "both are maxima, with less between them" is "$between < $theirs - 0.005"
