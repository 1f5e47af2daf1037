// The simulated observer must earn its answers: it is given what a hand felt, never a name.
#include "runner/participants/simulated_observer.hpp"

#include "analysis/choice/choice_summary.hpp"
#include "analysis/identification/identification_summary.hpp"
#include "analysis/report/summary.hpp"
#include "protocols/read_protocol.hpp"
#include "results/store.hpp"
#include "results/stored_answers.hpp"
#include "runner/experiments/simulated_study.hpp"
#include "runner/experiments/study_design.hpp"
#include "support/catch.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using analysis::ConfusionMatrix;
using analysis::Proportion;
using testing::replaced;

namespace {
std::string discrimination() {
  return testing::contents(testing::shipped("paper/discrimination.yaml"));
}
std::string with_noise(const std::string& db, std::string text = discrimination()) {
  return replaced(std::move(text), "noise_db: 14", "noise_db: " + db);
}
analysis::Summary simulated(const std::string& text, int participants, std::uint64_t seed = 7) {
  const testing::TempDirectory directory;
  const protocols::Protocol protocol = protocols::parse_protocol(text, "study.yaml");
  runner::simulate({"study.yaml", directory / "study", participants, seed}, protocol);
  results::Store store = results::Store::open_existing(directory / "study");
  return analysis::summarise(runner::design_of(protocol, results::Mode::simulated),
                             results::stored_answers(store), results::stored_visits(store));
}
const analysis::IdentificationSummary& identification(const analysis::Summary& summary) {
  return dynamic_cast<const analysis::IdentificationSummary&>(*summary.blocks.at(0));
}
// Within four standard errors of guessing.
bool is_chance(const Proportion& accuracy, double chance) {
  const double error = std::sqrt(chance * (1.0 - chance) / static_cast<double>(accuracy.trials));
  return std::abs(accuracy.value() - chance) < 4.0 * error;
}
}  // namespace

TEST_CASE("four physically identical plates give chance", "[runner][observer][slow]") {
  std::string text = with_noise("1");
  for (const char* name : {"mdf_two", "mdf_three"}) {
    const auto at = text.find(std::string{"  "} + name + ":\n");
    const auto material = text.find("material: mdf", at);
    text.replace(material, 13, "material: acrylic");
  }
  for (int i = 0; i < 2; ++i) {
    text = replaced(text, "plate: three_fixations", "plate: two_fixations");
  }
  const analysis::Summary summary = simulated(text, 60);
  CHECK(is_chance(identification(summary).accuracy, 0.25));
}

TEST_CASE("an observer drowned in noise guesses", "[runner][observer][slow]") {
  CHECK(is_chance(identification(simulated(with_noise("1000"), 40)).accuracy, 0.25));
}

TEST_CASE("plates without vibration cannot be told apart", "[runner][observer][slow]") {
  std::string text = with_noise("1");
  for (int i = 0; i < 4; ++i) {
    text = replaced(text, "technique: fem", "technique: none");
  }
  CHECK(is_chance(identification(simulated(text, 40)).accuracy, 0.25));
}

TEST_CASE("shuffled labels give chance", "[runner][observer][slow]") {
  // the answers stay, but the names of the presented stimuli are permuted
  const testing::TempDirectory directory;
  const protocols::Protocol protocol = protocols::parse_protocol(with_noise("1"), "study.yaml");
  runner::simulate({"study.yaml", directory / "study", 40, 7}, protocol);
  results::Store store = results::Store::open_existing(directory / "study");
  auto answers = results::stored_answers(store);
  std::vector<std::string> names;
  for (const auto& answer : answers) {
    names.push_back(answer.stimulus);
  }
  core::Rng rng{3};
  rng.shuffle(names);
  for (std::size_t i = 0; i < answers.size(); ++i) {
    answers[i].stimulus = names[i];
    answers[i].is_correct = answers[i].response == names[i];
  }
  const auto summary =
      analysis::summarise(runner::design_of(protocol, results::Mode::simulated), answers, {});
  CHECK(is_chance(identification(summary).accuracy, 0.25));
}

TEST_CASE("a quiet observer is nearly always right, and noise only makes it worse",
          "[runner][observer][slow]") {
  const double quiet = identification(simulated(with_noise("0.1"), 30)).accuracy.value();
  const double mild = identification(simulated(with_noise("4"), 30)).accuracy.value();
  const double noisy = identification(simulated(with_noise("16"), 30)).accuracy.value();
  CAPTURE(quiet, mild, noisy);
  CHECK(quiet > 0.8);
  CHECK(quiet > mild);
  CHECK(mild > noisy);
  CHECK(noisy > 0.25);
}

TEST_CASE("with little noise and little scatter the matrix is near diagonal",
          "[runner][observer][slow]") {
  const std::string text =
      replaced(with_noise("0.1"), "taps: {points: [P1, P2, P3, P4, P5], taps_per_visit: 10}",
               "taps: {points: [P4], taps_per_visit: 10, scatter_m: 0, speed_spread: 0.02}");
  const analysis::Summary summary = simulated(text, 30);
  const ConfusionMatrix& matrix = identification(summary).matrix;
  for (std::size_t i = 0; i < 4; ++i) {
    INFO(matrix.stimuli[i].name);
    CHECK(Proportion{matrix.counts[i][i], matrix.row_total(i)}.value() > 0.8);
  }
  CHECK(analysis::factor_accuracy(matrix, "structure").value() > 0.98);
}

TEST_CASE("material is confused more than structure, as in the paper's Table 2",
          "[runner][observer][slow]") {
  const auto summary = simulated(discrimination(), 60);
  const ConfusionMatrix& matrix = identification(summary).matrix;
  const double structure = analysis::factor_accuracy(matrix, "structure").value();
  const double material = analysis::factor_accuracy(matrix, "material").value();
  CHECK(structure > material + 0.1);
}

TEST_CASE("the observer chooses what feels like its reference", "[runner][observer][slow]") {
  const std::string text =
      with_noise("1", testing::contents(testing::shipped("paper/reality_vibration.yaml")));
  const auto chosen = [](const analysis::Summary& summary, const std::string& name) {
    const auto& choice = dynamic_cast<const analysis::ChoiceSummary&>(*summary.blocks.at(0));
    for (const auto& alternative : choice.alternatives) {
      if (alternative.item.name == name) {
        return alternative.chosen.value();
      }
    }
    return -1.0;
  };
  CHECK(chosen(simulated(text, 20), "finite_elements") > 0.8);
  CHECK(chosen(simulated(replaced(text, "reference: finite_elements",
                                  "reference: finite_elements, reality: none"),
                         20),
               "no_vibration") > 0.8);
}

TEST_CASE("with nothing felt the answer is a guess", "[runner][observer]") {
  runner::SimulatedObserver observer{{core::Vec3::Zero()}, {1.0, 0.0, 1}, core::Rng{1}};
  const runner::FeltTap tap{core::Vec3::Zero(), {}};
  observer.remember("a", std::vector{tap});
  observer.remember("b", std::vector{tap});
  int first = 0;
  for (int i = 0; i < 1000; ++i) {
    first += observer.most_similar(std::vector<runner::FeltTap>{}, {"a", "b"}) == 0 ? 1 : 0;
  }
  CHECK(first == Approx(500).margin(4.0 * std::sqrt(250.0)));
}

TEST_CASE("techniques of one body are no different realities: telling them apart is chance",
          "[runner][observer][slow]") {
  std::string text = with_noise("1");
  for (const char* technique : {"none", "fem", "fem", "fem"}) {
    text = replaced(text, "technique: fem", std::string{"technique: "} + technique + " ");
  }
  for (const char* name : {"mdf_two", "mdf_three"}) {
    const auto at = text.find(std::string{"  "} + name + ":\n");
    text.replace(text.find("material: mdf", at), 13, "material: acrylic");
  }
  for (int i = 0; i < 2; ++i) {
    text = replaced(text, "plate: three_fixations", "plate: two_fixations");
  }
  CHECK(is_chance(identification(simulated(text, 60)).accuracy, 0.25));
}

TEST_CASE("what a simulated participant answers does not depend on what stimuli are called",
          "[runner][observer][slow]") {
  const auto answers_of = [](const std::string& text) {
    const testing::TempDirectory directory;
    const protocols::Protocol protocol = protocols::parse_protocol(text, "study.yaml");
    runner::simulate({"study.yaml", directory / "study", 4, 7}, protocol);
    std::vector<std::size_t> places;
    auto store = results::Store::open_existing(directory / "study");
    for (const auto& answer : results::stored_answers(store)) {
      const auto& names = protocol.blocks.at(0).stimuli;
      places.push_back(
          static_cast<std::size_t>(std::ranges::find(names, answer.response) - names.begin()));
    }
    return places;
  };
  std::string renamed = discrimination();
  for (const auto& [from, to] :
       {std::pair{"acrylic_two", "zebra"}, std::pair{"mdf_three", "ape"}}) {
    for (auto at = renamed.find(from); at != std::string::npos; at = renamed.find(from)) {
      renamed.replace(at, std::string{from}.size(), to);
    }
  }
  CHECK(answers_of(renamed) == answers_of(discrimination()));
}

TEST_CASE("simulated participants differ by more than chance between answers",
          "[runner][observer][slow]") {
  const auto variance_over_binomial = [](const std::string& people) {
    // many short trials each
    const std::string text =
        replaced(replaced(discrimination(), "repetitions: 2", "repetitions: 8"),
                 "taps_per_visit: 10", "taps_per_visit: 2");
    const auto summary = simulated(text + "  people: {" + people + "}\n", 30);
    const auto& participants = identification(summary).participants;
    double mean = 0.0;
    for (const auto& one : participants) {
      mean += one.accuracy.value() / static_cast<double>(participants.size());
    }
    double variance = 0.0;
    for (const auto& one : participants) {
      variance +=
          std::pow(one.accuracy.value() - mean, 2) / static_cast<double>(participants.size() - 1);
    }
    return variance /
           (mean * (1.0 - mean) / static_cast<double>(participants.front().accuracy.trials));
  };
  const double alike =
      variance_over_binomial("noise_spread: 0, threshold_spread: 0, speed_spread: 0, bias: 0");
  const double unlike = variance_over_binomial("noise_spread: 2, bias: 0");
  CAPTURE(alike, unlike);
  CHECK(alike < 1.0 + 3.0 * std::sqrt(2.0 / 29.0));
  CHECK(unlike > 2.0);
}
