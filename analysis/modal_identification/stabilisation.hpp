#pragma once
#include "analysis/modal_identification/matrix_pencil.hpp"
namespace tapstudy::analysis {
// A pole that does not move as the order grows.
struct StablePole {
  Pole pole;     // medians over the orders
  int orders{};  // how many successive orders found it
};
inline constexpr int min_stable_orders = 4;
// Whether the pole of one order is that of the next: within 1 % of its frequency (a sixth of its
// half-power bandwidth if that is more) and 10 % (or 0.003) of its damping ratio.
bool continues(const Pole& from, const Pole& to);
// A stabilisation diagram, read: poles that at least min_stable_orders successive orders found,
// each continuing the one before. Of chains at one pole the longest counts.
std::vector<StablePole> stable_poles(const std::vector<PolesOfOrder>& orders);
}  // namespace tapstudy::analysis
