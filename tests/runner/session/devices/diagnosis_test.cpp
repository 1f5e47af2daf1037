#include "runner/session/devices/diagnosis.hpp"

#include <filesystem>

#include "support/catch.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using runner::Diagnosis;

namespace {
constexpr device::Nanoseconds period = 1'000'000;
device::ProbedLoop probed(int ticks, int late) {
  device::ProbedLoop probe;
  for (int i = 0; i < ticks; ++i) {
    probe.lateness.add(i < late ? 5 * period : period / 100);
  }
  probe.late = late;
  return probe;
}
Diagnosis measured(int ticks, int late) {
  Diagnosis diagnosis;
  diagnosis.period = period;
  diagnosis.idle = probed(ticks, late);
  return diagnosis;
}
// Among the facts of a machine whose files these are.
std::string fact(const std::string& name, const std::string& file, const std::string& content) {
  const testing::TempDirectory root;
  std::filesystem::create_directories(std::filesystem::path{root / "proc"});
  const std::filesystem::path path{root / file};
  std::filesystem::create_directories(path.parent_path());
  testing::write(path.string(), content + "\n");
  for (const auto& [key, value] : runner::machine_facts(root / "")) {
    if (key == name) {
      return value;
    }
  }
  return {};
}
}  // namespace

TEST_CASE("a machine is judged by the interval of its 99.9 %: one late tick is no verdict",
          "[runner][rig]") {
  const auto [ticks, late, holds, said] = GENERATE(table<int, int, bool, const char*>(
      {{5000, 0, true, "holds the loop with nothing else to do"},
       {5000, 1, true, "5000 ticks are too few to tell"},
       {10'000, 3, true, "holds the loop with nothing else to do"},
       {5000, 7, true, "5000 ticks are too few to tell"},
       {5000, 20, false, "cannot hold the loop"},
       {500, 0, true, "500 ticks are too few to tell"},
       {500, 1, true, "500 ticks are too few to tell"},
       {500, 10, false, "cannot hold the loop"}}));
  const runner::Verdict verdict = runner::verdict_of(measured(ticks, late));
  CAPTURE(ticks, late, verdict.words);
  CHECK(verdict.holds == holds);
  CHECK_THAT(verdict.words, Contains(said));
}

TEST_CASE("one slow reply of a device is no verdict, many are", "[runner][rig]") {
  const auto [slow, holds] = GENERATE(table<int, bool>({{0, true}, {1, true}, {5, false}}));
  Diagnosis diagnosis = measured(5000, 0);
  diagnosis.round_trip.emplace();
  for (int i = 0; i < 200; ++i) {
    diagnosis.round_trip->add(i < slow ? period : period / 10);
  }
  CHECK(runner::verdict_of(diagnosis).holds == holds);
}

TEST_CASE("a card with gaps, or too little in reserve, is told to be no actuator's",
          "[runner][rig][actuator]") {
  const auto [periods, late, gaps, holds, said] = GENERATE(table<int, int, int, bool, const char*>(
      {{10'000, 0, 0, true, "; it keeps the actuator's card filled, under load too"},
       {10'000, 0, 1, false, "; it cannot keep the actuator's card filled, even with nothing"},
       {10'000, 40, 0, false, "; it cannot keep the actuator's card filled, even with nothing"},
       {100, 0, 0, true, "; 100 periods are too few to tell"}}));
  device::ProbedCard card{.rate_hz = 48'000.0, .period_s = 0.001, .buffer_s = 0.003, .gaps = gaps};
  for (int i = 0; i < periods; ++i) {
    card.lateness.add(i < late ? 3 * period / 2 : period / 100);
  }
  Diagnosis diagnosis = measured(10'000, 0);
  diagnosis.actuator = runner::DiagnosedCard{card, card};
  const runner::Verdict verdict = runner::verdict_of(diagnosis);
  CHECK(verdict.holds == holds);
  CHECK_THAT(verdict.words, Contains(said));
  diagnosis.idle = probed(5000, 20);  // the loop comes first
  CHECK_THAT(runner::verdict_of(diagnosis).words, !Contains("actuator"));
}

TEST_CASE("doctor names the command that mends what it finds", "[runner][rig]") {
  const std::string cpu = "sys/devices/system/cpu/";
  CHECK_THAT(fact("governor", cpu + "cpu0/cpufreq/scaling_governor", "powersave"),
             Contains("sudo cpupower frequency-set -g performance"));
  CHECK(fact("governor", cpu + "cpu0/cpufreq/scaling_governor", "performance") == "performance");
  CHECK_THAT(fact("isolated", cpu + "isolated", ""), Contains("isolcpus=N on the kernel's"));
  CHECK(fact("isolated", cpu + "isolated", "2-3") == "2-3");
  const std::string timer = "sys/bus/usb-serial/devices/ttyUSB0/latency_timer";
  CHECK(fact("usb serial", timer, "16") == "ttyUSB0 16 ms (echo 1 | sudo tee /" + timer + ")");
  CHECK(fact("usb serial", timer, "1") == "ttyUSB0 1 ms");
}
