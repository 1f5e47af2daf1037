// Circular triads, counted one by one.
#include "analysis/paired/circular_triads.hpp"

#include "core/error.hpp"
#include "core/rng.hpp"
#include "support/catch.hpp"
using namespace tapstudy;

namespace {
Eigen::MatrixXi random_preferences(Eigen::Index items, core::Rng& rng) {
  Eigen::MatrixXi preferred = Eigen::MatrixXi::Zero(items, items);
  for (Eigen::Index i = 0; i < items; ++i) {
    for (Eigen::Index j = i + 1; j < items; ++j) {
      (rng.below(2) == 0 ? preferred(i, j) : preferred(j, i)) = 1;
    }
  }
  return preferred;
}

// A triad is circular if each of its items is preferred to exactly one of the others.
std::int64_t counted(const Eigen::MatrixXi& preferred) {
  std::int64_t circular = 0;
  for (Eigen::Index i = 0; i < preferred.rows(); ++i) {
    for (Eigen::Index j = i + 1; j < preferred.rows(); ++j) {
      for (Eigen::Index k = j + 1; k < preferred.rows(); ++k) {
        const bool is_one_way =
            preferred(i, j) == preferred(j, k) && preferred(j, k) == preferred(k, i);
        circular += is_one_way ? 1 : 0;
      }
    }
  }
  return circular;
}
}  // namespace

TEST_CASE("circular triads are as many as are counted one by one, and zeta is in [0, 1]",
          "[analysis][paired]") {
  core::Rng rng{9};
  for (const Eigen::Index items : {3, 4, 5, 6, 9}) {
    for (int judge = 0; judge < 20; ++judge) {
      const Eigen::MatrixXi preferred = random_preferences(items, rng);
      const auto ours = analysis::consistency(preferred);
      CHECK(ours.circular_triads == counted(preferred));
      CHECK(ours.zeta >= 0.0);
      CHECK(ours.zeta <= 1.0);
    }
  }
}

TEST_CASE("a judge who orders the items has zeta 1, one who turns in circles 0",
          "[analysis][paired]") {
  for (const Eigen::Index items : {3, 4, 5, 6, 7, 8}) {
    Eigen::MatrixXi ordered = Eigen::MatrixXi::Zero(items, items);
    Eigen::MatrixXi circular = Eigen::MatrixXi::Zero(items, items);
    for (Eigen::Index i = 0; i < items; ++i) {
      for (Eigen::Index step = 1; step < items; ++step) {
        ordered(i, (i + step) % items) = (i + step) < items ? 1 : 0;
        // to the items of the half circle after it; across an even one, from its first half
        const bool is_after = 2 * step < items || (2 * step == items && i < items / 2);
        circular(i, (i + step) % items) = is_after ? 1 : 0;
      }
    }
    CHECK(analysis::consistency(ordered).zeta == 1.0);
    CHECK(analysis::consistency(circular).zeta == 0.0);
    CHECK(analysis::consistency(circular).circular_triads == counted(circular));
  }
}

TEST_CASE("preferences that do not name one of each pair are refused", "[analysis][paired]") {
  CHECK_THROWS_AS(analysis::consistency(Eigen::MatrixXi::Zero(3, 3)), core::InvalidInput);
  CHECK_THROWS_AS(analysis::consistency(Eigen::MatrixXi::Ones(3, 3)), core::InvalidInput);
  CHECK_THROWS_AS(analysis::consistency(Eigen::MatrixXi::Zero(3, 2)), core::InvalidInput);
  CHECK_THROWS_AS(analysis::consistency((Eigen::MatrixXi(2, 2) << 0, 1, 0, 0).finished()),
                  core::InvalidInput);
  CHECK_THROWS_AS(
      analysis::consistency((Eigen::MatrixXi(3, 3) << 0, 2, 1, -1, 0, 1, 0, 0, 0).finished()),
      core::InvalidInput);
}
