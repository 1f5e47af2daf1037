#!/usr/bin/env bash
# Octave 7.3.0 (Debian 12, octave 7.3.0-2, octave-common 7.3.0-2), files by h5py 3.7.0: load of an
# HDF5 file ends at the first text of variable length, and what comes after it is missing.
#
# Seen: acceleration_m_s2, stimulus and time_s, the second one the text "oak" as h5py writes a str.
# load brings acceleration_m_s2 alone, says "warning: load: error while reading hdf5 item 'stimulus'"
# and goes on as after any warning: try/catch catches nothing and the exit code is 0. Variables are
# read by name, so the same text under the name a_stimulus leaves none of them. With the text as
# numpy.bytes_, of fixed length, all three arrive.
#
# So a file that h5py and R's hdf5r read whole loses whatever sorts after its first label in Octave,
# and a script may go on with a variable of that name from before. For Octave texts are written with
# a fixed length.
. "$(dirname "$0")/support"
unpack octave=7.3.0-2 octave-common=7.3.0-2

cat >write.py <<'PYTHON'
import h5py
import numpy as np

for name, label, text in (("text", "stimulus", "oak"), ("early_text", "a_stimulus", "oak"),
                          ("fixed_text", "stimulus", np.bytes_("oak"))):
    with h5py.File(name + ".h5", "w") as file:
        file["acceleration_m_s2"] = np.arange(3.0)
        file["time_s"] = np.arange(3.0)
        file[label] = text
PYTHON
/usr/bin/python3 write.py  # h5py, and the libraries that Octave needs, are the system's

# What load brings, or "caught" if it throws.
loaded() {
  OCTAVE_HOME=$root/usr LD_LIBRARY_PATH=$libraries/octave/7.3.0 \
    "$root/usr/bin/octave-cli" --norc --quiet --eval "
      try; load('$1.h5'); printf('%s\n', strjoin(who()', ' ')); catch; disp('caught'); end" \
    2>"$1.errors"
}
for file in text early_text fixed_text; do
  loaded $file >$file.loaded
  echo "$file: $(cat $file.loaded)"
done

still "a text of variable length ends what is loaded" [ "$(cat text.loaded)" = acceleration_m_s2 ]
still "an early one leaves nothing" [ -z "$(cat early_text.loaded)" ]
still "that is a warning" grep -q "^warning: load: error while reading hdf5 item 'stimulus'" text.errors
still "texts of fixed length are loaded, and all else" \
  [ "$(cat fixed_text.loaded)" = "acceleration_m_s2 stimulus time_s" ]
