// How the settings of an alternative are rendered: each by a position of the loop.
#include "runner/session/adjusted_exploration.hpp"

#include <map>

#include "protocols/read_protocol.hpp"
#include "protocols/schedule.hpp"
#include "support/catch.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
class Positions final : public runner::Exploration {
 public:
  void switch_to(std::size_t position) override { current_ = position; }
  std::size_t current() const override { return current_; }
  void pass_time(double seconds) override { time_s_ += seconds; }
  bool is_running() const override { return true; }
  double time_s() const override { return time_s_; }
  int contacts(std::size_t position) const override { return contacts_.at(position); }
  std::map<std::size_t, int> contacts_;

 private:
  std::size_t current_{0};
  double time_s_{0.0};
};

struct Planned {
  protocols::Protocol protocol{
      protocols::read_protocol(testing::source("tests/data/every_task.yaml"))};
  const protocols::Block& block{protocol.block("adjustment")};
  protocols::PlannedTrial trial() const {
    for (const protocols::PlannedTrial& one : make_schedule(protocol, 5, 0)) {
      if (one.block == block.name) {
        return one;
      }
    }
    return {};
  }
};
}  // namespace

TEST_CASE("every setting has a position behind the standard, at its value of the axis",
          "[runner][session]") {
  const Planned planned;
  const protocols::PlannedTrial trial = planned.trial();
  const auto all = rendered(trial, planned.block);
  const std::vector<double>& values = planned.block.adjustment->values;
  REQUIRE(all.size() == 1 + values.size());
  CHECK(all.front().values == trial.alternatives.front().values);
  CHECK_FALSE(all.front().is_comparison);
  for (std::size_t i = 0; i < values.size(); ++i) {
    CHECK(all[1 + i].values.at("sinusoid_amplitude_n_s_per_m") == values[i]);
    CHECK(all[1 + i].is_comparison);
  }
}

TEST_CASE("a setting is rendered at once, felt by itself, and an event with its value and time",
          "[runner][session]") {
  const Planned planned;
  const protocols::PlannedTrial trial = planned.trial();
  const std::vector<double>& values = planned.block.adjustment->values;
  const double start = trial.alternatives.back().values.at("sinusoid_amplitude_n_s_per_m");
  Positions positions;
  positions.contacts_ = {{0, 5}, {3, 7}, {11, 0}};
  runner::TrialEvents events;
  runner::AdjustedExploration adjusted{positions, trial, planned.block, events};
  CHECK(values.at(adjusted.setting()) == start);
  adjusted.switch_to(1);
  CHECK(positions.current() == 1 + adjusted.setting());
  CHECK(adjusted.current() == 1);
  adjusted.pass_time(2.0);
  adjusted.adjust(2);
  CHECK(positions.current() == 3);
  CHECK(adjusted.contacts(1) == 7);
  adjusted.switch_to(0);
  CHECK(adjusted.current() == 0);
  CHECK(adjusted.contacts(0) == 5);
  adjusted.pass_time(1.0);
  adjusted.adjust(10);
  CHECK(adjusted.current() == 1);
  CHECK(adjusted.contacts(1) == 0);
  adjusted.adjust(values.size());  // there is none
  CHECK(adjusted.setting() == 10);
  REQUIRE(events.rows().size() == 3);
  const std::vector<double> expected{start, values[2], values[10]};
  const std::vector<double> times_s{0.0, 2.0, 3.0};
  for (std::size_t i = 0; i < events.rows().size(); ++i) {
    CHECK(events.rows()[i].kind == "setting");
    CHECK(events.rows()[i].value == expected[i]);
    CHECK(events.rows()[i].t_s == times_s[i]);
  }
}

TEST_CASE("alternatives without settings keep their positions", "[runner][session]") {
  const Planned planned;
  for (const protocols::PlannedTrial& trial : make_schedule(planned.protocol, 5, 0)) {
    if (trial.block == planned.block.name) {
      continue;
    }
    Positions positions;
    runner::TrialEvents events;
    runner::AdjustedExploration same{positions, trial, planned.protocol.block(trial.block), events};
    for (std::size_t i = 0; i < trial.alternatives.size(); ++i) {
      positions.contacts_[i] = 10 + static_cast<int>(i);
      same.switch_to(i);
      CHECK(positions.current() == i);
      CHECK(same.current() == i);
      CHECK(same.contacts(i) == 10 + static_cast<int>(i));
      same.adjust(0);
      CHECK(positions.current() == i);
    }
    CHECK(events.rows().empty());
  }
}
