#include "analysis/statistics/contingency/agreement.hpp"
#include "analysis/statistics/contingency/similarity.hpp"
#include "inference/people.hpp"
#include "inference/rows.hpp"
namespace tapstudy::bench {
namespace {
using analysis::CountTable;

// What a report calls "answers independent": four stimuli, each presented 4 N times, are answered
// right with this probability, with each of the others equally often.
CountTable independent_answers(const StudyDraw& draw, double right) {
  constexpr std::size_t kinds = 4;
  CountTable table(kinds, std::vector<std::int64_t>(kinds, 0));
  for (std::size_t stimulus = 0; stimulus < kinds; ++stimulus) {
    for (int trial = 0; trial < 4 * draw.people; ++trial) {
      const bool is_right = draw.rng.uniform() < right;
      const std::size_t other = is_right ? 0 : 1 + draw.rng.below(kinds - 1);
      ++table[stimulus][(stimulus + other) % kinds];
    }
  }
  return table;
}

std::optional<Outcome> agreement(const StudyDraw& draw) {
  const auto of = analysis::cohens_kappa(independent_answers(draw, 0.7));
  return of ? std::optional{holds(of->interval, (0.7 - 0.25) / 0.75)} : std::nullopt;
}

std::optional<Outcome> p_of(const std::optional<analysis::ChiSquaredTest>& test) {
  return test ? std::optional{Outcome{test->p}} : std::nullopt;
}

std::optional<Outcome> choice_model(const StudyDraw& draw, bool is_conditional) {
  const CountTable table = independent_answers(draw, 0.6);
  const analysis::SimilarityChoice model = analysis::similarity_choice(table);
  if (!model.refusal.empty()) {
    return std::nullopt;
  }
  return Outcome{is_conditional ? conditional_fit(table, model, draw.rng()).p : model.p};
}
}  // namespace

std::vector<Row> rows_of_tables() {
  using enum Kind;
  constexpr const char* task = "identification, answers independent";
  return {
      {coverage, task, "kappa", By::people, agreement},
      {size, task, "i for j as often as j for i", By::people,
       [](const StudyDraw& draw) {
         return p_of(analysis::symmetry_test(independent_answers(draw, 0.6)));
       }},
      {size, task, "named as often as presented", By::people,
       [](const StudyDraw& draw) {
         return p_of(analysis::homogeneity_test(independent_answers(draw, 0.6)));
       }},
      {size, task, "answers depend on stimuli, chi-squared", By::people,
       [](const StudyDraw& draw) {
         return std::optional{
             Outcome{analysis::independence(independent_answers(draw, 0.25)).value().asymptotic_p}};
       }},
      {size, task, "similarity-choice model, chi-squared", By::people,
       [](const StudyDraw& draw) { return choice_model(draw, false); }},
      {size, task, "similarity-choice model, conditional", By::people,
       [](const StudyDraw& draw) { return choice_model(draw, true); }},
  };
}
}  // namespace tapstudy::bench
