"""Masking noise of a session as a client of JACK hears it, from a server with the dummy driver."""
import os
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import numpy
from jack_server import RATE_HZ, Recorder, environment_of, running_server, wait_until
from scipy.signal import welch

PROGRAM = os.environ["TAPSTUDY_PROGRAM"]
SOURCE = Path(__file__).resolve().parents[2]
LEVEL_DB = -24.0
RAMP_S = 0.05
TRIALS = 8


def rms_db(samples):
    return 10 * numpy.log10(numpy.mean(numpy.square(samples)))


class JackSession(unittest.TestCase):
    """Answers given at once leave no silence between trials: one ramp up, one down."""
    @classmethod
    def setUpClass(cls):
        cls.directory = Path(tempfile.mkdtemp(prefix="tapstudy_jack_"))
        cls.addClassCleanup(shutil.rmtree, cls.directory)
        cls.server = cls.enterClassContext(running_server())
        cls.channels = cls.hear_a_session()
        sounding = numpy.flatnonzero(cls.channels[0])
        cls.noise = cls.channels[0][sounding[0]:sounding[-1] + 1]
        ramp = int(RAMP_S * RATE_HZ)
        cls.at_full_level = cls.noise[ramp:-ramp]

    @classmethod
    def hear_a_session(cls):
        protocol = cls.directory / "study.yaml"
        protocol.write_text((SOURCE / "protocols/paper/discrimination.yaml").read_text() +
                            f"\nmasking: {{kind: white, level_db_fs: {LEVEL_DB + 4}, ramp_s: {RAMP_S}}}\n")
        rig = cls.directory / "rig.yaml"
        rig.write_text((SOURCE / "protocols/rigs/simulated_hand.yaml").read_text() +
                       '\naudio: {card: "plug:jack", gain_db: -4}\n')

        recording = Recorder.of(cls.server)
        session = subprocess.Popen(
            [PROGRAM, "run", protocol, "--rig", rig, "--participant", "P01", "--seed", "5", "--out",
             cls.directory / "study"],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
            env=environment_of(cls.server))
        wait_until("the program's outputs", recording.connect)
        said, _ = session.communicate("".join(f"{1 + trial % 4}\n" for trial in range(TRIALS)), timeout=60)
        assert session.returncode == 0, said
        assert "not played" not in said, said
        time.sleep(0.2)
        return recording.heard()

    def test_both_ears_hear_the_same_noise_and_then_silence(self):
        self.assertTrue((self.channels[0] == self.channels[1]).all())
        self.assertTrue((self.channels[0][-RATE_HZ // 10:] == 0).all())

    def test_its_level_is_the_stated_one_between_the_ramps(self):
        self.assertAlmostEqual(rms_db(self.at_full_level), LEVEL_DB, delta=0.2)

    def test_it_is_white(self):
        hz, density = welch(self.at_full_level, RATE_HZ, nperseg=2048)
        expected = 10 ** (LEVEL_DB / 10) / (RATE_HZ / 2)
        for centre in 250 * 2.0 ** numpy.arange(7):
            octave = (hz > centre / 2 ** 0.5) & (hz < centre * 2 ** 0.5)
            self.assertAlmostEqual(10 * numpy.log10(density[octave].mean() / expected), 0.0, delta=1.0,
                                   msg=f"octave of {centre} Hz")

    def test_it_rises_and_falls_along_half_a_cosine(self):
        """Half way up the gain is one half; the square of a cosine has its mean about there."""
        middle, width = int(RAMP_S * RATE_HZ / 2), RATE_HZ // 200
        around = slice(middle - width // 2, middle + width // 2)
        for noise in (self.noise, self.noise[::-1]):
            self.assertAlmostEqual(rms_db(noise[around]), LEVEL_DB - 6.0, delta=1.5)


class StarvedCard(unittest.TestCase):
    STALL_S = 0.4  # as in stalling_player
    BUFFER_S = 0.08

    @classmethod
    def setUpClass(cls):
        with running_server() as server:
            recording = Recorder.of(server)
            player = subprocess.Popen([os.environ["TAPSTUDY_STALLING_PLAYER"], "plug:jack"],
                                      stdout=subprocess.PIPE, text=True, env=environment_of(server))
            wait_until("the player's outputs", recording.connect)
            cls.counted = int(player.communicate(timeout=60)[0])
            level = recording.heard()[0]
        sounding = numpy.flatnonzero(level)
        silent = numpy.concatenate(([0], level[sounding[0]:sounding[-1]] == 0, [0]))
        begins, ends = (numpy.flatnonzero(numpy.diff(silent) == step) for step in (1, -1))
        cls.gaps_s = (ends - begins) / RATE_HZ

    def test_as_many_underruns_are_counted_as_gaps_are_heard(self):
        self.assertGreaterEqual(self.counted, 3)
        self.assertEqual(self.counted, len(self.gaps_s))

    def test_a_gap_lasts_what_the_stall_exceeds_the_buffer_by(self):
        for gap_s in sorted(self.gaps_s)[-3:]:
            self.assertAlmostEqual(gap_s, self.STALL_S - self.BUFFER_S, delta=0.05)


if __name__ == "__main__":
    unittest.main(argv=sys.argv, verbosity=2)
