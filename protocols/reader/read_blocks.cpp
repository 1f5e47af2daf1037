// Blocks: the parts of a session.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "core/error.hpp"
#include "protocols/reader/read_sections.hpp"
#include "protocols/schedule/ordering.hpp"
#include "protocols/schedule/schedule.hpp"
namespace tapstudy::protocols {
std::optional<std::string> why_not_told_apart(const std::vector<Option>& options) {
  std::map<std::string, std::string> name_of_label;
  for (const Option& option : options) {
    const auto [known, is_new] = name_of_label.emplace(as_it_reads(option.label), option.name);
    if (!is_new) {
      return fmt::format("the answers '{}' and '{}' have the same label, '{}'", known->second,
                         option.name, option.label);
    }
  }
  return std::nullopt;
}

void check_labels_differ(MapReader& block_reader, const Protocol& protocol, const Block& block) {
  if (const auto why = why_not_told_apart(block.task->answers(block, protocol).options)) {
    block_reader.reject(*why);
  }
}

void check_targets(MapReader& block_reader, const Protocol& protocol, const Block& block) {
  if (!block.comparison || block.comparison->side == Side::either ||
      block.task->has_own_guess_rate()) {
    return;
  }
  constexpr double least_above = 0.02;
  const double by_guessing = block.task->guess_rate(block, protocol);
  for (const auto& track : block.comparison->tracks) {
    const auto target = track->settles_at();
    if (target && *target < by_guessing + least_above) {
      block_reader.reject("procedures",
                          fmt::format("one settles at {:.3g} correct, which guessing reaches "
                                      "({:.3g}): its value would wander",
                                      *target, by_guessing));
    }
  }
}

namespace {
// A letter each, which a keyboard of any language has: digits stand for places already, other signs
// are the operator's (:), choose (=) and set (+, -).
std::vector<std::string> letters() {
  std::vector<std::string> all;
  for (char letter = 'a'; letter <= 'z'; ++letter) {
    all.emplace_back(1, letter);
  }
  return all;
}

void check_keys(MapReader& block_reader, const Protocol& protocol, const Block& block) {
  const Answers answers = block.task->answers(block, protocol);
  if (block.keys.empty()) {
    return;
  }
  if (answers.kind != AnswerKind::option) {
    block_reader.reject("keys", "are of options, of which this task has none to pick from");
  } else if (block.keys.size() != answers.options.size()) {
    block_reader.reject(
        "keys", fmt::format("are {}, of {} answers", block.keys.size(), answers.options.size()));
  }
  const auto trials = block.task->trials(block, {});
  for (const std::string& label : trials.empty() ? std::vector<std::string>{}
                                                 : block.task->alternative_labels(trials.front())) {
    if (std::ranges::any_of(block.keys, [&](const std::string& key) {
          return label.size() == 1 && key.front() == label.front() - 'A' + 'a';
        })) {
      block_reader.reject("keys", fmt::format("'{}' is taken: it presents alternative {}",
                                              static_cast<char>(label.front() - 'A' + 'a'), label));
    }
  }
}

using Presence = MapReader::Presence;
constexpr double same_place_m = 1e-3;  // on the device

void check_places(MapReader& top, const Protocol& protocol) {
  for (const auto& [name, plate] : protocol.plates) {
    for (const auto& [point, at_m] : plate->tapping_points_m) {
      const double apart_m =
          protocol.placement.lateral_scale *
          (plate->lateral_ratio * at_m - protocol.tapping_points_m.at(point)).norm();
      if (apart_m > same_place_m) {
        top.reject("plates",
                   fmt::format("{}.tapping_points_m.{}: lies {:.4g} m from the study's {} on the "
                               "device (plates must not be distinguishable by where they are "
                               "tapped; within {} m)",
                               name, point, apart_m, point, same_place_m));
      }
    }
  }
}

std::vector<std::string> task_names() {
  std::vector<std::string> names;
  for (const Task* const task : tasks()) {
    names.emplace_back(task->name());
  }
  return names;
}

OrderConstraints read_constraints(MapReader& block) {
  OrderConstraints constraints;
  block.map(
      {"constraints", "for random orders; all that satisfy them are equally likely; unset: none"},
      Presence::optional, [&](MapReader& reader) {
        if (reader.has("max_run")) {
          constraints.max_run = reader.integer(
              {"max_run", "of one stimulus in a row; 1: no immediate repetition; unset: any"}, 1,
              1000);
        }
        constraints.min_distance = reader.integer(
            {"min_distance", "trials from one presentation of a stimulus to its next; 1: any"}, 1,
            1000, 1);
      });
  return constraints;
}

bool has_catch_trials_of_its_own_stimuli(const Block& block) {
  return block.catch_trials &&
         std::ranges::any_of(block.catch_trials->expected, [&](const auto& expected) {
           return std::ranges::find(block.stimuli, expected.first) != block.stimuli.end();
         });
}

void check_constraints(MapReader& reader, const Block& block) {
  if (block.order == Order::williams && has_catch_trials_of_its_own_stimuli(block)) {
    reader.reject("catch_trials",
                  "of the block's own stimuli would break first-order balance (order: williams; "
                  "catch_trials of another stimulus keep it)");
    return;
  }
  if (!block.constraints.are_any()) {
    return;
  }
  if (has_catch_trials_of_its_own_stimuli(block)) {
    reader.reject("constraints",
                  "would be broken by catch trials of the block's own stimuli (catch_trials of "
                  "another stimulus keep them)");
    return;
  }
  try {
    core::Rng rng{1};
    ordered_conditions(block, rng, {});
  } catch (const core::InvalidInput& error) {
    reader.reject("constraints", error.what());
  }
}

void read_practice(MapReader& reader, Block& block) {
  block.is_practice = reader.yes_or_no({"practice", "excluded from reports"}, false);
  if (!block.is_practice) {
    reader.refuse("criterion", "is for practice: it ends a block by how well it is answered");
    return;
  }
  if (block.task != nullptr && !block.task->has_correct_answer()) {
    reader.refuse("criterion", fmt::format("the task {} has no right answer", block.task->name()));
    return;
  }
  reader.map({"criterion",
              "practice of a task with right answers only: ends the block early; repetitions is "
              "then the most there can be; unset: all trials"},
             Presence::optional, [&](MapReader& inner) {
               PracticeCriterion criterion;
               criterion.of_last = inner.integer(
                   {"of_last", "among so many answers in a row; at most the block's trials"}, 1,
                   1000);
               criterion.correct = inner.integer(
                   {"correct", "so many right answers end the block; at most of_last"}, 1, 1000);
               criterion.must_be_met = inner.one_of<bool>(
                   {"otherwise",
                    "where it is not met: the study begins all the same, or the session ends"},
                   {{"go_on", false}, {"end", true}}, "go_on");
               if (criterion.correct > criterion.of_last) {
                 inner.reject("correct", fmt::format("of {} answers no {} can be right",
                                                     criterion.of_last, criterion.correct));
               }
               block.criterion = criterion;
             });
}

void check_criterion(MapReader& reader, const Block& block) {
  if (!block.criterion) {
    return;
  }
  if (block.comparison) {
    reader.reject("criterion",
                  "is for trials that are planned: procedures may end before it is met");
  } else if (planned_trials(block) < block.criterion->of_last) {
    reader.reject("criterion", fmt::format("the block has {} trials, fewer than of_last",
                                           planned_trials(block)));
  }
}

// A body can be mounted only as it is.
void check_presented(MapReader& reader, const Protocol& protocol, const Block& block) {
  const bool is_virtual = block.presented == Presented::virtual_plates;
  if (!block.task->can_present_real_plates()) {
    reader.check("presented", is_virtual, R"({"const": "virtual"})",
                 fmt::format("the task {} has several alternatives at hand; real plates are "
                             "mounted one at a time",
                             block.task->name()));
  }
  if (is_virtual) {
    return;
  }
  std::map<std::tuple<const Plate*, const Material*, const Contacts*>, std::string> stimulus_of;
  for (const std::string& name : all_presented(block)) {
    const auto stimulus = std::ranges::find(protocol.stimuli, name, &Stimulus::name);
    if (stimulus == protocol.stimuli.end()) {
      continue;  // rejected already
    }
    const auto [known, is_new] = stimulus_of.emplace(
        std::tuple{stimulus->plate.get(), stimulus->material.get(), stimulus->contacts.get()},
        name);
    if (!is_new) {
      reader.reject("stimuli",
                    fmt::format("'{}' and '{}' are the same real plate", known->second, name));
    }
  }
}

void read_presentations(MapReader& reader, const Protocol& protocol, Block& block) {
  block.stimuli = reader.words({"stimuli",
                                "presented, or chosen among; at most 26; at least 2 where several "
                                "are told apart; with procedures one that varies"},
                               "stimulus", stimulus_names(protocol));
  reader.check_count("stimuli", block.stimuli, 0, max_stimuli, "a block has at most 26 stimuli");
  block.repetitions =
      reader.integer({"repetitions",
                      "identification, rating, magnitude: presentations of each stimulus, at each "
                      "of its values; choice and ranking: number of trials; others: presentations "
                      "of each pair in each arrangement; not with procedures"},
                     1, 1000, 1);
  block.order = reader.one_of<Order>(
      {"order",
       "identification, rating and magnitude only: shuffled overall, file order, shuffled per "
       "repetition, or balanced Latin square over participants"},
      {{"shuffle", Order::shuffle},
       {"listed", Order::listed},
       {"shuffle_within_repetition", Order::shuffle_within_repetition},
       {"williams", Order::williams}},
      "shuffle");
}

void read_keys_of_task(MapReader& reader, const Protocol& protocol, Block& block) {
  block.task->read(reader, protocol, block);
  check_presented(reader, protocol, block);
  if (block.gives_feedback && block.allows_correction) {
    reader.reject("correction", "cannot be combined with feedback");
  }
  if (!block.task->has_correct_answer()) {
    reader.check("feedback", !block.gives_feedback, R"({"const": false})",
                 fmt::format("the task {} has no right answer", block.task->name()));
  }
  if (!block.task->uses_order()) {
    reader.refuse("order", "a task that draws alternatives anew in each trial takes no order");
  }
}

// One place, one time of practice and one rhythm of breaks for all blocks that are mixed.
void read_mixed_with(MapReader& reader, const Protocol& protocol, Block& block) {
  std::vector<std::string> names;
  if (!protocol.blocks.empty() && !protocol.blocks.back().is_practice) {
    const Block& last = protocol.blocks.back();
    names.push_back(last.mixed_with.empty() ? last.name : last.mixed_with);
  }
  block.mixed_with = reader.word(
      {"mixed_with",
       "the block before, not practice, or the one that is mixed with: its trials and those of "
       "this one come in one random sequence, in which each block keeps its own order; all "
       "instructions stand before it, breaks are as that one has them; unset: the blocks follow "
       "one another"},
      "block that this one may be mixed with (the one before, not practice)", names, "");
  if (block.mixed_with.empty()) {
    return;
  }
  for (const char* const key : {"practice", "fixed", "breaks"}) {
    reader.refuse(
        key, fmt::format("is that of block '{}', with which this one is mixed", block.mixed_with));
  }
}

// The keys that blocks of every task have; the task reads its own.
Block read_block(MapReader& reader, const Protocol& protocol) {
  Block block;
  block.name = reader.name({"name", "unique among the blocks"});
  block.measure = block.name;
  block.task = find_task(reader.word(
      {"task",
       "identification: which plate is this; choice: switch among blind labels, then choose; "
       "comparison: which is the comparison, along an axis, or of fixed stimuli, listed from the "
       "least to the greatest, the greater one; same_different, odd_one_out, abx: discrimination "
       "of two; paired: which of two, all pairs; ranking: all in order, the first one first; "
       "rating: one on a scale of steps; magnitude: how much, as a number; match_to_sample: which "
       "of several is like the sample; adjustment: one is moved along an axis until it feels equal "
       "to a standard"},
      "task", task_names()));
  block.question = reader.translated({"question", "text that participants are asked"});
  read_presentations(reader, protocol, block);
  read_practice(reader, block);
  block.is_fixed = reader.yes_or_no(
      {"fixed", "stays in its place where block_order moves others, and practice for all of them"},
      false);
  read_mixed_with(reader, protocol, block);
  if (block.task != nullptr && block.task->uses_order()) {
    if (block.order == Order::listed || block.order == Order::williams) {
      reader.refuse("constraints", "are for random orders: this one is given");
    } else {
      block.constraints = read_constraints(reader);
    }
  }
  block.presented = reader.one_of<Presented>(
      {"presented",
       "real: identification or rating of the plates themselves, which the operator mounts; "
       "nothing is rendered or measured"},
      {{"virtual", Presented::virtual_plates}, {"real", Presented::real_plates}}, "virtual");
  block.explore = read_explore(reader, protocol, block.presented);
  read_between_trials(reader, block);
  block.keys = reader.words(
      {"keys",
       "letters that answer, one for each answer in their order, at the terminal and on the page; "
       "none that presents an alternative; unset: 1, 2, …"},
      "letter", letters(), std::vector<std::string>{});
  block.allows_correction = reader.yes_or_no(
      {"correction", "the participant may correct the last answer during the next trial"}, false);
  block.presented_if = read_presented_if(reader, protocol);
  block.forms_after = read_form_names(
      reader, {"forms_after", "names of forms, asked after the block's last trial"}, protocol);
  block.max_late_impact_repeats =
      reader.integer({"max_late_impact_repeats",
                      "a trial with an impact up to 5 ms after a late tick, whose strength is "
                      "uncertain, is presented again, so often at most"},
                     0, 10, 0);
  if (block.task != nullptr) {
    read_keys_of_task(reader, protocol, block);
  }
  return block;
}

void check_block(MapReader& reader, const Block& block, const Protocol& protocol) {
  if (block.order == Order::williams && conditions(block) < 2) {
    reader.reject("order", "a Williams order needs at least two stimuli");
  } else if (block.task != nullptr && !block.stimuli.empty()) {
    check_constraints(reader, block);
    check_labels_differ(reader, protocol, block);
    check_keys(reader, protocol, block);
    check_targets(reader, protocol, block);
    check_criterion(reader, block);
  }
  check_name_is_new(reader, protocol.blocks, block.name, "block");
}
}  // namespace

void read_blocks(MapReader& top, const ReadFile& read_file, Protocol& protocol) {
  constexpr int max_seed = 1'000'000'000;
  protocol.counterbalancing_seed = static_cast<std::uint64_t>(top.integer(
      {"counterbalancing_seed", "assigns the balanced orders (order: williams) to participants"}, 0,
      max_seed, 1));
  top.list({"blocks", "parts of a session, in file order unless block_order says otherwise"},
           Presence::optional, [&](MapReader& reader) {
             const std::size_t earlier_problems = reader.problems_in_file();
             Block block = read_block(reader, protocol);
             block.instructions_picture =
                 read_instructions_picture(reader, block.instructions, read_file, protocol);
             check_block(reader, block, protocol);
             if (reader.problems_in_file() == earlier_problems) {  // only such a block can be drawn
               check_intervals(reader, block);
             }
             protocol.blocks.push_back(block);
           });
  if (!protocol.blocks.empty()) {
    check_places(top, protocol);
  }
}

namespace {
// Blocks exchange their places within a session.
bool can_exchange(const std::vector<std::string>& blocks, const Protocol& protocol) {
  std::map<std::string, int> of_session;
  for (const std::string& name : blocks) {
    const Block* const block = protocol.find_block(name);
    ++of_session[block == nullptr ? "" : block->session];
  }
  return std::ranges::any_of(of_session, [](const auto& session) { return session.second >= 2; });
}
}  // namespace

void read_block_order(MapReader& top, Protocol& protocol) {
  std::vector<std::string> movable;
  for (const Block& block : protocol.blocks) {
    if (!block.is_practice && !block.is_fixed && block.mixed_with.empty()) {
      movable.push_back(block.name);
    }
  }
  top.map(
      {"block_order", "how blocks follow one another; unset: as in the file"}, Presence::optional,
      [&](MapReader& reader) {
        BlockOrder& chosen = protocol.block_order;
        chosen.order = reader.one_of<Order>(
            {"order", "random for each participant, or a balanced Latin square over participants"},
            {{"shuffle", Order::shuffle}, {"williams", Order::williams}});
        chosen.blocks =
            reader.words({"blocks",
                          "those that exchange their places; the others stay where they are. A "
                          "practice block moves with the block after it; one that stands first "
                          "does only where each of these has its own, and one that is mixed with "
                          "another with that one; unset: all but practice, fixed and mixed ones"},
                         "block that may move (not practice, not fixed, not mixed with another)",
                         movable, movable);
        reader.check("blocks", chosen.blocks.size() >= 2, R"({"minItems": 2})",
                     "are not two blocks or more, without practice and fixed ones");
        if (chosen.blocks.size() >= 2 && !can_exchange(chosen.blocks, protocol)) {
          reader.reject(
              "no two of its blocks are of one session, within which they would exchange "
              "their places");
        }
      });
}
}  // namespace tapstudy::protocols
