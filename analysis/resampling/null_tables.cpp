#include "analysis/resampling/null_tables.hpp"

#include <algorithm>
#include <iterator>
#include <memory>
#include <utility>

#include "analysis/resampling/random_table.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
struct Shape {
  std::size_t stimuli{};
  std::size_t responses{};
  CountTable empty() const { return CountTable(stimuli, std::vector<std::int64_t>(responses, 0)); }
};

void count(const std::vector<int>& stimuli, const std::vector<int>& responses, CountTable& table) {
  for (std::size_t i = 0; i < responses.size(); ++i) {
    ++table.at(static_cast<std::size_t>(stimuli.at(i))).at(static_cast<std::size_t>(responses[i]));
  }
}
}  // namespace

NullTables redrawn_tables(std::vector<Answers> participants, Redraw redraw, std::size_t stimuli,
                          std::size_t responses) {
  const Shape shape{stimuli, responses};
  NullTables tables{shape.empty(), {}, 0};
  for (const Answers& answers : participants) {
    if (answers.stimuli.size() != answers.responses.size()) {
      throw core::InvalidInput{"a participant has not as many stimuli as responses"};
    }
    count(answers.stimuli, answers.responses, tables.observed);
    tables.work += answers.responses.size();
  }
  const auto shared = std::make_shared<const std::vector<Answers>>(std::move(participants));
  tables.draw = [shape, shared, redraw = std::move(redraw)](std::uint64_t seed) {
    CountTable table = shape.empty();
    for (std::size_t person = 0; person < shared->size(); ++person) {
      count(redraw(person, seed), (*shared)[person].responses, table);
    }
    return table;
  };
  return tables;
}

NullTables shuffled_tables(const std::vector<CountTable>& participants) {
  NullTables tables{sum_of(participants), {}, work_of_random_tables(participants)};
  std::vector<TableTotals> totals;
  std::ranges::transform(participants, std::back_inserter(totals), totals_of);
  tables.draw = [totals](std::uint64_t seed) {
    core::Rng rng{seed};
    return sum_of_random_tables(totals, rng);
  };
  return tables;
}
}  // namespace tapstudy::analysis
