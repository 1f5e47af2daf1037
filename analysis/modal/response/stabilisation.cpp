#include "analysis/modal/response/stabilisation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/algebra/lapack.hpp"
namespace tapstudy::analysis {
namespace {
// The eigenvalues w of the companion matrix of w^n + A_1 w^(n-1) + ... + A_n: those of the
// determinant of A in w = 1 / z.
Eigen::VectorXcd inverse_roots(const Eigen::MatrixXd& denominator, Eigen::Index inputs) {
  const Eigen::Index size = denominator.rows();
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(size, size);
  companion.bottomLeftCorner(size - inputs, size - inputs).diagonal().setOnes();
  for (Eigen::Index block = 0; block < size; block += inputs) {
    companion.block(0, block, inputs, inputs) = -denominator.middleRows(block, inputs);
  }
  return core::eigenvalues(std::move(companion));
}

std::vector<OrderedPole> poles_of(const Eigen::VectorXcd& inverse, const AngleMap& map) {
  constexpr double edge = 1e-3;  // of the band: what lies there is the band's end, no mode
  const double margin_hz = edge * (map.high_hz - map.low_hz);
  std::vector<OrderedPole> poles;
  for (const std::complex<double>& root : inverse) {
    if (root.imag() >= 0.0 || std::abs(root) <= 0.0) {
      continue;  // of a pair the one whose reciprocal has a positive angle
    }
    const std::complex<double> s = map.pole_of_root(1.0 / root);
    const Pole pole{std::abs(s) / (2.0 * std::numbers::pi), -s.real() / std::abs(s)};
    const double damped_hz = s.imag() / (2.0 * std::numbers::pi);
    if (pole.damping_ratio > 0.0 && pole.damping_ratio < max_ratio_of_mode &&
        damped_hz > map.low_hz + margin_hz && damped_hz < map.high_hz - margin_hz) {
      poles.push_back({pole, 1});
    }
  }
  std::ranges::sort(poles, {}, [](const OrderedPole& one) { return one.pole.frequency_hz; });
  return poles;
}

double distance(const Pole& from, const Pole& to) {
  const double bandwidth_hz = 2.0 * from.damping_ratio * from.frequency_hz;
  const double by_frequency = std::abs(to.frequency_hz - from.frequency_hz) /
                              std::max(0.25 * bandwidth_hz, 1e-4 * from.frequency_hz);
  const double by_ratio =
      std::abs(to.damping_ratio - from.damping_ratio) / std::max(0.2 * from.damping_ratio, 5e-5);
  return std::max(by_frequency, by_ratio);
}

// Pairs nearest first; each pole of either order is in one at most.
void continue_from(const std::vector<OrderedPole>& before, std::vector<OrderedPole>& now) {
  struct Pair {
    double distance{};
    std::size_t before{};
    std::size_t now{};
  };
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < before.size(); ++i) {
    for (std::size_t j = 0; j < now.size(); ++j) {
      const double apart = distance(before[i].pole, now[j].pole);
      if (apart < 1.0) {
        pairs.push_back({apart, i, j});
      }
    }
  }
  std::ranges::sort(pairs, {}, &Pair::distance);
  std::vector<bool> is_left(before.size(), true);
  for (const Pair& pair : pairs) {
    if (is_left[pair.before] && now[pair.now].orders == 1) {
      is_left[pair.before] = false;
      now[pair.now].orders = before[pair.before].orders + 1;
    }
  }
}
}  // namespace

std::vector<StabilisationOrder> stabilisation_diagram(const NormalEquations& equations,
                                                      const AngleMap& map) {
  std::vector<StabilisationOrder> diagram;
  for (int order = 1; order <= equations.max_order(); ++order) {
    StabilisationOrder one{
        order, poles_of(inverse_roots(equations.denominator(order), equations.inputs()), map)};
    if (!diagram.empty()) {
      continue_from(diagram.back().poles, one.poles);
    }
    diagram.push_back(std::move(one));
  }
  return diagram;
}

std::vector<SettledPole> settled_poles(const std::vector<StabilisationOrder>& diagram) {
  std::vector<SettledPole> chains;
  for (std::size_t i = 0; i < diagram.size(); ++i) {
    for (const OrderedPole& one : diagram[i].poles) {
      const bool goes_on =
          i + 1 < diagram.size() &&
          std::ranges::any_of(diagram[i + 1].poles, [&](const OrderedPole& next) {
            return next.orders == one.orders + 1 && distance(one.pole, next.pole) < 1.0;
          });
      if (one.orders >= min_orders_of_mode && !goes_on) {
        chains.push_back({one.pole, one.orders});
      }
    }
  }
  std::ranges::stable_sort(chains, std::ranges::greater{}, &SettledPole::orders);
  std::vector<SettledPole> distinct;
  for (const SettledPole& one : chains) {
    if (std::ranges::none_of(distinct, [&](const SettledPole& longer) {
          return distance(longer.pole, one.pole) < 1.0;
        })) {
      distinct.push_back(one);
    }
  }
  std::ranges::sort(distinct, {}, [](const SettledPole& one) { return one.pole.frequency_hz; });
  return distinct;
}
}  // namespace tapstudy::analysis
