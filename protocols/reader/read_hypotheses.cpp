// Hypotheses that a study declares.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>
#include <utility>

#include "protocols/axes/axis_range.hpp"
#include "protocols/reader/read_sections.hpp"
#include "protocols/schedule/groups.hpp"
#include "protocols/tasks/task.hpp"
namespace tapstudy::protocols {
namespace {
bool compares_means(Claim claim) {
  return claim == Claim::interaction || claim == Claim::equivalent;
}

bool is_of_thresholds(Claim claim) {
  return claim == Claim::threshold_ratio || claim == Claim::threshold_below;
}

std::vector<std::string> names_of_factors(const Protocol& protocol) {
  std::set<std::string> names;
  for (const Stimulus& stimulus : protocol.stimuli) {
    for (const auto& [factor, level] : stimulus.factors) {
      names.insert(factor);
    }
  }
  return {names.begin(), names.end()};
}

// Whether its stimuli have all combinations of two levels or more of both factors.
bool are_crossed(const Block& block, const Protocol& protocol,
                 const std::vector<std::string>& factors) {
  std::set<std::string> first;
  std::set<std::string> second;
  std::set<std::pair<std::string, std::string>> cells;
  for (const std::string& name : block.stimuli) {
    const auto& levels = protocol.stimulus(name).factors;
    if (!levels.contains(factors[0]) || !levels.contains(factors[1])) {
      return false;
    }
    first.insert(levels.at(factors[0]));
    second.insert(levels.at(factors[1]));
    cells.emplace(levels.at(factors[0]), levels.at(factors[1]));
  }
  return first.size() > 1 && second.size() > 1 && cells.size() == first.size() * second.size();
}

void read_interaction(MapReader& reader, const Protocol& protocol, const Block* block,
                      Hypothesis& hypothesis) {
  hypothesis.factors =
      reader.words({"factors", "two, whose effects are expected to depend on one another"},
                   "factor of a stimulus", names_of_factors(protocol));
  reader.check_count("factors", hypothesis.factors, 2, 2, "an interaction is of two factors");
  const bool is_known =
      block != nullptr && hypothesis.factors.size() == 2 &&
      std::ranges::all_of(block->stimuli, [&](const std::string& name) {
        return std::ranges::find(protocol.stimuli, name, &Stimulus::name) != protocol.stimuli.end();
      });
  if (is_known && !are_crossed(*block, protocol, hypothesis.factors)) {
    reader.reject("factors",
                  "the block's stimuli are not all combinations of two levels or more of both");
  }
}

void read_equivalence(MapReader& reader, const Protocol& protocol,
                      const std::vector<std::string>& blocks, const Block* block,
                      Hypothesis& hypothesis) {
  reader.count_given({"to", "to_block"}, MapReader::Presence::required);
  const std::vector<std::string> stimuli =
      block != nullptr ? block->stimuli : stimulus_names(protocol);
  if (reader.has("to_block")) {
    hypothesis.other_block = reader.word(
        {"to_block",
         "block that measures the same, to which this one is expected to be equal, or whose "
         "thresholds are expected to be others; unset: `to`"},
        "block", blocks);
    reader.refuse("stimulus", "is for `to`: blocks are compared whole");
  } else {
    hypothesis.stimulus =
        reader.word({"stimulus",
                     "stimulus of the block that is expected to be chosen, or rated highest, or "
                     "equal to `to`"},
                    "stimulus of the block", stimuli);
    hypothesis.other_stimulus =
        reader.word({"to", "stimulus of the block to which the other is expected to be equal"},
                    "stimulus of the block", stimuli);
  }
  constexpr double largest = 1e6;
  hypothesis.within = reader.number(
      {"within",
       "the largest difference of means that is none: of shares of right answers (0.1), "
       "steps of a rating or marks on its line; of thresholds the largest ratio (1.25); less than "
       "what two means can differ by"},
      Range::positive(largest));
  if (!hypothesis.stimulus.empty() && hypothesis.stimulus == hypothesis.other_stimulus) {
    reader.reject("to", "is the stimulus itself");
  }
  if (!hypothesis.other_block.empty() && hypothesis.other_block == hypothesis.block) {
    reader.reject("to_block", "is the block itself");
  }
}

void read_threshold(MapReader& reader, const std::vector<std::string>& blocks,
                    Hypothesis& hypothesis) {
  constexpr double largest = 1e12;
  if (hypothesis.claim == Claim::threshold_below) {
    hypothesis.below = reader.number(
        {"below",
         "the level that thresholds are expected to lie below, as the block's levels are given"},
        Range::positive(largest));
    return;
  }
  hypothesis.other_block = reader.word(
      {"to_block",
       "block that measures the same, to which this one is expected to be equal, or whose "
       "thresholds are expected to be others; unset: `to`"},
      "block", blocks);
  if (!hypothesis.other_block.empty() && hypothesis.other_block == hypothesis.block) {
    reader.reject("to_block", "is the block itself");
  }
}

void read_groups_compared(MapReader& reader, const Protocol& protocol, const Block* block,
                          Hypothesis& hypothesis) {
  std::vector<std::string> names;
  for (const Group& group : protocol.groups) {
    if (block == nullptr || does(&group, *block)) {
      names.push_back(group.name);
    }
  }
  hypothesis.groups = reader.words(
      {"groups", "two, in which what the block measures of participants is expected to differ"},
      "group that does the block", names);
  reader.check_count("groups", hypothesis.groups, 2, 2, "two groups are compared");
}

// Shares of right answers are compared where the same answers are right, equally often; stimuli
// within participants, who have all of them.
void check_own_stimuli(MapReader& reader, const Protocol& protocol, const Hypothesis& hypothesis,
                       const Block& block) {
  const bool is_of_stimuli = hypothesis.claim == Claim::interaction || !hypothesis.stimulus.empty();
  for (const Group& group : protocol.groups) {
    if (is_of_stimuli && block_of(&group, block).stimuli.size() < block.stimuli.size()) {
      reader.reject("block",
                    fmt::format("group '{}' is not presented all of its stimuli, which are "
                                "compared within participants",
                                group.name));
      return;
    }
  }
  if (hypothesis.groups.size() != 2) {
    return;
  }
  const auto of = [&](const std::string& name) {
    return right_answers(block_of(&protocol.group(name), block));
  };
  if (of(hypothesis.groups[0]) != of(hypothesis.groups[1])) {
    reader.reject("groups",
                  fmt::format("'{}' and '{}' are presented stimuli of this block with other right "
                              "answers: their shares of right answers cannot be compared (allowed: "
                              "stimuli of which the same answers are right, equally often)",
                              hypothesis.groups[0], hypothesis.groups[1]));
  }
}

// What `within` bounds: a difference of means, or a ratio where values are compared by ratios.
struct BoundedValue {
  std::string name;
  bool is_ratio{false};
  double largest{std::numeric_limits<double>::infinity()};  // that there can be
};

BoundedValue adjusted_value(const Adjustment& one, const Adjustment& other) {
  const double low = std::min(one.values.front(), other.values.front());
  const double high = std::max(one.values.back(), other.values.back());
  return one.spacing == Spacing::log ? BoundedValue{"settings", true, high / low}
                                     : BoundedValue{"settings", false, high - low};
}

BoundedValue bounded_value(const Block& block, const Block* other) {
  if (block.comparison && block.comparison->side == Side::either) {
    return {"points of subjective equality"};
  }
  if (block.comparison) {
    return {"thresholds", true};
  }
  if (block.adjustment) {
    const bool are_both =
        other != nullptr && other->adjustment && other->adjustment->axis == block.adjustment->axis;
    return adjusted_value(*block.adjustment, are_both ? *other->adjustment : *block.adjustment);
  }
  if (block.rating && block.rating->kind == ScaleKind::likert) {
    return {fmt::format("ratings in {} steps", block.rating->steps), false,
            block.rating->steps - 1.0};
  }
  return {block.rating ? "marks on a line" : "shares of right answers", false, 1.0};
}

// Whatever is answered, values would be equal within a bound that none can exceed.
void check_bound(MapReader& reader, const Hypothesis& hypothesis, const Block& block,
                 const Block* other) {
  const BoundedValue value = bounded_value(block, other);
  const Range allowed{value.is_ratio ? 1.0 : 0.0, value.largest, false, false};
  if (allowed.contains(hypothesis.within)) {
    return;
  }
  const std::string what = value.is_ratio ? "ratio" : "difference";
  reader.reject("within", fmt::format("{} is not allowed: it is the largest {} of {} that is none "
                                      "({})",
                                      hypothesis.within, what, value.name,
                                      std::isfinite(value.largest)
                                          ? fmt::format("{}: no {} exceeds {:g}", allowed.words(),
                                                        what, value.largest)
                                          : fmt::format("greater than {}", allowed.low)));
}

// What a participant's value of the block is one of; only values of one measure are compared.
std::string measure_of(const Block& block, const Protocol& protocol) {
  if (block.comparison) {
    const Comparison& compared = *block.comparison;
    const char* const what = compared.side == Side::either  ? "points of equality"
                             : compared.side == Side::below ? "thresholds below the standard"
                                                            : "thresholds above the standard";
    return fmt::format("{} of {}{} in {}", what, compared.axis,
                       compared.is_fraction ? " as fractions" : "", block.task->name());
  }
  if (block.adjustment) {
    return "settings of " + block.adjustment->axis;
  }
  if (block.task->claim() == Claim::accuracy_above_chance) {
    return fmt::format("right answers in {}, chance {:.3g}", block.task->name(),
                       block.task->chance_level(block, protocol));
  }
  return fmt::format("answers in {}", block.task->name());
}

void check_measures(MapReader& reader, const Protocol& protocol, const Hypothesis& hypothesis,
                    const Block& block) {
  const Block* const other = protocol.find_block(hypothesis.other_block);
  const bool are_known = other != nullptr && other->task != nullptr && !other->name.empty();
  if (!are_known) {
    return;
  }
  const std::string first = measure_of(block, protocol);
  const std::string second = measure_of(*other, protocol);
  if (first != second) {
    reader.reject("to_block", fmt::format("measures {}, the block {}: what is not one measure is "
                                          "not compared",
                                          second, first));
  }
}

// Answers say little of levels beyond those that the procedures may present, whatever is estimated.
void check_below(MapReader& reader, double below, const Comparison& compared) {
  double low = std::numeric_limits<double>::infinity();
  double high = 0.0;
  for (const auto& track : compared.tracks) {
    const auto [least, greatest] = track->ranges().front();
    low = std::min(low, least);
    high = std::max(high, greatest);
  }
  if (low < high && (below <= low || below >= high)) {
    reader.reject("below", fmt::format("{} is not between the levels that the block presents, {} "
                                       "to {}: answers to these say little of levels beyond",
                                       below, low, high));
  }
}

// Of groups one block is compared, else two.
void check_has_values(MapReader& reader, const Protocol& protocol, const Hypothesis& hypothesis,
                      const Block& block) {
  const bool is_of_groups = hypothesis.claim == Claim::groups_differ;
  if (block.task->claim() != Claim::accuracy_above_chance && !block.adjustment) {
    reader.reject(is_of_groups ? "block" : "to_block",
                  "blocks of this task have no value a participant to compare");
  } else if (!is_of_groups) {
    check_measures(reader, protocol, hypothesis, block);
    check_bound(reader, hypothesis, block, protocol.find_block(hypothesis.other_block));
  }
}

// Blocks are compared by what they measure of a participant, also where procedures choose levels.
void check_fits_task(MapReader& reader, const Protocol& protocol, const Hypothesis& hypothesis,
                     const Block& block) {
  const std::optional<Claim> claim = block.task->claim();
  if (is_of_thresholds(hypothesis.claim)) {
    if (!block.comparison || block.comparison->side == Side::either) {
      reader.reject("block", "has no threshold: its procedures find none");
    } else {
      check_measures(reader, protocol, hypothesis, block);
      if (hypothesis.claim == Claim::threshold_below) {
        check_below(reader, hypothesis.below, *block.comparison);
      }
    }
    return;
  }
  if (!hypothesis.other_block.empty() || hypothesis.claim == Claim::groups_differ) {
    check_has_values(reader, protocol, hypothesis, block);
    return;
  }
  const bool fits = compares_means(hypothesis.claim)
                        ? claim == Claim::accuracy_above_chance || claim == Claim::rated_highest
                        : claim == hypothesis.claim;
  if (!fits) {
    reader.reject("claim", "does not fit the task of the block");
  } else if (block.comparison) {
    reader.reject("block",
                  "has procedures: its threshold is estimated (claims about it: threshold_ratio, "
                  "threshold_below, `equivalent` with `to_block`)");
  } else if (hypothesis.claim == Claim::equivalent) {
    check_bound(reader, hypothesis, block, nullptr);
  }
}

Hypothesis read_hypothesis(MapReader& reader, const std::vector<std::string>& blocks,
                           const Protocol& protocol) {
  Hypothesis hypothesis;
  hypothesis.name = reader.name({"name", "unique among the hypotheses"});
  hypothesis.statement = reader.text({"statement", "the hypothesis in words, for reports"});
  hypothesis.block = reader.word({"block", "name of a block"}, "block", blocks);
  hypothesis.claim = reader.one_of<Claim>(
      {"claim",
       "accuracy_above_chance for tasks with right answers, chosen_above_chance for choice and "
       "paired, rated_highest for rating; interaction (effects of two factors on right answers or "
       "ratings depend on one another) and equivalent (two stimuli, or two blocks, differ by no "
       "more than a bound) for tasks with right answers and rating; threshold_ratio (two blocks' "
       "thresholds differ) and threshold_below (they lie below a level) for blocks with "
       "procedures; groups_differ (in what a block measures of a participant) for tasks with right "
       "answers and adjustment"},
      {{"accuracy_above_chance", Claim::accuracy_above_chance},
       {"chosen_above_chance", Claim::chosen_above_chance},
       {"rated_highest", Claim::rated_highest},
       {"interaction", Claim::interaction},
       {"equivalent", Claim::equivalent},
       {"threshold_ratio", Claim::threshold_ratio},
       {"threshold_below", Claim::threshold_below},
       {"groups_differ", Claim::groups_differ}});
  const Block* const found = protocol.find_block(hypothesis.block);
  const Block* const block = found != nullptr && found->task != nullptr ? found : nullptr;
  if (hypothesis.claim == Claim::interaction) {
    read_interaction(reader, protocol, block, hypothesis);
  } else if (hypothesis.claim == Claim::equivalent) {
    read_equivalence(reader, protocol, blocks, block, hypothesis);
  } else if (is_of_thresholds(hypothesis.claim)) {
    read_threshold(reader, blocks, hypothesis);
  } else if (hypothesis.claim == Claim::groups_differ) {
    read_groups_compared(reader, protocol, block, hypothesis);
  } else if (hypothesis.claim != Claim::accuracy_above_chance) {
    // of another claim there is no stimulus to ask for; a schema's block has no name
    const bool fits =
        block == nullptr || block->name.empty() || block->task->claim() == hypothesis.claim;
    hypothesis.stimulus = reader.word(
        {"stimulus",
         "stimulus of the block that is expected to be chosen, or rated highest, or equal to `to`"},
        "stimulus of the block", block != nullptr ? block->stimuli : stimulus_names(protocol),
        fits ? std::nullopt : std::optional<std::string>{""});
  }
  if (block != nullptr && block->is_practice) {
    reader.reject("block", "is practice, which no report tests");
  } else if (block != nullptr) {
    check_fits_task(reader, protocol, hypothesis, *block);
    check_own_stimuli(reader, protocol, hypothesis, *block);
  }
  return hypothesis;
}
}  // namespace

void read_hypotheses(MapReader& top, Protocol& protocol) {
  std::vector<std::string> blocks;
  std::ranges::transform(protocol.blocks, std::back_inserter(blocks), &Block::name);
  top.list({"hypotheses", "declared before the study; reports test these as planned"},
           MapReader::Presence::optional, [&](MapReader& reader) {
             Hypothesis hypothesis = read_hypothesis(reader, blocks, protocol);
             check_name_is_new(reader, protocol.hypotheses, hypothesis.name, "one");
             protocol.hypotheses.push_back(std::move(hypothesis));
           });
}
}  // namespace tapstudy::protocols
