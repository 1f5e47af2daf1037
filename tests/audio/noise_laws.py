"""What masking noise is, whatever played it: laws of samples of one ear, full scale 1."""
import numpy
from scipy.signal import welch

LEVEL_DB = -24.0
RAMP_S = 0.05
TRIALS = 8
MASKING = f"{{kind: white, level_db_fs: {LEVEL_DB + 4}, ramp_s: {RAMP_S}}}"
GAIN_DB = -4


def rms_db(samples):
    return 10 * numpy.log10(numpy.mean(numpy.square(samples)))


def level_db(samples, window):
    """The median over windows: a busy machine may be late with a trial, and the noise ramps down."""
    whole = samples[:len(samples) // window * window].reshape(-1, window)
    return numpy.median([rms_db(part) for part in whole])


def answers():
    """Given at once, they leave hardly any silence between trials."""
    return "".join(f"{1 + trial % 4}\n" for trial in range(TRIALS))


class NoiseLaws:
    """Of a session that was heard: channels and rate_hz, set by hear()."""

    @classmethod
    def hear(cls, channels, rate_hz):
        cls.channels, cls.rate_hz = channels, rate_hz
        sounding = numpy.flatnonzero(channels[0])
        cls.noise = channels[0][sounding[0]:sounding[-1] + 1]
        ramp = int(RAMP_S * rate_hz)
        cls.at_full_level = cls.noise[ramp:-ramp]

    def test_both_ears_hear_the_same_noise(self):
        self.assertTrue((self.channels[0] == self.channels[1]).all())

    def test_its_level_is_the_stated_one_between_the_ramps(self):
        self.assertAlmostEqual(level_db(self.at_full_level, self.rate_hz // 20), LEVEL_DB,
                               delta=0.2)

    def test_it_is_white(self):
        hz, density = welch(self.at_full_level, self.rate_hz, nperseg=2048)
        expected = 10 ** (LEVEL_DB / 10) / (self.rate_hz / 2)
        for centre in 250 * 2.0 ** numpy.arange(7):
            octave = (hz > centre / 2 ** 0.5) & (hz < centre * 2 ** 0.5)
            self.assertAlmostEqual(10 * numpy.log10(density[octave].mean() / expected), 0.0, delta=1.0,
                                   msg=f"octave of {centre} Hz")

    def test_it_rises_and_falls_along_half_a_cosine(self):
        """Half way up the gain is one half; the square of a cosine has its mean about there."""
        middle, width = int(RAMP_S * self.rate_hz / 2), self.rate_hz // 200
        around = slice(middle - width // 2, middle + width // 2)
        for noise in (self.noise, self.noise[::-1]):
            self.assertAlmostEqual(rms_db(noise[around]), LEVEL_DB - 6.0, delta=1.5)
