#include "runner/accuracy/errors.hpp"

#include "support/catch.hpp"

using namespace tapstudy;
using namespace tapstudy::runner;

namespace {
// Of a string fixed at both ends: sines.
SampledModes string_modes(const Eigen::ArrayXd& frequency_hz) {
  SampledModes modes{frequency_hz, Eigen::MatrixXd{60, frequency_hz.size()}};
  for (Eigen::Index i = 0; i < 60; ++i) {
    for (Eigen::Index mode = 0; mode < frequency_hz.size(); ++mode) {
      modes.shape(i, mode) =
          std::sin(M_PI * (static_cast<double>(i) + 0.5) / 60.0 * static_cast<double>(mode + 1));
    }
  }
  return modes;
}
SampledModes without_mode(const SampledModes& modes, Eigen::Index lost) {
  const Eigen::Index rest = modes.frequency_hz.size() - lost - 1;
  SampledModes fewer{Eigen::ArrayXd{lost + rest}, Eigen::MatrixXd{60, lost + rest}};
  fewer.frequency_hz << modes.frequency_hz.head(lost), modes.frequency_hz.tail(rest);
  fewer.shape << modes.shape.leftCols(lost), modes.shape.rightCols(rest);
  return fewer;
}
}  // namespace

TEST_CASE("a mode that rings where it should has no frequency error", "[runner][trade]") {
  const SampledModes modes = string_modes(Eigen::ArrayXd::LinSpaced(4, 50.0, 200.0));
  SampledModes sharper = modes;
  sharper.frequency_hz *= 1.1;
  CHECK(match_modes(modes, modes, 250.0).frequency_error == 0.0);
  CHECK(match_modes(modes, sharper, 250.0).frequency_error == Approx(0.1));
  CHECK((numerical_frequency_hz(modes.frequency_hz, core::Integrator::exact, 1000.0) ==
         modes.frequency_hz)
            .all());
}

TEST_CASE("a lost mode is missed, not taken for its neighbour of another shape",
          "[runner][trade]") {
  const SampledModes modes = string_modes(Eigen::ArrayXd::LinSpaced(4, 100.0, 130.0));
  const ModeMatch lost = match_modes(modes, without_mode(modes, 1), 200.0);
  CHECK(lost.missing == 1);
  CHECK(lost.extra == 0);
  CHECK(lost.frequency_error == Approx(200.0 / 110.0 - 1.0));
  const ModeMatch added = match_modes(without_mode(modes, 1), modes, 200.0);
  CHECK(added.missing == 0);
  CHECK(added.extra == 1);
  CHECK(added.frequency_error == 0.0);
}

TEST_CASE("any two mixtures of a double mode are that double mode", "[runner][trade]") {
  const SampledModes modes = string_modes(Eigen::Array3d{80.0, 100.0, 100.0});
  const double angle = GENERATE(0.0, 0.3, M_PI / 4.0, 1.2);
  SampledModes mixed = modes;
  mixed.shape.col(1) = std::cos(angle) * modes.shape.col(1) + std::sin(angle) * modes.shape.col(2);
  mixed.shape.col(2) = std::cos(angle) * modes.shape.col(2) - std::sin(angle) * modes.shape.col(1);
  const ModeMatch match = match_modes(modes, mixed, 200.0);
  CHECK(match.missing == 0);
  CHECK(match.extra == 0);
  CHECK(match.frequency_error == 0.0);
}

TEST_CASE("twice the decay rate is a decay error of its own, whatever the level",
          "[runner][trade]") {
  const auto ring = [](double amplitude, double decay_per_s) {
    const Eigen::ArrayXd t_s = Eigen::ArrayXd::LinSpaced(300, 0.0, 0.299);
    return Forces{amplitude * (-decay_per_s * t_s).exp() * (2.0 * M_PI * 100.0 * t_s).sin()};
  };
  CHECK(decay_error_db(ring(1.0, 20.0), ring(0.5, 20.0), 1000.0, 400.0) ==
        Approx(0.0).margin(1e-9));
  // energy after t_e beside the energy before: e^-2at_e / (1 - e^-2at_e), to the record's end
  const auto late_db = [](double a) {
    const double at_40ms = std::exp(-2.0 * a * 0.04);
    return 10.0 * std::log10((at_40ms - std::exp(-2.0 * a * 0.3)) / (1.0 - at_40ms));
  };
  CHECK(decay_error_db(ring(1.0, 20.0), ring(1.0, 40.0), 1000.0, 400.0) ==
        Approx(late_db(20.0) - late_db(40.0)).epsilon(0.02));
  // what lies beyond the band is not judged, nor what has gone
  CHECK(decay_error_db(ring(1.0, 20.0), ring(1.0, 40.0), 1000.0, 50.0) < 4.0);
  CHECK(decay_error_db(ring(1.0, 120.0), ring(1.0, 200.0), 1000.0, 400.0) < 1.0);
  CHECK(decay_error_db(ring(1.0, 20.0), Forces::Zero(300, 1), 1000.0, 400.0) == 60.0);
}

TEST_CASE("Newmark rings at the frequency that its own zero crossings show", "[runner][trade]") {
  constexpr double dt_s = 1e-3;
  for (const double hz : {30.0, 100.0, 300.0}) {
    CAPTURE(hz);
    const core::StateTransition step = core::newmark_transition(2.0 * M_PI * hz, 0.0, dt_s);
    double displacement = 0.0;
    double velocity = 1.0;
    int crossings = 0;
    constexpr int ticks = 200'000;
    for (int tick = 0; tick < ticks; ++tick) {
      const double before = displacement;
      displacement = step.qq * before + step.qv * velocity;
      velocity = step.vq * before + step.vv * velocity;
      crossings += before * displacement < 0.0 ? 1 : 0;
    }
    const Eigen::ArrayXd told = numerical_frequency_hz(Eigen::ArrayXd::Constant(1, hz),
                                                       core::Integrator::newmark, 1.0 / dt_s);
    CHECK(told[0] == Approx(0.5 * crossings / (ticks * dt_s)).epsilon(1e-3));
  }
}

TEST_CASE("a mode lost beyond the band is at least as wrong as the band's edge",
          "[runner][trade]") {
  const SampledModes reference = string_modes(Eigen::Array2d{100.0, 200.0});
  const SampledModes found = without_mode(reference, 1);
  CHECK(match_modes(reference, found, 300.0).frequency_error == Approx(0.5));
  // what the reference has beyond the band is not asked for
  CHECK(match_modes(reference, found, 150.0).frequency_error == 0.0);
  CHECK(match_modes(reference, found, 150.0).missing == 0);
}

TEST_CASE("the level of twice the force is 6.02 dB off", "[runner][trade]") {
  const Forces forces = Forces::Random(300, 3);
  const auto error_db = [&](const Forces& found) {
    return level_error_db(forces, found, 1000.0, 400.0);
  };
  CHECK(error_db(forces) == 0.0);
  CHECK(error_db(2.0 * forces) == Approx(6.0206).epsilon(1e-4));
  CHECK(error_db(-forces) == 0.0);
  CHECK(force_error(forces, -forces) == Approx(2.0));
}

TEST_CASE("a third octave that is lost or too loud is not made good by the others",
          "[runner][trade]") {
  const auto tone = [](double hz, double amplitude) {
    Forces force{300, 1};
    for (Eigen::Index i = 0; i < 300; ++i) {
      force(i, 0) = amplitude * std::sin(2.0 * M_PI * hz * static_cast<double>(i) / 1000.0);
    }
    return force;
  };
  const Forces both = tone(100.0, 1.0) + tone(200.0, 1.0);
  const auto error_db = [&](const Forces& found, double band_hz) {
    return level_error_db(both, found, 1000.0, band_hz);
  };
  CHECK(error_db(tone(100.0, std::sqrt(2.0)), 400.0) == 60.0);  // as loud as both
  CHECK(error_db(tone(100.0, 1.0), 150.0) == Approx(0.0).margin(1e-6));
  CHECK(error_db(tone(100.0, 1.0) + tone(200.0, 0.5), 400.0) == Approx(6.0206).epsilon(1e-3));
}

TEST_CASE("one tapping point out of many decides the error", "[runner][trade]") {
  const Forces reference = Forces::Ones(10, 3);
  Forces found = reference;
  found.col(1) *= 1.25;
  CHECK(force_error(reference, found) == Approx(0.25));
}

TEST_CASE("a held output keeps slow vibration and loses that at the rate", "[runner][trade]") {
  const Eigen::ArrayXd hz = Eigen::Array3d{1e-3, 500.0, 1000.0};
  const Eigen::ArrayXd gain = held_gain(hz, 1000.0);
  CHECK(gain[0] == Approx(1.0));
  CHECK(gain[1] == Approx(2.0 / M_PI));
  CHECK(gain[2] == Approx(0.0).margin(1e-15));
}
