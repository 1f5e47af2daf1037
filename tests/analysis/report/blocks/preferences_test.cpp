#include <fmt/format.h>

#include <cmath>
#include <random>
#include <sstream>

#include "analysis/report/blocks/choices.hpp"
#include "analysis/statistics/scaling/preference_scales.hpp"
#include "core/error.hpp"
#include "support/catch.hpp"
#include "support/formats.hpp"
#include "support/reference_programs.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;

namespace {
// Stimuli a, b, c under the labels A, B, C in this order; what was chosen, and visited.
void add(BlockRows& rows, const std::string& order, char chosen, const std::vector<int>& visited) {
  results::AnswerRow answer;
  answer.trial_id = static_cast<std::int64_t>(rows.answers.size() + 1);
  answer.participant_id = "P01";
  answer.response = std::string(1, chosen);
  for (std::size_t i = 0; i < order.size(); ++i) {
    answer.alternatives.push_back(
        {static_cast<int>(i), std::string(1, "ABC"[i]), std::string(1, order[i])});
  }
  rows.answers.push_back(answer);
  rows.orders.push_back({answer.trial_id, visited});
}

BlockRows five_trials() {
  BlockRows rows;
  add(rows, "abc", 'a', {0, 1, 2, 0});  // under A, visited first and last
  add(rows, "bca", 'b', {0, 1, 2});     // under A, visited first
  add(rows, "cab", 'b', {0, 1, 2});     // under C, visited last
  add(rows, "cab", 'c', {0, 2});        // under A; one was not visited
  add(rows, "abc", 'a', {0, 1, 2});     // under A, visited first
  return rows;
}

BlockDesign of_three() {
  BlockDesign design;
  design.name = "reality";
  design.stimuli = {{"a", "plate a", {}}, {"b", "plate b", {}}, {"c", "plate c", {}}};
  return design;
}
}  // namespace

TEST_CASE("a choice counts by its label, and by when it was visited", "[analysis][choice]") {
  const ChoiceBiases biases = choice_biases(five_trials());
  CHECK(biases.labels == std::vector<std::string>{"A", "B", "C"});
  CHECK(biases.chosen == std::vector<int>{4, 0, 1});
  CHECK(biases.chance == Approx(1.0 / 3.0).epsilon(1e-9));
  CHECK(biases.first_visited.successes == 3);
  CHECK(biases.first_visited.trials == 4);
  CHECK(biases.last_visited.successes == 2);
  // all of 3^5 sequences of labels by their counts
  const auto expected = testing::python_numbers(
      "import itertools, math\n"
      "weight = lambda c: math.factorial(5) / math.prod(map(math.factorial, c))\n"
      "counts = [c for c in itertools.product(range(6), repeat=3) if sum(c) == 5]\n"
      "out(sum(weight(c) for c in counts if weight(c) <= weight((4, 0, 1))) / 243)\n");
  REQUIRE(biases.labels_p);
  CHECK(*biases.labels_p == Approx(expected.at(0)).epsilon(1e-9));
}

TEST_CASE("switches are counted from each stimulus to each, whatever their labels",
          "[analysis][choice]") {
  using Rows = std::vector<std::vector<std::int64_t>>;
  // a b c a, b c a, c a b, c b, a b c
  CHECK(transitions(of_three().stimuli, five_trials()) == Rows{{0, 3, 0}, {0, 0, 3}, {3, 1, 0}});
}

TEST_CASE("the exact two-sided binomial probability is SciPy's", "[analysis][choice]") {
  for (const auto& [k, n, chance] : std::vector<std::tuple<int, int, double>>{
           {7, 10, 1.0 / 3.0}, {0, 12, 0.25}, {5, 10, 0.5}, {40, 90, 1.0 / 3.0}, {1, 1, 0.2}}) {
    const auto expected = testing::python_numbers(fmt::format(
        "from scipy.stats import binomtest\nout(binomtest({}, {}, {}).pvalue)\n", k, n, chance));
    CHECK(binomial_two_sided_p({k, n}, chance) == Approx(expected.at(0)).epsilon(1e-9));
  }
}

TEST_CASE("missing replies are said, and that none is", "[analysis][choice]") {
  BlockRows rows = five_trials();
  std::ostringstream none;
  summarise_choice(of_three(), rows)->write_text(none);
  CHECK_THAT(none.str(), Contains("No reply is missing of 5 trials"));
  rows.missing_replies = 2;
  std::ostringstream some;
  summarise_choice(of_three(), rows)->write_text(some);
  CHECK_THAT(some.str(), Contains("Missing replies: 2 of 7 trials"));
}

using testing::r_numbers;
using testing::reported;

namespace {
constexpr const char* statistic = "paired";
const std::vector<std::string> names{"steel", "wood", "rubber", "glass"};

BlockDesign design_of(std::size_t stimuli) {
  BlockDesign design;
  design.name = "pairs";
  for (std::size_t i = 0; i < stimuli; ++i) {
    design.stimuli.push_back({names[i], names[i], {}});
  }
  return design;
}

results::AnswerRow answer_of(const std::string& participant, const std::string& first,
                             const std::string& second, bool is_first) {
  results::AnswerRow answer;
  answer.participant_id = participant;
  answer.alternatives = {{0, "A", first}, {1, "B", second}};
  answer.response = is_first ? first : second;
  return answer;
}

// P(first) = 1 / (1 + exp(second - first)) of values 0.9, 0.3, -0.3, -0.9
std::vector<results::AnswerRow> judges(int people, int repetitions, std::uint64_t seed) {
  std::mt19937_64 generator{seed};
  std::vector<results::AnswerRow> answers;
  for (int person = 0; person < people; ++person) {
    for (int repetition = 0; repetition < repetitions; ++repetition) {
      for (std::size_t i = 0; i < names.size(); ++i) {
        for (std::size_t j = 0; j < names.size(); ++j) {
          if (i != j) {
            const double distance = 0.6 * (static_cast<double>(i) - static_cast<double>(j));
            const bool is_first =
                std::bernoulli_distribution{1.0 / (1.0 + std::exp(distance))}(generator);
            answers.push_back(
                answer_of("p" + std::to_string(person), names[i], names[j], is_first));
          }
        }
      }
    }
  }
  return answers;
}
}  // namespace

TEST_CASE("the report's scales are those of the counted preferences and hold the assumed values",
          "[analysis][preferences]") {
  const auto answers = judges(10, 10, 3);
  PairedCounts counts{Eigen::MatrixXi::Zero(4, 4), {}};
  std::map<std::string, PairedCounts> people;
  const auto place = [](const std::string& name) {
    return std::ranges::find(names, name) - names.begin();
  };
  for (const results::AnswerRow& answer : answers) {
    const bool is_first = answer.response == answer.alternatives[0].stimulus;
    const auto other = place(answer.alternatives[is_first ? 1 : 0].stimulus);
    ++counts.wins(place(answer.response), other);
    PairedCounts& own =
        people.try_emplace(answer.participant_id, PairedCounts{Eigen::MatrixXi::Zero(4, 4), {}})
            .first->second;
    ++own.wins(place(answer.response), other);
  }
  std::vector<PairedCounts> each;
  for (const auto& [name, own] : people) {
    each.push_back(own);
  }
  const auto json = reported(statistic, design_of(4), answers).json;
  const BradleyTerry scale = bradley_terry(each);
  const PreferenceScale thurstone = thurstone_case_v(each);
  for (std::size_t i = 0; i < 4; ++i) {
    const auto& row = json["scale"][i];
    const auto item = static_cast<Eigen::Index>(i);
    CHECK(row["bradley_terry"].get<double>() == Approx(scale.scale.values[item]).epsilon(1e-9));
    CHECK(row["bradley_terry_low"].get<double>() ==
          Approx(scale.scale.intervals[i].low).epsilon(1e-9));
    CHECK(row["thurstone_high"].get<double>() == Approx(thurstone.intervals[i].high).epsilon(1e-9));
    CHECK(row["bradley_terry"].get<double>() ==
          Approx(0.9 - 0.6 * static_cast<double>(i)).margin(0.25));
    CHECK(row["preferred"] == counts.wins.row(item).sum());
    CHECK(row["preferred_of"] == 600);
  }
  CHECK(json["preferences"][1]["to_rubber"] == counts.wins(1, 2));
  CHECK(json["preferences"][1]["to_wood"].is_null());
}

TEST_CASE("where comparisons do not connect the stimuli there is no scale, and the report says so",
          "[analysis][preferences]") {
  std::vector<results::AnswerRow> answers{answer_of("a", "steel", "wood", true),
                                          answer_of("a", "wood", "rubber", true),
                                          answer_of("a", "steel", "rubber", true)};
  const auto formats = reported(statistic, design_of(3), answers);
  CHECK(formats.json["scale"][0]["bradley_terry"].is_null());
  CHECK(formats.json["scale"][0]["thurstone"].is_null());
  CHECK_THAT(formats.text, Contains("No scale: comparisons do not connect the items"));
  CHECK_THAT(formats.text, Contains("2 wood"));
  CHECK(testing::longest_line(formats.text) <= 100);
}

TEST_CASE("a judge's circular triads are counted where every pair has one answer",
          "[analysis][preferences]") {
  std::vector<results::AnswerRow> circle{answer_of("a", "steel", "wood", true),
                                         answer_of("a", "wood", "rubber", true),
                                         answer_of("a", "rubber", "steel", true)};
  auto json = reported(statistic, design_of(3), circle).json;
  CHECK(json["consistency"][0]["circular_triads"] == 1);
  CHECK(json["consistency"][0]["zeta"] == 0.0);
  circle.pop_back();
  json = reported(statistic, design_of(3), circle).json;
  CHECK(json["consistency"][0]["zeta"].is_null());
  CHECK(json["consistency"][0]["not_computed_because"] == "not every pair was compared");
  circle.push_back(answer_of("a", "rubber", "steel", true));
  circle.push_back(answer_of("a", "rubber", "steel", false));
  json = reported(statistic, design_of(3), circle).json;
  CHECK(json["consistency"][0]["not_computed_because"] ==
        "a pair was preferred as often either way");
}

TEST_CASE(
    "the share of the first position counts position 0, whichever alternative is listed first",
    "[analysis][preferences]") {
  std::vector<results::AnswerRow> answers{
      answer_of("a", "steel", "wood", true), answer_of("a", "steel", "wood", true),
      answer_of("a", "wood", "steel", true), answer_of("a", "steel", "wood", false)};
  std::swap(answers[0].alternatives[0].position, answers[0].alternatives[1].position);
  const auto json = reported(statistic, design_of(2), answers).json;
  CHECK(json["position"][0]["first_preferred"] == 2);
  CHECK(json["position"][0]["first_preferred_of"] == 4);
}

TEST_CASE("a claim of preference is tested by the participants' signs", "[analysis][preferences]") {
  BlockDesign design = design_of(2);
  design.hypotheses = {{"h", "Steel is preferred.", "steel"}};
  std::vector<results::AnswerRow> answers;
  for (int person = 0; person < 9; ++person) {
    for (int i = 0; i < 4; ++i) {  // seven prefer steel, one wood, one neither
      const bool is_steel = person < 7 ? i < 3 : (person == 7 ? i < 1 : i < 2);
      answers.push_back(answer_of("p" + std::to_string(person), "steel", "wood", is_steel));
    }
  }
  const auto json = reported(statistic, design, answers).json;
  CHECK(json["hypotheses"][0]["observed"]["successes"] == 7);
  CHECK(json["hypotheses"][0]["observed"]["trials"] == 8);
  const auto r = r_numbers("out(binom.test(7, 8, 0.5, 'greater')$p.value)");
  CHECK(json["hypotheses"][0]["p"].get<double>() == Approx(r[0]).epsilon(1e-9));
  design.premise = "it is assumed";
  CHECK(reported(statistic, design, answers).json["hypotheses"][0]["p"].is_null());
  design.hypotheses = {{"h", "Gold is preferred.", "gold"}};
  CHECK_THROWS_AS(reported(statistic, design, answers), core::InvalidInput);
}

TEST_CASE("comparisons take two stimuli of the block and one of them as the answer",
          "[analysis][preferences]") {
  CHECK_THROWS_AS(reported(statistic, design_of(2), {answer_of("a", "steel", "gold", true)}),
                  core::InvalidInput);
  CHECK_THROWS_AS(reported(statistic, design_of(2), {answer_of("a", "steel", "steel", true)}),
                  core::InvalidInput);
  auto neither = answer_of("a", "steel", "wood", true);
  neither.response = "both";
  CHECK_THROWS_AS(reported(statistic, design_of(2), {neither}), core::InvalidInput);
  CHECK_THAT(reported(statistic, design_of(2), {}).text, Contains("There are no answers"));
}

TEST_CASE("ties are counted apart, and their nu is that of R's log-linear fit",
          "[analysis][preferences]") {
  BlockDesign design = design_of(3);
  design.has_ties = true;
  std::vector<results::AnswerRow> answers = judges(8, 4, 7);
  std::erase_if(answers, [](const results::AnswerRow& answer) {
    return std::ranges::any_of(answer.alternatives, [](const results::AlternativeRow& alternative) {
      return alternative.stimulus == "glass";
    });
  });
  for (std::size_t i = 0; i < answers.size(); i += 3) {
    answers[i].response = "tie";
  }
  const auto json = reported(statistic, design, answers).json;
  const auto ties = static_cast<int>((answers.size() + 2) / 3);
  CHECK(json["ties"][0]["tied"] == ties);
  CHECK(json["ties"][0]["tied_of"] == answers.size());
  // as a Poisson model of counts: pair, abilities, ties (Davidson 1970)
  std::string counts;
  const auto count_of = [&](const auto& is_counted) {
    counts +=
        (counts.empty() ? "" : ",") + std::to_string(std::ranges::count_if(answers, is_counted));
  };
  using Pair = std::pair<std::size_t, std::size_t>;
  for (const auto& [i, j] : {Pair{0, 1}, Pair{0, 2}, Pair{1, 2}}) {
    const auto is_of_pair = [&, i = i, j = j](const results::AnswerRow& answer) {
      const std::string& a = answer.alternatives[0].stimulus;
      const std::string& b = answer.alternatives[1].stimulus;
      return (a == names[i] && b == names[j]) || (a == names[j] && b == names[i]);
    };
    for (const std::string& response : {names[i], names[j], std::string{"tie"}}) {
      count_of([&](const results::AnswerRow& answer) {
        return is_of_pair(answer) && answer.response == response;
      });
    }
  }
  const auto r = r_numbers("n <- c(" + counts +
                           "); pair <- gl(3, 3); tie <- rep(c(0, 0, 1), 3);"
                           "a <- c(1,0,.5, 1,0,.5, 0,0,0); b <- c(0,1,.5, 0,0,0, 1,0,.5);"
                           "out(exp(coef(glm(n ~ pair + a + b + tie, poisson,"
                           "control = list(epsilon = 1e-14)))[['tie']]))");
  CHECK(json["ties"][0]["nu"].get<double>() == Approx(r[0]).epsilon(1e-9));
  design.has_ties = false;
  CHECK_THROWS_WITH(reported(statistic, design, answers), Contains("neither of the two stimuli"));
}

TEST_CASE("where ties alone connect the stimuli Thurstone's scale is there, Bradley-Terry's is not",
          "[analysis][preferences]") {
  BlockDesign design = design_of(2);
  design.has_ties = true;
  std::vector<results::AnswerRow> answers;
  for (int trial = 0; trial < 12; ++trial) {
    answers.push_back(answer_of("p" + std::to_string(trial % 3), names[0], names[1], true));
    if (trial % 2 == 0) {
      answers.back().response = "tie";
    }
  }
  const auto formats = reported(statistic, design, answers);
  CHECK(formats.json["scale"][0]["bradley_terry"].is_null());
  // 6 wins and 6 halves of 12
  const auto r = r_numbers("out(qnorm(9 / 12) / 2)");
  CHECK(formats.json["scale"][0]["thurstone"].get<double>() == Approx(r[0]).epsilon(1e-9));
  CHECK_THAT(formats.text, Contains("No scale by Bradley-Terry"));
}
