#include "analysis/choice/choice_biases.hpp"

#include <fmt/format.h>

#include <sstream>

#include "analysis/choice/choice_summary.hpp"
#include "support/catch.hpp"
#include "support/python_program.hpp"
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
