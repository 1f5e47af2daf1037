// What was rendered, as a report says it.
#include "analysis/report/study/rendered.hpp"

#include <nlohmann/json.hpp>
#include <sstream>

#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
// A tick a millisecond.
core::TraceSample sample(std::int64_t t_ms, bool is_touching, double force_n = 0.0) {
  core::TraceSample made{};
  made.t_ns = 1'000'000 * t_ms;
  made.touching = is_touching;
  made.penalty_n = force_n;
  made.velocity_m_s = {0.0, -0.2, 0.0};
  return made;
}

core::TraceSample impact(std::int64_t t_ms) {
  core::TraceSample made = sample(t_ms, true, 1.0);
  made.impact = true;
  return made;
}

// Touching from each impact for so long, out of contact otherwise.
std::vector<core::TraceSample> touched(const std::vector<std::int64_t>& impacts_ms,
                                       std::int64_t contact_ms, std::int64_t end_ms) {
  std::vector<core::TraceSample> samples;
  for (std::int64_t t_ms = 0; t_ms < end_ms; ++t_ms) {
    samples.push_back(sample(t_ms, false));
    for (const std::int64_t begin_ms : impacts_ms) {
      if (t_ms == begin_ms) {
        samples.back() = impact(t_ms);
      } else if (t_ms > begin_ms && t_ms < begin_ms + contact_ms) {
        samples.back() = sample(t_ms, true, 2.0);
      }
    }
  }
  return samples;
}

std::vector<analysis::TracedTap> taps_in(const std::vector<core::TraceSample>& samples) {
  std::vector<analysis::TracedTap> taps;
  analysis::TapCutter cutter{{}, [&](const analysis::TracedTap& tap) { taps.push_back(tap); }};
  for (const core::TraceSample& each : samples) {
    cutter.add(each);
  }
  cutter.end_trial();
  return taps;
}

std::string simulated(const testing::TempDirectory& directory, const std::string& protocol,
                      const std::vector<std::string>& options = {}) {
  const std::string study = directory / "study";
  std::vector<std::string> words{
      "simulate", testing::shipped(protocol), "--participants", "2", "--seed", "4", "--out", study};
  words.insert(words.end(), options.begin(), options.end());
  const auto run = testing::tapstudy(words);
  INFO(run.standard_error);
  REQUIRE(run.exit_code == 0);
  return study;
}
}  // namespace

TEST_CASE("an impact soon after the finger came off is a rebound, a later one a tap",
          "[analysis][rendered]") {
  CHECK(taps_in(touched({100, 149}, 20, 600)).size() == 1);  // away for 29 ms
  const auto taps = taps_in(touched({100, 170}, 20, 600));   // away for 50 ms
  REQUIRE(taps.size() == 2);
  CHECK(taps[0].ticks.size() == 70);   // to the next tap
  CHECK(taps[1].ticks.size() == 200);  // to the end of its window
  CHECK(taps[1].speed_m_s == 0.2);
  CHECK(taps[1].ticks[19].parts.penalty_n == 2.0);
  CHECK(taps[1].ticks[20].parts.penalty_n == 0.0);
}

TEST_CASE("a tap ends with its trial, at a switch and at a fault", "[analysis][rendered]") {
  auto samples = touched({100}, 300, 150);
  CHECK(taps_in(samples).at(0).ticks.size() == 50);
  for (std::size_t i = 130; i < samples.size(); ++i) {
    samples[i].alternative = 1;
  }
  CHECK(taps_in(samples).at(0).ticks.size() == 30);
  samples[120].fault = core::TickFault::non_finite_force;
  CHECK(taps_in(samples).at(0).ticks.size() == 20);
}

TEST_CASE("while ticks are skipped the device holds its last force", "[analysis][rendered]") {
  auto samples = touched({100}, 20, 400);
  samples[110].penalty_n = 7.0;
  samples.erase(samples.begin() + 111, samples.begin() + 114);
  const auto taps = taps_in(samples);
  REQUIRE(taps.size() == 1);
  CHECK(taps[0].ticks.size() == 200);
  CHECK(taps[0].ticks[13].parts.penalty_n == 7.0);
  CHECK(taps[0].ticks[14].parts.penalty_n == 2.0);
}

TEST_CASE("forces, waveforms and spectra in a report are what NumPy finds in the traces",
          "[end_to_end][rendered]") {
  const testing::TempDirectory directory;
  const std::string protocol =
      GENERATE(as<std::string>{}, "paper/discrimination.yaml", "paper/reality_finger.yaml");
  const std::string study = simulated(directory, protocol);
  REQUIRE(testing::tapstudy({"report", study}).exit_code == 0);
  const auto compared = testing::run_program(
      {"/usr/bin/python3", testing::source("tests/analysis/report/study/compare_with_numpy.py"),
       study, study + "/report/report.json", testing::shipped(protocol)});
  INFO(protocol << ": " << compared.standard_error);
  CHECK(compared.exit_code == 0);
  const auto fits = testing::run_program(
      {"/usr/bin/python3", testing::source("tests/protocols/validate.py"),
       testing::source("analysis/report/report.schema.json"), study + "/report/report.json"});
  INFO(fits.standard_error);
  CHECK(fits.exit_code == 0);
}

TEST_CASE("a report has the modes that the program finds in the stimulus",
          "[end_to_end][rendered]") {
  const testing::TempDirectory directory;
  const std::string study = simulated(directory, "paper/discrimination.yaml");
  REQUIRE(testing::tapstudy({"report", study, "--only", "rendered"}).exit_code == 0);
  const auto report = nlohmann::json::parse(testing::contents(study + "/report/report.json"));
  CHECK(report.at("blocks").empty());
  const auto modes = nlohmann::json::parse(
      testing::tapstudy({"modes", testing::shipped("paper/discrimination.yaml"), "--stimulus",
                         "acrylic_two", "--json"})
          .standard_output);
  std::vector<double> frequencies_hz;
  std::vector<double> damping_ratios;
  for (const auto& row : report.at("study").at("rendered_modes")) {
    if (row.at("stimulus") == "acrylic_two") {
      frequencies_hz.push_back(row.at("frequency_hz"));
      damping_ratios.push_back(row.at("damping_ratio"));
    }
  }
  CHECK(frequencies_hz.size() == 3);
  CHECK(frequencies_hz == modes.at("frequencies_hz").get<std::vector<double>>());
  CHECK(damping_ratios == modes.at("damping_ratios").get<std::vector<double>>());
  const auto& model = report.at("study").at("rendered_models").at(0);
  CHECK(model.at("stimulus") == "acrylic_two");
  CHECK(model.at("elements") == modes.at("elements"));
  CHECK(model.at("nodes") == modes.at("nodes"));
  CHECK(model.at("worst_residual") == modes.at("worst_residual"));
}

TEST_CASE("without traces one sentence says so, and no figure is drawn", "[end_to_end][rendered]") {
  const testing::TempDirectory directory;
  const std::string study = simulated(directory, "paper/discrimination.yaml", {"--no-traces"});
  REQUIRE(testing::tapstudy({"report", study, "--only", "rendered"}).exit_code == 0);
  const std::string html = testing::contents(study + "/report/report.html");
  CHECK_THAT(html,
             Contains("Forces, speeds and waveforms are left out: this study has no traces."));
  CHECK_THAT(html, !Contains("<figure"));
  const auto report = nlohmann::json::parse(testing::contents(study + "/report/report.json"));
  CHECK(report.at("study").at("rendered_stimuli").size() == 4);
  CHECK_FALSE(report.at("study").contains("rendered_forces"));
}

TEST_CASE("figures are files of their own, and say that they are simulated",
          "[end_to_end][rendered]") {
  const testing::TempDirectory directory;
  const std::string study = simulated(directory, "paper/discrimination.yaml");
  REQUIRE(testing::tapstudy({"report", study}).exit_code == 0);
  const auto parsed = testing::run_program(
      {"/usr/bin/python3", "-c",
       "import glob, sys, xml.etree.ElementTree as tree\n"
       "files = glob.glob(sys.argv[1] + '/report/figures/*.svg')\n"
       "pdf = {file[:-4] for file in glob.glob(sys.argv[1] + '/report/figures/*.pdf')}\n"
       "assert pdf == {file[:-4] for file in files}\n"
       "html = open(sys.argv[1] + '/report/report.html').read()\n"
       "assert len(files) == html.count('<figure') > 10, len(files)\n"
       "for file in files:\n"
       "  text = ''.join(tree.parse(file).getroot().itertext())\n"
       "  assert 'simulated:' in text and 'font:' in text, file\n",
       study});
  INFO(parsed.standard_error);
  CHECK(parsed.exit_code == 0);
}

TEST_CASE("a part that a report does not have is refused with those that it has",
          "[end_to_end][rendered]") {
  const testing::TempDirectory directory;
  const std::string study = simulated(directory, "paper/discrimination.yaml", {"--no-traces"});
  const auto refused = testing::tapstudy({"report", study, "--only", "sessions,nothing"});
  CHECK(refused.exit_code == 2);
  CHECK_THAT(
      refused.standard_error,
      Contains("--only nothing") &&
          Contains("discrimination, mixed_models, sessions, procedures, questionnaires, rendered"));
  REQUIRE(testing::tapstudy({"report", study, "--only", "sessions"}).exit_code == 0);
  const std::string html = testing::contents(study + "/report/report.html");
  CHECK_THAT(html, Contains("How the sessions went") && Contains("SIMULATED") &&
                       !Contains("What was rendered"));
}

TEST_CASE("a part of a report has the numbers that it has in the whole one",
          "[end_to_end][rendered]") {
  const testing::TempDirectory directory;
  const std::string study =
      simulated(directory, "examples/techniques_compared.yaml", {"--no-traces"});
  const auto blocks = [&](const std::vector<std::string>& options) {
    std::vector<std::string> words{"report", study, "--replace"};
    words.insert(words.end(), options.begin(), options.end());
    REQUIRE(testing::tapstudy(words).exit_code == 0);
    return nlohmann::json::parse(testing::contents(study + "/report/report.json")).at("blocks");
  };
  const nlohmann::json all = blocks({});
  for (const nlohmann::json& block : all) {
    const nlohmann::json only = blocks({"--only", block.at("block").get<std::string>()});
    REQUIRE(only.size() == 1);
    // that of the hypothesis, too, which is adjusted for those of other blocks
    CHECK(only.front() == block);
  }
}

TEST_CASE("switches and biases in a report are those of the stored events",
          "[end_to_end][choice]") {
  const testing::TempDirectory directory;
  const std::string study = simulated(directory, "paper/reality_finger.yaml");
  REQUIRE(testing::tapstudy({"report", study}).exit_code == 0);
  const auto compared = testing::run_program(
      {"/usr/bin/python3", "-c",
       "import collections, json, sqlite3, sys\n"
       "db = sqlite3.connect(sys.argv[1] + '/study.db')\n"
       "block = json.load(open(sys.argv[1] + '/report/report.json'))['blocks'][0]\n"
       "pairs, first, last, labels, all = collections.Counter(), 0, 0, collections.Counter(), 0\n"
       "for trial, response in db.execute('SELECT trial_id, response FROM current_response'):\n"
       "  names, shown = zip(*db.execute('SELECT stimulus, label FROM alternative WHERE '\n"
       "                                 'trial_id = ? ORDER BY position', (trial,)))\n"
       "  seen = [names[int(p)] for (p,) in db.execute('SELECT value FROM event WHERE trial_id = ? "
       "'\n"
       "          \"AND kind = 'switch' ORDER BY t_s\", (trial,))]\n"
       "  pairs.update(zip(seen, seen[1:]))\n"
       "  labels[shown[names.index(response)]] += 1\n"
       "  assert len(set(seen)) == 3\n"
       "  all, first, last = all + 1, first + (seen[0] == response), last + (seen[-1] == "
       "response)\n"
       "assert sum(pairs.values()) > 10\n"
       "for row in block['transitions']:\n"
       "  for name in row:\n"
       "    assert name == 'from' or row[name] == pairs[row['from'], name], row\n"
       "said = {(row['chosen_was'], row['label']): row['chosen'] for row in block['biases']}\n"
       "for label in 'ABC':\n"
       "  assert said['under the label', label] == labels[label], said\n"
       "assert said['visited first', None] == first and said['visited last', None] == last, said\n",
       study});
  INFO(compared.standard_error);
  CHECK(compared.exit_code == 0);
}
