#include "runner/laboratory/trade/rendering_accuracy.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "core/error.hpp"
#include "core/model/progress.hpp"
#include "core/techniques/technique.hpp"
#include "runner/session/stimuli/model_library.hpp"
namespace tapstudy::runner {
using std::numbers::pi;

Eigen::ArrayXd numerical_frequency_hz(const Eigen::ArrayXd& frequency_hz,
                                      core::Integrator integrator, double rate_hz) {
  if (integrator == core::Integrator::exact) {
    return frequency_hz;
  }
  return (pi * frequency_hz / rate_hz).atan() * rate_hz / pi;
}

namespace {
constexpr double close_frequencies = 0.1;
constexpr double half_of_shape = 0.5;

// Column j of `others` that is most like column i, and how much of that shape it and its neighbours
// in frequency hold together.
struct Likeness {
  Eigen::Index most_like{-1};
  double share{};
};
Likeness likeness_of(Eigen::Index i, const Eigen::MatrixXd& assurance,
                     const Eigen::ArrayXd& other_hz) {
  Likeness likeness;
  if (other_hz.size() == 0) {
    return likeness;
  }
  assurance.row(i).maxCoeff(&likeness.most_like);
  const Eigen::ArrayXd away = (other_hz / other_hz[likeness.most_like] - 1.0).abs();
  likeness.share =
      (away <= close_frequencies).select(assurance.row(i).transpose().array(), 0.0).sum();
  return likeness;
}
}  // namespace

ModeMatch match_modes(const SampledModes& reference, const SampledModes& found,
                      double band_limit_hz) {
  const Eigen::MatrixXd assurance =
      (reference.shape.colwise().normalized().transpose() * found.shape.colwise().normalized())
          .cwiseAbs2();
  ModeMatch match;
  for (Eigen::Index i = 0; i < (reference.frequency_hz < band_limit_hz).count(); ++i) {
    const Likeness likeness = likeness_of(i, assurance, found.frequency_hz);
    const bool is_missing = likeness.share < half_of_shape;
    match.missing += is_missing ? 1 : 0;
    const double at_hz = is_missing ? band_limit_hz : found.frequency_hz[likeness.most_like];
    match.frequency_error =
        std::max(match.frequency_error, std::abs(at_hz / reference.frequency_hz[i] - 1.0));
  }
  for (Eigen::Index j = 0; j < (found.frequency_hz < band_limit_hz).count(); ++j) {
    const Likeness likeness = likeness_of(j, assurance.transpose(), reference.frequency_hz);
    match.extra += likeness.share < half_of_shape ? 1 : 0;
  }
  return match;
}

double force_error(const Forces& reference, const Forces& found) {
  return ((found - reference).matrix().colwise().norm().array() /
          reference.matrix().colwise().norm().array())
      .maxCoeff();
}

namespace {
constexpr double lowest_hz = 20.0;
constexpr double felt_share = 1e-3;
constexpr double silence_db = 60.0;

// Phase angles of one bin of the discrete Fourier transform of n samples.
Eigen::ArrayXd angles_of_bin(Eigen::Index k, Eigen::Index n) {
  return 2.0 * pi * static_cast<double>(k) / static_cast<double>(n) *
         Eigen::ArrayXd::LinSpaced(n, 0.0, static_cast<double>(n - 1));
}

// Energy in each third octave, from the discrete Fourier transform.
std::vector<double> third_octaves(const Eigen::ArrayXd& force_n, double rate_hz,
                                  double band_limit_hz) {
  std::vector<double> energy;
  const Eigen::Index n = force_n.size();
  for (double low_hz = lowest_hz; low_hz < band_limit_hz; low_hz *= std::cbrt(2.0)) {
    const double high_hz = std::min(low_hz * std::cbrt(2.0), band_limit_hz);
    double sum = 0.0;
    const auto bin = [&](double hz) {
      return static_cast<Eigen::Index>(std::ceil(hz * static_cast<double>(n) / rate_hz));
    };
    for (Eigen::Index k = bin(low_hz); k < bin(high_hz); ++k) {
      const Eigen::ArrayXd angle = angles_of_bin(k, n);
      sum +=
          std::pow((force_n * angle.cos()).sum(), 2) + std::pow((force_n * angle.sin()).sum(), 2);
    }
    energy.push_back(sum);
  }
  return energy;
}
}  // namespace

double level_error_db(const Forces& reference, const Forces& found, double rate_hz,
                      double band_limit_hz) {
  double worst = 0.0;
  for (Eigen::Index point = 0; point < reference.cols(); ++point) {
    const std::vector<double> expected =
        third_octaves(reference.col(point), rate_hz, band_limit_hz);
    const std::vector<double> got = third_octaves(found.col(point), rate_hz, band_limit_hz);
    const double all = std::accumulate(expected.begin(), expected.end(), 0.0);
    for (std::size_t band = 0; band < expected.size(); ++band) {
      if (expected[band] > felt_share * all) {
        const double db = std::abs(10.0 * std::log10(got[band] / expected[band]));
        worst = std::max(worst, std::min(db, silence_db));
      }
    }
  }
  return worst;
}

namespace {
// Removes frequencies above the band limit, by the discrete Fourier transform.
Forces below(const Forces& forces, double rate_hz, double band_limit_hz) {
  const Eigen::Index n = forces.rows();
  const auto size = static_cast<double>(n);
  Forces kept = Forces::Zero(n, forces.cols());
  for (Eigen::Index k = 0; static_cast<double>(k) * rate_hz / size < band_limit_hz; ++k) {
    const Eigen::ArrayXd angle = angles_of_bin(k, n);
    const Eigen::VectorXd cosine = angle.cos();
    const Eigen::VectorXd sine = angle.sin();
    const double share = (k == 0 ? 1.0 : 2.0) / size;
    kept += (share * (cosine * (cosine.transpose() * forces.matrix()) +
                      sine * (sine.transpose() * forces.matrix())))
                .array();
  }
  return kept;
}
}  // namespace

double decay_error_db(const Forces& reference, const Forces& found, double rate_hz,
                      double band_limit_hz) {
  constexpr double early_s = 0.04;
  constexpr double decayed = 1e-2;
  const auto early = static_cast<Eigen::Index>(std::lround(early_s * rate_hz));
  const auto decay = [&](const Forces& forces) -> Eigen::ArrayXd {
    const Forces felt = below(forces, rate_hz, band_limit_hz);
    const Eigen::ArrayXd ratio = felt.bottomRows(felt.rows() - early).square().colwise().sum() /
                                 felt.topRows(early).square().colwise().sum();
    return ratio.max(decayed);
  };
  const Eigen::ArrayXd db = 10.0 * (decay(found) / decay(reference)).log10().abs();
  return std::min(db.isNaN().select(silence_db, db).maxCoeff(), silence_db);
}

Eigen::ArrayXd held_gain(const Eigen::ArrayXd& frequency_hz, double rate_hz) {
  const Eigen::ArrayXd angle = pi * frequency_hz / rate_hz;
  return (angle.sin() / angle).abs();
}

namespace {
constexpr double above_m = 1e-3;
constexpr double below_m = 1e-6;
constexpr double circle_m = 1e-3;
constexpr std::size_t batches = 15;
constexpr int ticks_a_batch = 1000;

// Measures the plate's vibration, regardless of the stimulus's technique.
// In contact from its second tick on.
core::TapRenderer renderer_of(const core::VibratingPlate& plate, const core::Shape& shape,
                              const core::RenderSettings& settings, const Strike& strike) {
  core::TapRenderer renderer =
      core::make_renderer(plate_alone(), settings, touched_shape(shape), &plate);
  renderer.tick(
      {strike.at_m + core::Vec3{0.0, 0.0, above_m}, core::Vec3{0.0, 0.0, -strike.speed_m_s}});
  return renderer;
}

core::HandState touching(const Strike& strike) {
  return {strike.at_m - core::Vec3{0.0, 0.0, below_m}, {0.0, 0.0, -strike.speed_m_s}};
}
}  // namespace

const core::Technique& plate_alone() {
  static const core::Technique technique{"plate alone", {&core::plate_vibration}};
  return technique;
}

Eigen::ArrayXd felt_force_n(const core::VibratingPlate& plate, const core::Shape& shape,
                            const core::RenderSettings& settings, const Strike& strike,
                            Eigen::Index ticks) {
  core::TapRenderer renderer = renderer_of(plate, shape, settings, strike);
  Eigen::ArrayXd force_n{ticks};
  for (double& value : force_n) {
    const core::RenderedTick tick = renderer.tick(touching(strike));
    if (!tick.contact.touching) {
      throw core::ModelError{"a finger descending on the tapping point misses the body"};
    }
    value = tick.parts.vibration_n;
  }
  return force_n;
}

double tick_ns(const core::VibratingPlate& plate, const core::Shape& shape,
               const core::RenderSettings& settings, const Strike& strike) {
  core::TapRenderer renderer = renderer_of(plate, shape, settings, strike);
  std::array<double, batches> seconds{};
  double angle = 0.0;
  for (double& batch_s : seconds) {
    core::Stopwatch watch;
    for (int tick = 0; tick < ticks_a_batch; ++tick) {
      core::HandState tip = touching(strike);
      tip.position_m.x() += circle_m * std::cos(angle);
      tip.position_m.y() += circle_m * std::sin(angle);
      angle += 1e-2;
      renderer.tick(tip);
    }
    batch_s = watch.lap_s();
  }
  std::ranges::nth_element(seconds, seconds.begin() + batches / 2);
  return 1e9 * seconds.at(batches / 2) / ticks_a_batch;
}
}  // namespace tapstudy::runner
