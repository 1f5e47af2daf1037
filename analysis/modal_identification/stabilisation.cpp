#include "analysis/modal_identification/stabilisation.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/statistics/quantiles.hpp"
namespace tapstudy::analysis {
namespace {
struct Chain {
  int last_order{};
  std::vector<double> frequencies_hz;
  std::vector<double> ratios;
  Pole last() const { return {frequencies_hz.back(), ratios.back()}; }
};

// The chain that ends at the order before and nearest to the pole.
Chain* continued_by(std::vector<Chain>& chains, const Pole& pole, int order) {
  Chain* nearest = nullptr;
  double least = 0.0;
  for (Chain& chain : chains) {
    const double distance = std::abs(chain.last().frequency_hz - pole.frequency_hz);
    if (chain.last_order == order - 2 && continues(chain.last(), pole) &&
        (nearest == nullptr || distance < least)) {
      nearest = &chain;
      least = distance;
    }
  }
  return nearest;
}

std::vector<Chain> chains_of(const std::vector<PolesOfOrder>& orders) {
  std::vector<Chain> chains;
  for (const PolesOfOrder& one : orders) {
    for (const Pole& pole : one.poles) {
      Chain* chain = continued_by(chains, pole, one.order);
      if (chain == nullptr) {
        chain = &chains.emplace_back();
      }
      chain->last_order = one.order;
      chain->frequencies_hz.push_back(pole.frequency_hz);
      chain->ratios.push_back(pole.damping_ratio);
    }
  }
  return chains;
}
}  // namespace

bool continues(const Pole& from, const Pole& to) {
  const double ratio_tolerance = std::max(0.003, 0.1 * std::abs(from.damping_ratio));
  return std::abs(to.frequency_hz - from.frequency_hz) <= frequency_tolerance_hz(from, 0.01) &&
         std::abs(to.damping_ratio - from.damping_ratio) <= ratio_tolerance;
}

std::vector<StablePole> stable_poles(const std::vector<PolesOfOrder>& orders) {
  std::vector<StablePole> found;
  for (const Chain& chain : chains_of(orders)) {
    const auto length = static_cast<int>(chain.ratios.size());
    if (length >= min_stable_orders) {
      found.push_back({{quantile(chain.frequencies_hz, 0.5), quantile(chain.ratios, 0.5)}, length});
    }
  }
  std::ranges::stable_sort(found, std::ranges::greater{}, &StablePole::orders);
  std::vector<StablePole> distinct;
  for (const StablePole& one : found) {
    if (std::ranges::none_of(
            distinct, [&](const StablePole& longer) { return continues(longer.pole, one.pole); })) {
      distinct.push_back(one);
    }
  }
  std::ranges::sort(distinct, {}, [](const StablePole& one) { return one.pole.frequency_hz; });
  return distinct;
}
}  // namespace tapstudy::analysis
