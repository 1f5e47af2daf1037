#include "protocols/schedule.hpp"

#include <catch2/catch.hpp>
#include <map>
#include <set>

#include "protocols/ordering.hpp"
#include "protocols/read_protocol.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using protocols::make_schedule;

namespace {
protocols::Protocol paper(const char* name) {
  return protocols::read_protocol(testing::shipped(std::string{"paper/"} + name).string());
}
}  // namespace

TEST_CASE("every plate is presented as often as the protocol says", "[protocols][schedule]") {
  protocols::Protocol protocol = paper("discrimination.yaml");
  protocol.blocks[0].order =
      GENERATE(protocols::Order::listed, protocols::Order::shuffle,
               protocols::Order::shuffle_within_repetition, protocols::Order::williams);
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    std::map<std::string, int> count;
    std::set<std::pair<std::string, int>> repetitions;
    for (const protocols::PlannedTrial& trial : make_schedule(protocol, seed, 3)) {
      ++count[trial.stimuli.front()];
      repetitions.insert({trial.stimuli.front(), trial.repetition});
    }
    CHECK(count == std::map<std::string, int>{
                       {"acrylic_two", 2}, {"mdf_two", 2}, {"acrylic_three", 2}, {"mdf_three", 2}});
    CHECK(repetitions.size() == 8);
  }
}

TEST_CASE("the same seed gives the same order, another seed another", "[protocols][schedule]") {
  const protocols::Protocol protocol = paper("discrimination.yaml");
  const auto order = [&](std::uint64_t seed) {
    return protocols::described(make_schedule(protocol, seed, 0));
  };
  CHECK(order(1) == order(1));
  CHECK(order(1) != order(2));
}

TEST_CASE("every place is equally likely for every plate", "[protocols][schedule]") {
  const protocols::Protocol protocol = paper("discrimination.yaml");
  std::map<std::pair<std::size_t, std::string>, int> seen;
  constexpr int schedules = 8000;
  for (std::uint64_t seed = 0; seed < schedules; ++seed) {
    const auto schedule = make_schedule(protocol, seed, 0);
    for (std::size_t place = 0; place < schedule.size(); ++place) {
      ++seen[{place, schedule[place].stimuli.front()}];
    }
  }
  for (const auto& [place, count] : seen) {
    CHECK(count == Approx(schedules / 4).margin(4.5 * std::sqrt(schedules * 0.25 * 0.75)));
  }
}

TEST_CASE("within a repetition every plate comes once", "[protocols][schedule]") {
  protocols::Protocol protocol = paper("discrimination.yaml");
  protocol.blocks[0].order = protocols::Order::shuffle_within_repetition;
  const auto schedule = make_schedule(protocol, 9, 0);
  std::set<std::string> first_half;
  for (std::size_t i = 0; i < 4; ++i) {
    first_half.insert(schedule[i].stimuli.front());
    CHECK(schedule[i].repetition == 1);
  }
  CHECK(first_half.size() == 4);
}

TEST_CASE("in a Williams square everything follows everything else equally often",
          "[protocols][schedule]") {
  const int n = GENERATE(2, 3, 4, 5, 6, 7);
  std::map<std::pair<int, int>, int> successions;
  std::map<std::pair<int, int>, int> places;
  for (int row = 0; row < protocols::williams_rows(n); ++row) {
    const auto conditions = protocols::williams_row(n, row);
    CHECK(std::set<int>(conditions.begin(), conditions.end()).size() == conditions.size());
    for (int place = 0; place < n; ++place) {
      ++places[{place, conditions[static_cast<std::size_t>(place)]}];
      if (place > 0) {
        ++successions[{conditions[static_cast<std::size_t>(place - 1)],
                       conditions[static_cast<std::size_t>(place)]}];
      }
    }
  }
  const int each = protocols::williams_rows(n) / n;
  CHECK(successions.size() == static_cast<std::size_t>(n * (n - 1)));
  for (const auto& [pair, count] : successions) {
    CHECK(count == each);
  }
  for (const auto& [pair, count] : places) {
    CHECK(count == each);
  }
}

TEST_CASE("blind labels are drawn anew for each participant and kept within one",
          "[protocols][schedule]") {
  protocols::Protocol protocol = paper("reality_finger.yaml");
  protocol.blocks[0].repetitions = 3;
  std::set<std::vector<std::string>> mappings;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const auto schedule = make_schedule(protocol, seed, 0);
    REQUIRE(schedule.size() == 3);
    CHECK(schedule[0].stimuli == schedule[2].stimuli);
    mappings.insert(schedule[0].stimuli);
  }
  CHECK(mappings.size() == 6);  // all orders of three
}
