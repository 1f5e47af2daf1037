#include "analysis/modal_identification/assignment.hpp"

#include <fmt/format.h>

#include "analysis/modal_identification/modal_assurance.hpp"
#include "analysis/modal_identification/repeated_modes.hpp"
#include "core/rng.hpp"
#include "support/catch.hpp"
#include "support/python_program.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;

namespace {
// That shows one agreed mode.
TapModes tap_of(double frequency_hz, double error_hz) {
  TapModes tap;
  FittedMode fitted;
  fitted.pole = {frequency_hz, 0.02};
  fitted.frequency_error_hz = error_hz;
  fitted.ratio_error = 1e-4;
  tap.modes.push_back({fitted, Standing::agreed, "", {}, 5});
  return tap;
}

double cost_of(const std::vector<std::size_t>& columns, const Eigen::MatrixXd& cost) {
  double sum = 0.0;
  for (std::size_t row = 0; row < columns.size(); ++row) {
    sum += cost(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(columns[row]));
  }
  return sum;
}
}  // namespace

TEST_CASE("the least cost of an assignment is SciPy's", "[analysis][modal_identification]") {
  core::Rng rng{4};
  std::string script = "from scipy.optimize import linear_sum_assignment as f\n";
  std::vector<double> ours;
  for (int sample = 0; sample < 40; ++sample) {
    const Eigen::Index rows = 1 + rng.below(9);
    const Eigen::Index columns = rows + rng.below(6);
    Eigen::MatrixXd cost(rows, columns);
    std::string text;
    for (double& one : cost.reshaped<Eigen::RowMajor>()) {
      one = static_cast<double>(rng.below(20)) - 5.0;  // with ties
      text += fmt::format("{},", one);
    }
    script += fmt::format("c = np.array([{}]).reshape({}, {})\nout(c[f(c)].sum())\n", text, rows,
                          columns);
    ours.push_back(cost_of(least_cost_assignment(cost), cost));
  }
  CHECK(ours == testing::python_numbers(script));
}

TEST_CASE("shapes in proportion have an assurance of 1, orthogonal ones and none of 0",
          "[analysis][modal_identification]") {
  const Eigen::Vector3d shape{1.0, -2.0, 0.5};
  CHECK(modal_assurance(shape, -3.0 * shape) == Approx(1.0).epsilon(1e-12));
  CHECK(modal_assurance(shape, Eigen::Vector3d{2.0, 1.0, 0.0}) == Approx(0.0).margin(1e-12));
  CHECK(modal_assurance(shape, Eigen::Vector3d::Zero()) == 0.0);
}

TEST_CASE("what channels say of one impact is one observation",
          "[analysis][modal_identification]") {
  std::vector<TapModes> one_channel;
  std::vector<TapModes> two_channels;
  std::vector<int> impacts;
  int impact = 0;
  for (const double frequency_hz : {100.0, 100.2, 99.9, 100.1}) {
    one_channel.push_back(tap_of(frequency_hz, 0.01));
    ++impact;
    for (const double apart : {-0.05, 0.05}) {
      two_channels.push_back(tap_of(frequency_hz + apart, 0.01));
      impacts.push_back(impact);
    }
  }
  const auto one = modes_over_taps(one_channel).at(0).frequency_hz;
  const auto two = modes_over_taps(two_channels, impacts).at(0).frequency_hz;
  CHECK(two.value == Approx(one.value).epsilon(1e-12));
  CHECK(two.interval.low == Approx(one.interval.low).epsilon(1e-12));
  CHECK(modes_over_taps(two_channels).at(0).frequency_hz.interval.low > two.interval.low);
}

TEST_CASE("taps that differ as their errors say do not scatter, however unequal the errors",
          "[analysis][modal_identification]") {
  const std::vector<double> errors_hz{0.01, 0.01, 0.01, 0.03, 0.03, 0.03, 0.1, 0.1};
  core::Rng rng{2};
  constexpr int recordings = 2000;
  int improbable = 0;
  for (int recording = 0; recording < recordings; ++recording) {
    std::vector<TapModes> taps;
    for (const double error_hz : errors_hz) {
      taps.push_back(tap_of(100.0 + error_hz * rng.normal(), error_hz));
    }
    improbable += modes_over_taps(taps).at(0).scatter_p.value() < 0.05 ? 1 : 0;
  }
  CHECK(improbable / static_cast<double>(recordings) == Approx(0.05).margin(0.02));
  // two modes, of which each tap shows the stronger one
  std::vector<TapModes> two;
  for (const double frequency_hz : {100.0, 100.0, 100.2, 100.0, 100.2}) {
    two.push_back(tap_of(frequency_hz, 0.01));
  }
  CHECK(modes_over_taps(two).at(0).scatter_p.value() < 1e-6);
  two.resize(2);
  CHECK_FALSE(modes_over_taps(two).at(0).scatter_p);  // of two it would say little
}
