#pragma once
#include <vector>

#include "analysis/modal/response/normal_equations.hpp"
namespace tapstudy::analysis {
// A pole of one order, and in how many successive orders up to this one it was found.
struct OrderedPole {
  Pole pole;
  int orders{1};
};
struct StabilisationOrder {
  int order{};
  std::vector<OrderedPole> poles;  // inside the band, ascending frequency
};

inline constexpr int min_orders_of_mode = 5;
inline constexpr double max_ratio_of_mode = 0.3;

// The poles of each order: roots of the determinant of A, those that decay, with a damping ratio
// below max_ratio_of_mode, strictly within the frequencies. A pole is that of the order before if
// its frequency moved by less than a quarter of its half-power bandwidth (1e-4 of it if that is
// more) and its damping ratio by less than a fifth (5e-5 if that is more); each continues one.
std::vector<StabilisationOrder> stabilisation_diagram(const NormalEquations& equations,
                                                      const AngleMap& map);

// The distinct poles that min_orders_of_mode successive orders have, each as the last of these
// found it, ascending frequency.
struct SettledPole {
  Pole pole;
  int orders{};
};
std::vector<SettledPole> settled_poles(const std::vector<StabilisationOrder>& diagram);
}  // namespace tapstudy::analysis
