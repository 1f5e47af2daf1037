#!/usr/bin/env bash
# libsndfile 1.2.0 (Debian 12, 1.2.0-1+deb12u1): in a MATLAB 5 file it takes the first scalar for the
# rate, whatever its name is, and reads what follows the signal as more of the signal.
#
# Seen: 2000 samples of a 112 Hz tone of amplitude 0.5, sampled at 8000 Hz, saved by SciPy as three
# variables in different orders, all of them valid files. With rate_hz, acceleration: 8000 Hz, 2000
# samples, maximum 0.5. With acceleration, rate_hz: 44 100 Hz, 2009 samples, maximum 8000, since the
# next variable's header and value are read as nine samples. With temperature_c, acceleration,
# rate_hz: 21 Hz, 2009 samples. sndfile-info ends with 0 each time and gives no warning.
#
# So a program that has libsndfile say whether a laboratory's file is sound gets a tone of 617 Hz or
# 0.3 Hz for one of 112, as Octave's and SciPy's users save variables in the order in which they come
# to mind. The subtype SF_FORMAT_MAT5 must be refused, and such files read by what knows variables.
. "$(dirname "$0")/support"
unpack sndfile-programs=1.2.0-1+deb12u1 libsndfile1=1.2.0-1+deb12u1

cat >save.py <<'PYTHON'
import numpy as np
from scipy.io import savemat

variables = {"rate_hz": 8000.0, "temperature_c": 21.0,
             "acceleration": 0.5 * np.sin(2 * np.pi * 112.0 * np.arange(2000) / 8000.0)}
for name, order in (("rate_first", ("rate_hz", "acceleration")),
                    ("signal_first", ("acceleration", "rate_hz")),
                    ("temperature_first", ("temperature_c", "acceleration", "rate_hz"))):
    savemat(name + ".mat", {variable: variables[variable] for variable in order})
PYTHON
/usr/bin/python3 save.py  # SciPy is the system's

# Rate, samples and maximum of one file.
info() {
  with_libraries "$root/usr/bin/sndfile-info" "$1.mat" |
    awk -F ' : ' '/^Sample Rate/ {rate = $2} /^Frames/ {count = $2}
                  /^Signal Max/ {split($2, max, " "); print rate, count, max[1]}'
}
for file in rate_first signal_first temperature_first; do
  echo "$file: $(info $file)"
done

still "a file with its rate first is read as it was saved" [ "$(info rate_first)" = "8000 2000 0.5" ]
still "with its signal first it has 44100 Hz, and the rate is a sample" \
  [ "$(info signal_first)" = "44100 2009 8000" ]
still "a temperature is taken for the rate" [ "$(info temperature_first)" = "21 2009 8000" ]
