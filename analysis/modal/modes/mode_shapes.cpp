#include "analysis/modal/modes/mode_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <utility>

#include "core/algebra/lapack.hpp"
namespace tapstudy::analysis {
double modal_assurance(const Eigen::VectorXcd& a, const Eigen::VectorXcd& b) {
  const double norms = a.squaredNorm() * b.squaredNorm();
  return norms > 0.0 ? std::norm(a.dot(b)) / norms : 0.0;
}

namespace {
using Complex = std::complex<double>;
constexpr double farthest_s = 0.006;  // from when the impact was taken to be
constexpr double step_s = 2e-5;
constexpr double unlikely_s = 0.004;  // costs as much as a quarter of all agreement
constexpr int rounds = 4;

// Complex amplitudes at the impact per unit of impulse: a row per tap, a column per mode.
Eigen::MatrixXcd amplitudes_at_impact(const std::vector<Pole>& poles,
                                      const std::vector<PlacedTap>& taps) {
  Eigen::MatrixXcd all(static_cast<Eigen::Index>(taps.size()),
                       static_cast<Eigen::Index>(poles.size()));
  for (std::size_t tap = 0; tap < taps.size(); ++tap) {
    const auto row = static_cast<Eigen::Index>(tap);
    all.row(row) = amplitudes_of(taps[tap].decay, poles).transpose() / taps[tap].impulse;
    for (std::size_t mode = 0; mode < poles.size(); ++mode) {
      const double samples = taps[tap].since_impact_s * taps[tap].decay.rate_hz;
      all(row, static_cast<Eigen::Index>(mode)) *=
          std::exp(-log_of(poles[mode], taps[tap].decay.rate_hz) * samples);
    }
  }
  return all;
}

Eigen::VectorXd damped_rad_per_s(const std::vector<Pole>& poles) {
  constexpr double per_second = 1.0;
  Eigen::VectorXd all(static_cast<Eigen::Index>(poles.size()));
  for (std::size_t i = 0; i < poles.size(); ++i) {
    all[static_cast<Eigen::Index>(i)] = log_of(poles[i], per_second).imag();
  }
  return all;
}

// c^2 / |c|: the phase doubled, which the sign does not change.
Complex doubled(const Complex& c) {
  return std::abs(c) > 0.0 ? c * c / std::abs(c) : Complex{};
}

// A sensor's modes in one phase each, doubled: a row for each sensor.
class Alignment {
 public:
  Alignment(const Eigen::MatrixXcd& amplitudes_at_impact, const std::vector<PlacedTap>& taps,
            Eigen::VectorXd rad_per_s)
      : amplitudes_at_impact_{amplitudes_at_impact}, taps_{taps}, rad_per_s_{std::move(rad_per_s)} {
    Eigen::Index sensors = 0;
    for (const PlacedTap& tap : taps) {
      sensors = std::max(sensors, static_cast<Eigen::Index>(tap.sensor) + 1);
      late_s_[tap.impact] = 0.0;
    }
    phases_ = Eigen::MatrixXcd::Zero(sensors, amplitudes_at_impact.cols());
    const int strongest = strongest_impact();
    add_phases([&](const PlacedTap& tap) { return tap.impact == strongest; });
    for (int round = 0; round < rounds; ++round) {
      for (auto& [impact, late_s] : late_s_) {
        late_s = best_shift(impact);
      }
      phases_.setZero();
      add_phases([](const PlacedTap& /*each*/) { return true; });
    }
  }

  // Positive, or negative where the mode begins the other way round.
  double signed_amplitude(std::size_t tap, Eigen::Index mode) const {
    const Complex here = shifted(tap, mode);
    const Complex whole = std::sqrt(phases_(sensor_of(tap), mode));
    return (here * std::conj(whole)).real() < 0.0 ? -std::abs(here) : std::abs(here);
  }

 private:
  Eigen::Index sensor_of(std::size_t tap) const {
    return static_cast<Eigen::Index>(taps_[tap].sensor);
  }
  // The amplitude if the impact had occurred this much later than assumed.
  Complex shifted_by(std::size_t tap, Eigen::Index mode, double late_s) const {
    return amplitudes_at_impact_(static_cast<Eigen::Index>(tap), mode) *
           std::polar(1.0, rad_per_s_[mode] * late_s);
  }
  Complex shifted(std::size_t tap, Eigen::Index mode) const {
    return shifted_by(tap, mode, late_s_.at(taps_[tap].impact));
  }

  int strongest_impact() const {
    std::map<int, double> sums;
    for (std::size_t tap = 0; tap < taps_.size(); ++tap) {
      sums[taps_[tap].impact] +=
          amplitudes_at_impact_.row(static_cast<Eigen::Index>(tap)).cwiseAbs().sum();
    }
    int strongest = sums.begin()->first;
    for (const auto& [impact, sum] : sums) {
      strongest = sum > sums[strongest] ? impact : strongest;
    }
    return strongest;
  }
  template <class IsCounted>
  void add_phases(IsCounted is_counted) {
    for (std::size_t tap = 0; tap < taps_.size(); ++tap) {
      for (Eigen::Index mode = 0; is_counted(taps_[tap]) && mode < amplitudes_at_impact_.cols();
           ++mode) {
        phases_(sensor_of(tap), mode) += doubled(shifted(tap, mode));
      }
    }
  }

  double agreement(int impact, double late_s) const {
    double sum = 0.0;
    double whole = 0.0;
    for (std::size_t tap = 0; tap < taps_.size(); ++tap) {
      for (Eigen::Index mode = 0;
           taps_[tap].impact == impact && mode < amplitudes_at_impact_.cols(); ++mode) {
        const Complex& phase = phases_(sensor_of(tap), mode);
        const double weight = std::sqrt(std::abs(phase));
        sum += weight * (doubled(shifted_by(tap, mode, late_s)) * std::conj(phase)).real() /
               std::max(std::abs(phase), 1e-300);
        whole += weight * std::abs(amplitudes_at_impact_(static_cast<Eigen::Index>(tap), mode));
      }
    }
    constexpr double quarter = 0.25;
    const double away = late_s / unlikely_s;
    return whole > 0.0 ? sum / whole - quarter * away * away : 0.0;
  }
  double best_shift(int impact) const {
    double best_s = 0.0;
    double most = agreement(impact, 0.0);
    for (double late_s = -farthest_s; late_s <= farthest_s; late_s += step_s) {
      if (const double now = agreement(impact, late_s); now > most) {
        most = now;
        best_s = late_s;
      }
    }
    return best_s;
  }

  const Eigen::MatrixXcd& amplitudes_at_impact_;
  const std::vector<PlacedTap>& taps_;
  Eigen::VectorXd rad_per_s_;
  Eigen::MatrixXcd phases_;
  std::map<int, double> late_s_;  // of each impact
};
}  // namespace

Eigen::VectorXcd amplitudes_of(const FreeDecay& decay, const std::vector<Pole>& poles) {
  const auto modes = static_cast<Eigen::Index>(poles.size());
  Eigen::MatrixXd parts(decay.samples.size(), 2 * modes);
  for (Eigen::Index mode = 0; mode < modes; ++mode) {
    const Complex log_z = log_of(poles[static_cast<std::size_t>(mode)], decay.rate_hz);
    for (Eigen::Index n = 0; n < parts.rows(); ++n) {
      const Complex z = std::exp(static_cast<double>(n) * log_z);
      parts(n, 2 * mode) = z.real();
      parts(n, 2 * mode + 1) = -z.imag();
    }
  }
  const Eigen::VectorXd found = core::least_squares(parts, decay.samples).solution;
  Eigen::VectorXcd amplitudes(modes);
  for (Eigen::Index mode = 0; mode < modes; ++mode) {
    amplitudes[mode] = {found[2 * mode], found[2 * mode + 1]};
  }
  return amplitudes;
}

Eigen::MatrixXd tapped_shapes(const std::vector<Pole>& poles, const std::vector<PlacedTap>& taps,
                              std::size_t places) {
  const Eigen::MatrixXcd all = amplitudes_at_impact(poles, taps);
  const Alignment alignment{all, taps, damped_rad_per_s(poles)};
  std::map<std::size_t, Eigen::MatrixXd> of_sensors;
  std::map<std::size_t, Eigen::VectorXd> counts;
  const auto rows = static_cast<Eigen::Index>(places);
  for (std::size_t tap = 0; tap < taps.size(); ++tap) {
    const auto place = static_cast<Eigen::Index>(taps[tap].place);
    auto& shape = of_sensors.try_emplace(taps[tap].sensor, Eigen::MatrixXd::Zero(rows, all.cols()))
                      .first->second;
    counts.try_emplace(taps[tap].sensor, Eigen::VectorXd::Zero(rows)).first->second[place] += 1.0;
    for (Eigen::Index mode = 0; mode < all.cols(); ++mode) {
      shape(place, mode) += alignment.signed_amplitude(tap, mode);
    }
  }
  Eigen::MatrixXd clearest = Eigen::MatrixXd::Zero(rows, all.cols());
  for (auto& [sensor, shape] : of_sensors) {
    shape.array().colwise() /= counts[sensor].cwiseMax(1.0).array();
    for (Eigen::Index mode = 0; mode < all.cols(); ++mode) {
      if (shape.col(mode).norm() > clearest.col(mode).norm()) {
        clearest.col(mode) = shape.col(mode);
      }
    }
  }
  return clearest;
}
}  // namespace tapstudy::analysis
