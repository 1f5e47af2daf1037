#include "analysis/modal_identification/neighbouring_modes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "analysis/statistics/quantiles.hpp"
namespace tapstudy::analysis {
namespace {
constexpr double max_ratio_factor = 5.0;

double median_of(const std::vector<std::vector<Pole>>& sets, std::size_t k, double Pole::*part) {
  std::vector<double> values;
  for (const std::vector<Pole>& poles : sets) {
    values.push_back(poles[k].*part);
  }
  return quantile(values, 0.5);
}
}  // namespace

bool Neighbours::may_hold(const Pole& pole) const {
  return range.holds(pole.frequency_hz) && pole.damping_ratio > least_ratio / max_ratio_factor &&
         pole.damping_ratio < greatest_ratio * max_ratio_factor;
}

std::vector<Neighbours> neighbours_among(const std::vector<RepeatedMode>& modes) {
  std::vector<Neighbours> all;
  for (const RepeatedMode& mode : modes) {
    const double ratio = mode.damping_ratio.value;
    if (mode.standing == Standing::line || ratio <= 0.0) {
      continue;
    }
    const std::size_t agreed = mode.standing == Standing::agreed ? 1 : 0;
    const double frequency_hz = mode.frequency_hz.value;
    const double bandwidth_hz = 2.0 * ratio * frequency_hz;
    const Band range{frequency_hz - bandwidth_hz, frequency_hz + bandwidth_hz};
    if (all.empty() || all.back().range.high_hz < range.low_hz) {
      all.push_back({range, agreed, ratio, ratio});
      continue;
    }
    Neighbours& last = all.back();
    last.agreed += agreed;
    last.range.high_hz = std::max(last.range.high_hz, range.high_hz);
    last.least_ratio = std::min(last.least_ratio, ratio);
    last.greatest_ratio = std::max(last.greatest_ratio, ratio);
  }
  return all;
}

std::vector<Pole> poles_by_all(const MatrixPencil& pencil, const Neighbours& neighbours) {
  std::map<std::size_t, std::vector<std::vector<Pole>>> by_count;
  for (const PolesOfOrder& order : pencil.orders) {
    std::vector<Pole> poles;
    std::ranges::copy_if(order.poles, std::back_inserter(poles),
                         [&](const Pole& pole) { return neighbours.may_hold(pole); });
    if (poles.size() >= std::max<std::size_t>(2, neighbours.agreed)) {
      by_count[poles.size()].push_back(std::move(poles));
    }
  }
  const auto most =
      std::ranges::max_element(by_count, {}, [](const auto& sets) { return sets.second.size(); });
  std::vector<Pole> medians;
  if (most != by_count.end() && std::ssize(most->second) >= min_stable_orders) {
    for (std::size_t k = 0; k < most->first; ++k) {
      medians.push_back({median_of(most->second, k, &Pole::frequency_hz),
                         median_of(most->second, k, &Pole::damping_ratio)});
    }
  }
  return medians;
}

bool may_be_one_nonlinear_mode(const std::vector<Pole>& poles) {
  for (std::size_t i = 0; i < poles.size(); ++i) {
    for (std::size_t k = i + 1; k < poles.size(); ++k) {
      const auto [less, more] = std::minmax(poles[i].damping_ratio, poles[k].damping_ratio);
      const double apart_hz = std::abs(poles[i].frequency_hz - poles[k].frequency_hz);
      if (more > 2.0 * less && apart_hz < 0.2 * less * poles[i].frequency_hz) {
        return true;
      }
    }
  }
  return false;
}
}  // namespace tapstudy::analysis
