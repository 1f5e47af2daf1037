"""Masking noise of a session as a client of JACK hears it, from a server with the dummy driver."""
import os
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import jack
import numpy
from scipy.signal import welch

PROGRAM = os.environ["TAPSTUDY_PROGRAM"]
SOURCE = Path(__file__).resolve().parents[2]
RATE_HZ = 48000
LEVEL_DB = -24.0
RAMP_S = 0.05
TRIALS = 8


def wait_until(what, condition, patience_s=20):
    end = time.monotonic() + patience_s
    while not (result := condition()):
        assert time.monotonic() < end, f"waited {patience_s} s for {what}"
        time.sleep(0.01)
    return result


def rms_db(samples):
    return 10 * numpy.log10(numpy.mean(numpy.square(samples)))


class Recorder:
    """Records every audio output that appears, one channel each."""

    def __init__(self, server):
        self.client = jack.Client("recorder", no_start_server=True, servername=server)
        self.ports = [self.client.inports.register(f"in_{channel}") for channel in range(2)]
        self.blocks = []
        self.client.set_process_callback(
            lambda frames: self.blocks.append(numpy.array([port.get_array() for port in self.ports])))
        self.client.activate()

    def connect(self):
        outputs = self.client.get_ports(name_pattern="^tapstudy", is_audio=True, is_output=True)
        if len(outputs) < len(self.ports):
            return False
        try:
            for output, port in zip(outputs, self.ports):
                if not port.connections:
                    self.client.connect(output, port)
        except jack.JackError:  # a port is named before its client is activated
            return False
        return True

    def heard(self):
        self.client.close()
        return numpy.concatenate(self.blocks, axis=1)


class JackSession(unittest.TestCase):
    """Answers given at once leave no silence between trials: one ramp up, one down."""
    @classmethod
    def setUpClass(cls):
        cls.directory = Path(tempfile.mkdtemp(prefix="tapstudy_jack_"))
        cls.addClassCleanup(shutil.rmtree, cls.directory)
        cls.server = f"tapstudy_{os.getpid()}"
        daemon = subprocess.Popen(
            ["/usr/bin/jackd", "--no-realtime", "--name", cls.server, "-d", "dummy", "-r", str(RATE_HZ), "-p", "256"],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        cls.addClassCleanup(daemon.wait)
        cls.addClassCleanup(daemon.terminate)
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

        def recorder():
            try:
                return Recorder(cls.server)
            except jack.JackError:
                return None
        recording = wait_until("the server", recorder)
        session = subprocess.Popen(
            [PROGRAM, "run", protocol, "--rig", rig, "--participant", "P01", "--seed", "5", "--out",
             cls.directory / "study"],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
            env={**os.environ, "JACK_DEFAULT_SERVER": cls.server, "JACK_NO_START_SERVER": "1"})
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


if __name__ == "__main__":
    unittest.main(argv=sys.argv, verbosity=2)
