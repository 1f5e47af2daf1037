// Modes of frequency responses: what was planted comes back.
#include "analysis/modal/response/response_modes.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/modal/modes/mode_shapes.hpp"
#include "core/error.hpp"
#include "support/catch.hpp"
#include "support/synthetic_responses.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;

namespace {
// The second and third are a bandwidth apart.
const testing::PlantedStructure six_places{
    {{62.0, 0.015}, {121.3, 0.008}, {123.2, 0.006}, {190.0, 0.02}, {271.0, 0.005}}};
constexpr Band planted_band{10.0, 320.0};
constexpr Eigen::Index planted_lines = 311;  // a hertz apart

std::vector<ResponseMode> listed(const ResponseModes& found) {
  std::vector<ResponseMode> modes;
  std::ranges::copy_if(found.modes, std::back_inserter(modes),
                       [](const ResponseMode& mode) { return mode.standing == Standing::agreed; });
  return modes;
}
}  // namespace

TEST_CASE("without noise, poles, residues and shapes of responses are those of the structure",
          "[analysis][responses]") {
  const auto kind =
      GENERATE(ResponseKind::receptance, ResponseKind::mobility, ResponseKind::accelerance);
  testing::PlantedStructure structure = six_places;
  structure.references = GENERATE(1, 2);
  CAPTURE(name(kind), structure.references);
  const auto found = find_response_modes(
      testing::planted_responses(structure, kind, planted_band, planted_lines), {});
  CHECK(found.remarks.empty());
  REQUIRE(found.modes.size() == structure.poles.size());
  for (std::size_t mode = 0; mode < found.modes.size(); ++mode) {
    const ResponseMode& one = found.modes[mode];
    const Pole& planted = structure.poles[mode];
    INFO(planted.frequency_hz << " Hz: " << one.why);
    CHECK(one.standing == Standing::agreed);
    CHECK(one.frequency_hz.value == Approx(planted.frequency_hz).epsilon(1e-6));
    CHECK(one.damping_ratio.value == Approx(planted.damping_ratio).epsilon(1e-6));
    CHECK(one.phase_collinearity == Approx(1.0));
    Eigen::VectorXcd shape(structure.places);
    for (int place = 0; place < structure.places; ++place) {
      shape[place] = structure.displacement(mode, place);
      const auto residue = structure.residue(mode, place, 0);
      CHECK(std::abs(one.residues[place] - residue) < 1e-5 * one.residues.cwiseAbs().maxCoeff());
    }
    CHECK(modal_assurance(one.shape, shape) == Approx(1.0));
    CHECK(one.shape.cwiseAbs().maxCoeff() == Approx(1.0));
  }
}

TEST_CASE("in noise every mode of responses is found, none besides, with intervals that hold",
          "[analysis][responses]") {
  constexpr int seeds = 20;
  for (const double noise_db : {60.0, 40.0}) {
    int held = 0;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
      const auto modes = listed(find_response_modes(
          testing::planted_responses(six_places, ResponseKind::accelerance, planted_band,
                                     planted_lines, noise_db, seed),
          {}));
      CAPTURE(noise_db, seed);
      REQUIRE(modes.size() == six_places.poles.size());
      for (std::size_t i = 0; i < modes.size(); ++i) {
        const auto holds = [](const Estimate& estimate, double truth) {
          return estimate.interval.low <= truth && truth <= estimate.interval.high ? 1 : 0;
        };
        held += holds(modes[i].frequency_hz, six_places.poles[i].frequency_hz);
        held += holds(modes[i].damping_ratio, six_places.poles[i].damping_ratio);
      }
    }
    // of 200 intervals of 95 %: below 180 in one of 10^3 tries
    CHECK(held >= 180);
  }
}

TEST_CASE("noise alone has no mode", "[analysis][responses]") {
  testing::PlantedStructure rigid = six_places;
  rigid.poles.clear();
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const auto found =
        find_response_modes(testing::planted_responses(rigid, ResponseKind::accelerance,
                                                       planted_band, planted_lines, 20.0, seed),
                            {});
    CAPTURE(seed);
    CHECK(found.modes.empty());
  }
}

TEST_CASE("a mode whose peak the band cuts in half is not listed", "[analysis][responses]") {
  const auto all = testing::planted_responses(six_places, ResponseKind::mobility, planted_band,
                                              planted_lines, 60.0);
  const auto found = find_response_modes(all, Band{20.0, 191.0});  // 188 to 192 Hz is its peak
  for (const ResponseMode& mode : found.modes) {
    CAPTURE(mode.frequency_hz.value, mode.why);
    CHECK((mode.standing == Standing::agreed) == (mode.frequency_hz.value < 130.0));
  }
  CHECK(listed(found).size() == 3);
  CHECK_THROWS_WITH(find_response_modes(all, Band{100.0, 105.0}), Contains("at least 16"));
}

TEST_CASE("residues of a driving point have one sign, and what has not is remarked on",
          "[analysis][responses]") {
  auto responses = testing::planted_responses(six_places, ResponseKind::receptance, planted_band,
                                              planted_lines, 60.0);
  responses.values.col(0) *= -1.0;  // the sensor is turned round
  auto found = find_response_modes(responses, {});
  REQUIRE(found.remarks.size() == 1);
  CHECK_THAT(found.remarks.front(), Contains("1+Z/1+Z") && Contains("opposite signs"));
  responses.pairs[0].response = "9+Z";  // what is taken for the driving point is the place beside
  responses.pairs[1].response = "1+Z";
  found = find_response_modes(responses, {});
  REQUIRE(found.remarks.size() == 1);
  std::vector<double> signs;
  for (std::size_t mode = 0; mode < six_places.poles.size(); ++mode) {
    signs.push_back(six_places.displacement(mode, 0) * six_places.displacement(mode, 1));
  }
  const auto negative = std::ranges::count_if(signs, [](double sign) { return sign < 0.0; });
  REQUIRE(negative == 4);  // of five: the one that is not is named
  REQUIRE(found.modes.size() == signs.size());
  for (std::size_t mode = 0; mode < signs.size(); ++mode) {
    const std::string hz = fmt::format("{:.5g}", found.modes[mode].frequency_hz.value);
    CHECK((found.remarks.front().find(hz) != std::string::npos) == (signs[mode] > 0.0));
  }
}

TEST_CASE("a row of places struck with one sensor says what many sensors and one place say",
          "[analysis][responses]") {
  auto responses = testing::planted_responses(six_places, ResponseKind::accelerance, planted_band,
                                              planted_lines, 50.0);
  const auto sensors = find_response_modes(responses, {});
  for (ResponsePair& pair : responses.pairs) {
    std::swap(pair.response, pair.reference);  // reciprocity: the values are the same
  }
  const auto struck = find_response_modes(responses, {});
  CHECK(struck.places == sensors.places);
  REQUIRE(struck.modes.size() == sensors.modes.size());
  for (std::size_t i = 0; i < struck.modes.size(); ++i) {
    CHECK(struck.modes[i].frequency_hz.value == sensors.modes[i].frequency_hz.value);
    CHECK(struck.modes[i].shape == sensors.modes[i].shape);
  }
}
