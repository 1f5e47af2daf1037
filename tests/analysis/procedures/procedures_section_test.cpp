#include "analysis/procedures/procedures_section.hpp"

#include <cmath>
#include <numbers>

#include "support/catch.hpp"
using namespace tapstudy;

namespace {
analysis::TrackResult track(const std::string& participant, double estimate, bool is_signed) {
  analysis::TrackResult result;
  result.participant_id = participant;
  result.block = "block";
  result.procedure = "staircase";
  result.estimate = estimate;
  result.is_signed = is_signed;
  return result;
}

// Mean and interval.
std::vector<double> mean_in(const std::vector<analysis::TrackResult>& tracks) {
  const analysis::ReportTable means = analysis::procedures_section(tracks).tables.front();
  REQUIRE(means.rows.size() == 1);
  std::vector<double> values;
  for (const analysis::Value& value : means.rows.front().at(3).values) {
    values.push_back(std::get<double>(value));
  }
  return values;
}

// Of Student's t with one degree of freedom, which is Cauchy's distribution.
const double t_of_two = std::tan(0.475 * std::numbers::pi);
}  // namespace

TEST_CASE("the mean of procedures' estimates counts each participant once, as logarithms",
          "[analysis][procedures]") {
  const std::vector<double> mean =
      mean_in({track("P1", 1.0, false), track("P1", 100.0, false), track("P2", 1000.0, false)});
  CHECK(mean.at(0) == Approx(100.0));
  CHECK(std::log10(mean.at(1)) == Approx(2.0 - t_of_two));
  CHECK(std::log10(mean.at(2)) == Approx(2.0 + t_of_two));
}

TEST_CASE("levels on both sides of a standard are averaged as they are", "[analysis][procedures]") {
  const std::vector<double> mean = mean_in({track("P1", -0.5, true), track("P2", 0.1, true)});
  CHECK(mean.at(0) == Approx(-0.2));
  CHECK(mean.at(2) == Approx(-0.2 + 0.3 * t_of_two));
}
