#include "analysis/preferences/preference_results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "analysis/paired/thurstone.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
using results::AnswerRow;

Eigen::Index place_of(const BlockDesign& design, const std::string& name) {
  return std::ranges::find(design.stimuli, name, &Item::name) - design.stimuli.begin();
}

constexpr const char* tie = "tie";

struct Comparison {
  Eigen::Index preferred{};
  Eigen::Index other{};
  bool is_first{};  // the preferred one stood at position 0
  bool is_tie{};    // neither was preferred
};

Comparison comparison_of(const BlockDesign& design, const AnswerRow& answer) {
  const auto refuse = [&](const char* what) {
    throw core::InvalidInput{fmt::format("block '{}', {} in trial {}: {}", design.name,
                                         answer.participant_id, answer.number, what)};
  };
  if (answer.alternatives.size() != 2) {
    refuse("a comparison takes two alternatives");
  }
  const std::string& first = answer.alternatives[0].stimulus;
  const std::string& second = answer.alternatives[1].stimulus;
  const auto items = static_cast<Eigen::Index>(design.stimuli.size());
  if (first == second || place_of(design, first) == items || place_of(design, second) == items) {
    refuse("a comparison takes two different stimuli of the block");
  }
  const bool is_tie = design.has_ties && answer.response == tie;
  if (answer.response != first && answer.response != second && !is_tie) {
    refuse("the answer is neither of the two stimuli");
  }
  if (is_tie) {
    return {place_of(design, first), place_of(design, second), false, true};
  }
  const bool is_of_first = answer.response == first;
  return {place_of(design, answer.response), place_of(design, is_of_first ? second : first),
          is_of_first == (answer.alternatives[0].position < answer.alternatives[1].position),
          false};
}

void add(const Comparison& comparison, PairedCounts& counts) {
  if (comparison.is_tie) {
    ++counts.ties(comparison.preferred, comparison.other);
    ++counts.ties(comparison.other, comparison.preferred);
  } else {
    ++counts.wins(comparison.preferred, comparison.other);
  }
}

PairedCounts no_counts(const BlockDesign& design) {
  const auto items = static_cast<Eigen::Index>(design.stimuli.size());
  const Eigen::MatrixXi none = Eigen::MatrixXi::Zero(items, items);
  return {none, design.has_ties ? none : Eigen::MatrixXi{}};
}

// Why a judge's answers do not decide a pair; empty: they do.
std::string undecided(const PairedCounts& counts, Eigen::Index i, Eigen::Index j) {
  const int wins = counts.wins(i, j);
  if (wins != counts.wins(j, i)) {
    return "";
  }
  if (wins > 0) {
    return "a pair was preferred as often either way";
  }
  return counts.ties_of(i, j) > 0 ? "of a pair neither was ever preferred"
                                  : "not every pair was compared";
}

// Of every pair.
std::string undecided(const PairedCounts& counts) {
  if (counts.items() < 3) {
    return "circular triads take three stimuli";
  }
  std::string why;
  for (Eigen::Index i = 0; i < counts.items(); ++i) {
    for (Eigen::Index j = 0; j < i && why.empty(); ++j) {
      why = undecided(counts, i, j);
    }
  }
  return why;
}

void judge_consistency(ParticipantPreferences& person) {
  const Eigen::MatrixXi& wins = person.counts.wins;
  person.no_consistency = undecided(person.counts);
  if (person.no_consistency.empty()) {
    person.consistency =
        consistency((wins.array() > wins.transpose().array()).cast<int>().matrix());
  }
}

void add_scales(PreferenceResults& results) {
  // Comparisons may not connect the items; for Thurstone ties do.
  try {
    BradleyTerry found = bradley_terry(results.counts);
    results.bradley_terry = std::move(found.scale);
    results.nu = found.nu;
  } catch (const core::NotEstimable& error) {
    results.no_scale = error.what();
  }
  try {
    results.thurstone = thurstone_case_v(results.counts);
  } catch (const core::NotEstimable& error) {
    results.no_scale = error.what();
  }
}
}  // namespace

Proportion preferred(const PairedCounts& counts, Eigen::Index item) {
  const std::int64_t wins = counts.wins.row(item).sum();
  return {wins, wins + counts.wins.col(item).sum()};
}

Proportion tied(const PairedCounts& counts) {
  const std::int64_t ties = counts.ties.size() == 0 ? 0 : counts.ties.sum() / 2;
  return {ties, ties + counts.wins.sum()};
}

PreferenceResults preference_results(const BlockDesign& design,
                                     const std::vector<AnswerRow>& answers) {
  PreferenceResults results;
  results.counts = no_counts(design);
  std::map<std::string, ParticipantPreferences> people;
  for (const AnswerRow& answer : answers) {
    const Comparison comparison = comparison_of(design, answer);
    ParticipantPreferences& own = people[answer.participant_id];
    if (own.participant_id.empty()) {
      own.participant_id = answer.participant_id;
      own.counts = no_counts(design);
    }
    add(comparison, own.counts);
    add(comparison, results.counts);
    own.first_position.trials += comparison.is_tie ? 0 : 1;
    own.first_position.successes += comparison.is_first ? 1 : 0;
  }
  for (auto& [name, person] : people) {
    judge_consistency(person);
    results.participants.push_back(std::move(person));
  }
  add_scales(results);
  return results;
}
}  // namespace tapstudy::analysis
