#include "runner/studies/methods_section.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <ctime>
#include <functional>
#include <iterator>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "analysis/statistics/quantiles.hpp"
#include "protocols/axes/axis.hpp"
#include "protocols/axes/axis_range.hpp"
#include "protocols/axes/presented_stimulus.hpp"
#include "protocols/protocol.hpp"
#include "protocols/schedule/groups.hpp"
#include "protocols/schedule/ordering.hpp"
#include "protocols/schedule/schedule.hpp"
#include "runner/session/devices/masking_card.hpp"
#include "runner/session/engine/open_study.hpp"
#include "runner/session/engine/planned_sessions.hpp"
#include "runner/session/engine/session_row.hpp"
#include "runner/studies/counted.hpp"
#include "runner/studies/stored_study.hpp"
namespace tapstudy::runner {
using core::citing;
using core::CitingText;
using core::operator""_source;
using protocols::Block;
using protocols::Protocol;
namespace {
// The participants of a group, or all where there are none (nullptr).
struct GroupMembers {
  const protocols::Group* group{};
  std::map<std::string, int> participants;  // and which of the balanced orders each had
};

std::vector<GroupMembers> members_of_groups(const Protocol& protocol,
                                            const std::vector<results::SessionRow>& sessions,
                                            const std::set<std::string>& participants) {
  std::vector<GroupMembers> all;
  for (const protocols::Group* const group : protocols::groups_of(protocol)) {
    all.push_back({group, {}});
    for (const results::SessionRow& session : sessions) {
      const bool is_member =
          group == nullptr || (session.group && session.group->name == group->name);
      if (is_member && participants.contains(session.participant_id)) {
        all.back().participants.emplace(session.participant_id, session.order_index);
      }
    }
  }
  return all;
}

// Of those that do the block.
std::size_t asked_of(const Block& block, const std::vector<GroupMembers>& groups) {
  std::size_t count = 0;
  for (const GroupMembers& members : groups) {
    count += protocols::does(members.group, block) ? members.participants.size() : 0;
  }
  return count;
}

// How many participants of a group had each of the orders of a balanced design.
struct DealtOrders {
  int orders{};
  std::map<std::vector<std::size_t>, int> participants;  // by what stood where

  int all() const {
    return std::accumulate(participants.begin(), participants.end(), 0,
                           [](int sum, const auto& of) { return sum + of.second; });
  }
  bool are_balanced() const {
    return all() % orders == 0 && participants.size() >= static_cast<std::size_t>(orders) &&
           std::ranges::all_of(participants, [&](const auto& of) {
             return of.second == participants.begin()->second;
           });
  }
};

// order_of: of a participant with this order index.
DealtOrders dealt_orders(int orders, const GroupMembers& members,
                         const std::function<std::vector<std::size_t>(int)>& order_of) {
  DealtOrders dealt{orders, {}};
  for (const auto& [participant, order_index] : members.participants) {
    ++dealt.participants[order_of(order_index)];
  }
  return dealt;
}

CitingText describe_williams_orders(const std::vector<DealtOrders>& groups) {
  const auto broken = std::ranges::find_if(
      groups, [](const DealtOrders& dealt) { return dealt.all() > 0 && !dealt.are_balanced(); });
  const char* const whose = groups.size() > 1 ? " of a group" : "";
  return broken == groups.end()
             ? citing(", in orders balanced for immediate sequence over participants{} ({})", whose,
                      "Williams 1949"_source)
             : citing(
                   ", in orders of a balanced design ({}) that {}{} do not complete, of {} orders",
                   "Williams 1949"_source,
                   counted(static_cast<std::size_t>(broken->all()), "participant"), whose,
                   broken->orders);
}

// " with no stimulus twice in a row"; "" without constraints.
std::string describe_constraints(const protocols::OrderConstraints& constraints) {
  std::vector<std::string> limits;
  if (constraints.max_run > 0) {
    limits.push_back(
        constraints.max_run == 1
            ? "no stimulus twice in a row"
            : fmt::format("no stimulus more than {} times in a row", constraints.max_run));
  }
  if (constraints.min_distance > 1) {
    limits.push_back(fmt::format("presentations of a stimulus at least {} trials apart",
                                 constraints.min_distance));
  }
  return limits.empty() ? "" : fmt::format(" with {}", fmt::join(limits, " and "));
}

CitingText describe_williams_order(const Block& block, const Protocol& protocol,
                                   const std::vector<GroupMembers>& groups) {
  const auto place = static_cast<std::size_t>(&block - protocol.blocks.data());
  const auto order_of = [&](int order_index) {
    const auto conditions = protocols::ordered_conditions(
        protocols::block_of(protocols::group_of(protocol, order_index), block),
        protocols::draw_of(protocol.counterbalancing_seed, place, 0,
                           protocols::index_in_group(protocol, order_index)));
    std::vector<std::size_t> order;
    const auto n = std::ssize(conditions) / block.repetitions;
    std::transform(conditions.begin(), conditions.begin() + n, std::back_inserter(order),
                   [](const auto& next) { return next.condition; });
    return order;
  };
  std::vector<DealtOrders> dealt;
  for (const GroupMembers& members : groups) {
    if (protocols::does(members.group, block)) {
      const std::size_t n = protocols::conditions(protocols::block_of(members.group, block));
      dealt.push_back(
          dealt_orders(protocols::williams_rows(static_cast<int>(n)), members, order_of));
    }
  }
  return describe_williams_orders(dealt);
}

bool have_own_stimuli(const Block& block, const std::vector<GroupMembers>& groups) {
  return std::ranges::any_of(groups, [&](const GroupMembers& members) {
    return members.group != nullptr && members.group->stimuli.contains(block.name);
  });
}

// ", in random order"; "" where the block's task has an order of its own.
CitingText describe_order(const Block& block, const Protocol& protocol,
                          const std::vector<GroupMembers>& groups) {
  if (!block.task->uses_order()) {
    return "";
  }
  switch (block.order) {
    case protocols::Order::listed:
      return fmt::format(", in one order for all{}",
                         have_own_stimuli(block, groups) ? " of a group" : "");
    case protocols::Order::shuffle:
      return ", in random order" + describe_constraints(block.constraints);
    case protocols::Order::shuffle_within_repetition:
      return ", in an order that was random within each repetition" +
             describe_constraints(block.constraints);
    case protocols::Order::williams:
      return describe_williams_order(block, protocol, groups);
  }
  return "";
}

bool have_own_blocks(const std::vector<GroupMembers>& groups, const Protocol& protocol) {
  return std::ranges::any_of(groups, [&](const GroupMembers& members) {
    return !std::ranges::all_of(
        protocol.blocks, [&](const Block& block) { return protocols::does(members.group, block); });
  });
}

// "Each participant did 'a' (…), then 'b' (…). ", or how the blocks followed one another.
// blocks: their descriptions.
CitingText describe_sequence(const Protocol& protocol, const std::string& who,
                             const std::vector<CitingText>& blocks,
                             const std::vector<GroupMembers>& groups) {
  const protocols::BlockOrder& order = protocol.block_order;
  const bool have_own_orders = std::ranges::any_of(groups, [](const GroupMembers& members) {
    return members.group != nullptr && !members.group->block_order.empty();
  });
  const bool differ = have_own_blocks(groups, protocol);
  const CitingText done = differ || have_own_orders
                              ? citing("Each group did {}these blocks, in this order{}: {}",
                                       differ ? "its own of " : "",
                                       have_own_orders ? " where it has none of its own" : "",
                                       core::joined(blocks, "; "))
                              : citing("{} did {}", who, core::joined(blocks, ", then "));
  if (order.order == protocols::Order::listed) {
    return citing("{}. ", done);
  }
  const auto order_of = [&](int order_index) {
    return protocols::block_sequence(protocol, 0, order_index);
  };
  std::vector<DealtOrders> dealt;
  std::ranges::transform(groups, std::back_inserter(dealt), [&](const GroupMembers& members) {
    return dealt_orders(protocols::balanced_block_orders(protocol, members.group), members,
                        order_of);
  });
  return citing("{}, where '{}' exchanged their places among participants{}{}. ", done,
                fmt::join(order.blocks, "', '"),
                have_own_orders ? " of groups without an order of their own" : "",
                order.order == protocols::Order::shuffle ? CitingText{", in random order"}
                                                         : describe_williams_orders(dealt));
}

std::string apparatus(const std::vector<results::SessionRow>& sessions) {
  std::set<std::string> devices;
  for (const results::SessionRow& session : sessions) {
    devices.insert(fmt::format("{} at {} Hz", session.device, session.rate_hz));
  }
  return fmt::format("Apparatus: {}. ", fmt::join(devices, "; "));
}

// "3000", or what the stimuli have of their own and along what they vary.
std::string contact_stiffness(const Protocol& protocol, const std::set<std::string>& rendered) {
  std::vector<double> all;
  for (const protocols::Stimulus& stimulus : protocol.stimuli) {
    if (!rendered.contains(stimulus.name)) {
      continue;
    }
    for (const protocols::AxisRange& vary : stimulus.vary) {
      if (vary.axis->name == "penalty_stiffness_n_per_m") {
        all.insert(all.end(), {vary.from, vary.to});
      }
    }
    all.push_back(stimulus_with(protocol, stimulus).rendering.penalty_stiffness_n_per_m);
  }
  const auto [least, most] = std::ranges::minmax(all);
  return least == most ? fmt::format("{:g}", least) : fmt::format("{:g} to {:g}", least, most);
}

// "" if the device rendered nothing.
std::string rendering(const Protocol& protocol, const DoneBlocks& done) {
  const std::set<std::string> rendered = rendered_stimuli(protocol, done);
  std::set<std::string_view> techniques;
  bool vibrates = false;
  for (const protocols::Stimulus& stimulus : protocol.stimuli) {
    if (rendered.contains(stimulus.name)) {
      techniques.insert(stimulus.technique->name);
      vibrates = vibrates || stimulus.technique->needs_model();
    }
  }
  if (techniques.empty()) {
    return "";
  }
  const auto& crossover = protocol.rendering.crossover;
  return fmt::format(
      "Contact was rendered by a spring of {} N/m with {} {}{}{}. ",
      contact_stiffness(protocol, rendered),
      techniques.size() == 1 ? "the technique" : "the techniques", fmt::join(techniques, ", "),
      vibrates ? fmt::format("; modes of vibration up to {:g} Hz", protocol.band_limit_hz) : "",
      crossover ? fmt::format("; an actuator beside the device took over from {:g} to {:g} Hz",
                              crossover->low_hz, crossover->high_hz)
                : "");
}

std::string describe_practice(const Block& block) {
  if (!block.is_practice) {
    return "";
  }
  return fmt::format(" as practice{}{}", block.gives_feedback ? " with feedback" : "",
                     block.criterion
                         ? fmt::format(" until {} of the last {} answers were right",
                                       block.criterion->correct, block.criterion->of_last)
                         : "");
}

// "levels by QUEST+ (Watson 2017)", alike procedures taken together.
CitingText describe_levels(const Block& block) {
  if (!block.comparison) {
    return "";
  }
  std::map<CitingText, int> tracks;
  for (const auto& track : block.comparison->tracks) {
    ++tracks[track->describe()];
  }
  std::vector<CitingText> parts;
  for (const auto& [procedure, count] : tracks) {
    parts.push_back(count == 1 ? procedure
                               : citing("{} interleaved tracks of {}", count, procedure));
  }
  const auto quantity = [](const std::string& axis) {
    return protocols::find_axis(axis)->quantity;
  };
  std::vector<std::string_view> further;
  std::ranges::transform(block.comparison->further_axes, std::back_inserter(further), quantity);
  return citing(", levels of {}{} by {}", quantity(block.comparison->axis),
                further.empty() ? "" : fmt::format(" and values of {}", fmt::join(further, ", ")),
                core::joined(parts, " and "));
}

std::string describe_taps(const Block& block) {
  const auto& taps = block.explore.scripted_taps;
  return taps ? fmt::format(
                    ", scripted taps at {} of {:g} m/s, {:g} s each and {:g} s apart, felt "
                    "with the device held still",
                    taps->point, taps->speed_m_s, taps->dwell_s, taps->pause_s)
              : "";
}

// The completed share of the block, if not all participants did all of it; the total is unknown
// where a block may end early.
std::string describe_completion(const Block& block, const results::BlockCourseRow& done,
                                const std::vector<GroupMembers>& groups) {
  const std::size_t participants = asked_of(block, groups);
  std::string words = block.presented_if ? fmt::format(", only for those who answered {}",
                                                       describe(*block.presented_if))
                                         : "";
  if (done.participants.size() < participants) {
    words += fmt::format(", by {} of {} participants", done.participants.size(), participants);
  }
  std::size_t planned = 0;
  for (const GroupMembers& members : groups) {
    const auto trials = protocols::planned_trials(protocols::block_of(members.group, block));
    const auto who = std::ranges::count_if(members.participants, [&](const auto& person) {
      return !block.presented_if || done.participants.contains(person.first);
    });
    planned += protocols::does(members.group, block) ? static_cast<std::size_t>(trials * who) : 0;
  }
  if (!may_end_early(block) && static_cast<std::size_t>(done.answered) < planned) {
    words += fmt::format(", {} of {} answers given", done.answered, planned);
  }
  return words;
}

// "24 trials", or "12 to 24 trials" where groups have fewer stimuli.
std::string described_trials(const Block& block, const std::vector<GroupMembers>& groups) {
  std::set<int> trials;
  for (const GroupMembers& members : groups) {
    if (protocols::does(members.group, block)) {
      trials.insert(protocols::planned_trials(protocols::block_of(members.group, block)));
    }
  }
  const std::string most = counted(static_cast<std::size_t>(*trials.rbegin()), "trial");
  return trials.size() > 1 ? fmt::format("{} to {}", *trials.begin(), most) : most;
}

CitingText describe_block(const Block& block, const results::BlockCourseRow& done,
                          const Protocol& protocol, const std::vector<GroupMembers>& groups) {
  const bool are_own = have_own_stimuli(block, groups);
  return citing(
      "'{}' ({} of {}{}{}, {}{}{}{}{}{}{}{}{})", block.name, block.task->name(),
      block.stimuli.size() == 1 ? "one stimulus" : fmt::format("{} stimuli", block.stimuli.size()),
      are_own ? ", of which groups were presented their own" : "",
      block.presented == protocols::Presented::real_plates ? ", the real plates themselves" : "",
      may_end_early(block) ? "at most " : "", described_trials(block, groups),
      block.catch_trials ? fmt::format(", {} of them catch trials", block.catch_trials->count) : "",
      block.confidence ? fmt::format(", each with confidence in {} steps", block.confidence->steps)
                       : "",
      describe_order(block, protocol, groups), describe_levels(block), describe_taps(block),
      describe_practice(block), describe_completion(block, done, groups));
}

// Letters that stand for something else in each trial, and are what is answered.
bool has_blind_labels(const Block& block, const Protocol& protocol) {
  const protocols::Answers answers = block.task->answers(block, protocol);
  return !answers.options.empty() && answers.options.front().name == protocols::blind_label(0);
}

// The requirements of an answer in the block, as a sentence without its subject; or "".
std::string exploration(const Block& block) {
  std::vector<std::string> limits;
  if (block.presented == protocols::Presented::virtual_plates && block.explore.min_contacts > 0) {
    const auto trials = block.task->trials(block, {});
    const bool has_several = !block.task->alternative_labels(trials.front()).empty();
    const bool is_each = has_several && block.explore.must_visit_all;
    limits.push_back(fmt::format(
        "at least {}{}", counted(static_cast<std::size_t>(block.explore.min_contacts), "contact"),
        is_each ? " with each alternative" : ""));
  }
  if (block.explore.min_seconds > 0.0) {
    limits.push_back(fmt::format("at least {:g} s", block.explore.min_seconds));
  }
  std::vector<std::string> sentence;
  if (!limits.empty()) {
    sentence.push_back(fmt::format("required {}", fmt::join(limits, " and ")));
  }
  if (block.explore.max_seconds) {
    sentence.push_back(fmt::format("had to come within {:g} s", *block.explore.max_seconds));
  }
  return fmt::format("{}", fmt::join(sentence, " and "));
}

std::string explorations(const Protocol& protocol, const DoneBlocks& done) {
  std::vector<std::pair<std::string, std::vector<std::string>>> blocks_of;  // by what it took
  for (const Block& block : protocol.blocks) {
    if (!done.contains(block.name)) {
      continue;
    }
    const std::string took = exploration(block);
    auto of = std::ranges::find(blocks_of, took, &decltype(blocks_of)::value_type::first);
    if (of == blocks_of.end()) {
      blocks_of.emplace_back(took, std::vector<std::string>{});
      of = std::prev(blocks_of.end());
    }
    of->second.push_back("'" + block.name + "'");
  }
  std::string text;
  for (const auto& [took, blocks] : blocks_of) {
    const std::string where =
        blocks_of.size() == 1 ? "" : fmt::format(" in {}", fmt::join(blocks, ", "));
    text += took.empty() ? "" : fmt::format("An answer{} {}. ", where, took);
  }
  return text;
}

// Only for human participants: a simulated one sees nothing.
std::string blinding(const Protocol& protocol, const DoneBlocks& done) {
  const bool are_labels_blind = std::ranges::any_of(protocol.blocks, [&](const Block& block) {
    return done.contains(block.name) && has_blind_labels(block, protocol);
  });
  return fmt::format(
      "Blinding: what participants saw did not depend on what was rendered{}; the operator's "
      "page, where it was open, {} what was presented. ",
      are_labels_blind
          ? ", and alternatives had letters whose meaning was drawn anew for each trial"
          : "",
      protocol.display.is_operator_blind ? "did not show" : "showed");
}

// Only for human participants: a simulated one hears nothing.
std::string masking(const Protocol& protocol, const DoneBlocks& done) {
  if (!protocol.masking) {
    return "";
  }
  int answered = 0;
  int masked = 0;
  for (const auto& [block, row] : done) {
    answered += row.answered;
    masked += row.masked;
  }
  const std::string noise = described(*protocol.masking);
  if (masked == 0) {
    return fmt::format("Masking: the protocol asks for {}; none was played. ", noise);
  }
  return fmt::format(
      "Masking: {}, played in {}. ", noise,
      masked == answered ? "every trial" : fmt::format("{} of {} trials", masked, answered));
}

// "Questionnaires: 'load' (asked: session end). " Not of blocks that nobody answered.
CitingText questionnaires(const Protocol& protocol, const DoneBlocks& done) {
  std::vector<CitingText> forms;
  for (analysis::Questionnaire& form : questionnaires_of(protocol)) {
    std::erase_if(form.asked, [&](const std::string& place) {
      return protocol.find_block(place) != nullptr && !done.contains(place);
    });
    if (form.asked.empty()) {
      continue;
    }
    forms.push_back(citing(
        "'{}'{} (asked: {})", form.name,
        form.is_mean_scored ? citing(", the raw NASA-TLX ({})", "Hart 2006"_source) : CitingText{},
        fmt::join(form.asked, ", ")));
  }
  return forms.empty() ? "" : citing("Questionnaires: {}. ", core::joined(forms, "; "));
}

// ", in the order 'b', 'a', presented of 'test' 'mdf_two', 'mdf_three'"
std::string described_differences(const protocols::Group& group) {
  std::string words = group.block_order.empty() ? ""
                                                : fmt::format(", in the order '{}'",
                                                              fmt::join(group.block_order, "', '"));
  for (const auto& [block, stimuli] : group.stimuli) {
    words += fmt::format(", presented of '{}' '{}'", block, fmt::join(stimuli, "', '"));
  }
  return words;
}

// "" where the protocol has none. Of excluded participants nothing is said.
CitingText describe_groups(const std::vector<GroupMembers>& groups,
                           const std::vector<results::SessionRow>& sessions) {
  if (groups.front().group == nullptr) {
    return "";
  }
  std::vector<std::string> described;
  std::set<std::string> given;
  for (const GroupMembers& members : groups) {
    described.push_back(fmt::format(
        "'{}' (n = {}) did '{}'{}", members.group->label, members.participants.size(),
        fmt::join(members.group->blocks, "', '"), described_differences(*members.group)));
    for (const results::SessionRow& session : sessions) {
      if (session.group && session.group->is_given &&
          members.participants.contains(session.participant_id)) {
        given.insert(session.participant_id);
      }
    }
  }
  return citing("Groups: {}. Participants were assigned by permuted blocks of {} ({}){}. ",
                fmt::join(described, "; "), groups.size(), "Schulz & Grimes 2002"_source,
                given.empty()
                    ? ""
                    : fmt::format("; the operator chose the group of {} of them", given.size()));
}

// "24.1 to 26.3 h (median 25) after the one before began"; "" of simulated ones.
std::string described_times(const protocols::PlannedSession& planned,
                            const std::vector<results::SessionRow>& sessions) {
  // The first row of each: one may be resumed, perhaps when nothing of it was left.
  std::map<std::string, const results::SessionRow*> latest;  // by participant
  std::vector<double> hours;
  for (const results::SessionRow& session : sessions) {
    const results::SessionRow*& before = latest[session.participant_id];
    if (before != nullptr && before->planned_session == session.planned_session) {
      continue;
    }
    if (before != nullptr && session.planned_session == planned.name) {
      hours.push_back(
          std::difftime(time_from(session.started_utc), time_from(before->started_utc)) / 3600.0);
    }
    before = &session;
  }
  if (hours.empty() || sessions.front().mode == results::Mode::simulated) {
    return "";
  }
  const auto [least, most] = std::ranges::minmax(hours);
  return fmt::format(", {:.3g} to {:.3g} h (median {:.3g} h) after the one before began", least,
                     most, analysis::quantile(hours, 0.5));
}

// "" where participants came once.
std::string describe_planned_sessions(const Protocol& protocol,
                                      const std::vector<results::SessionRow>& sessions,
                                      const std::set<std::string>& participants) {
  std::vector<std::string> described;
  for (const protocols::PlannedSession& planned : protocol.sessions) {
    std::set<std::string> came;
    for (const results::SessionRow& session : sessions) {
      if (session.planned_session == planned.name &&
          participants.contains(session.participant_id)) {
        came.insert(session.participant_id);
      }
    }
    const std::string interval = described_interval(planned);
    described.push_back(fmt::format(
        "'{}' (n = {}; '{}'{}){}", planned.name, came.size(), fmt::join(planned.blocks, "', '"),
        interval.empty() ? "" : "; planned: " + interval, described_times(planned, sessions)));
  }
  return described.empty() ? ""
                           : fmt::format("Participants came to {} sessions: {}. ", described.size(),
                                         fmt::join(described, "; "));
}

// "" where all sessions had the study's texts.
std::string changed_texts(const Protocol& protocol,
                          const std::vector<results::SessionRow>& sessions) {
  std::map<std::string, std::vector<std::int64_t>> sessions_of;  // by text
  for (const results::SessionRow& session : sessions) {
    if (session.protocol_text) {
      sessions_of[*session.protocol_text].push_back(session.id);
    }
  }
  std::string words;
  for (const auto& [text, ids] : sessions_of) {
    std::vector<std::string> changes;
    std::ranges::transform(changes_in(protocol, text).texts, std::back_inserter(changes),
                           [](const protocols::ChangedText& one) { return described(one); });
    if (!changes.empty()) {
      words += fmt::format(
          "In {} of {} sessions (the first is session {}) texts were not those of "
          "the study's beginning: {}. ",
          ids.size(), sessions.size(), ids.front(), fmt::join(changes, "; "));
    }
  }
  return words;
}

// Blocks that no participant started.
std::string unstarted_blocks(const Protocol& protocol, const DoneBlocks& done) {
  std::vector<std::string> names;
  for (const Block& block : protocol.blocks) {
    if (!done.contains(block.name)) {
      names.push_back("'" + block.name + "'");
    }
  }
  return names.empty() ? "" : fmt::format("Without an answer: {}. ", fmt::join(names, ", "));
}
// With the described block before it, as a leader and its blocks that follow one another are.
bool is_mixed(const Block& block, const Protocol& protocol, const DoneBlocks& done) {
  return &protocol.leader(block) != &block && done.contains(protocol.leader(block).name);
}
}  // namespace

core::CitingText describe_procedure(const Protocol& protocol,
                                    const std::vector<results::SessionRow>& sessions,
                                    const std::set<std::string>& participants,
                                    const DoneBlocks& done) {
  const std::vector<GroupMembers> groups = members_of_groups(protocol, sessions, participants);
  std::vector<CitingText> blocks;
  bool is_by_all = true;
  for (const Block& block : protocol.blocks) {
    const auto row = done.find(block.name);
    if (row != done.end()) {
      CitingText described = describe_block(block, row->second, protocol, groups);
      if (is_mixed(block, protocol, done)) {
        blocks.back() += citing(", mixed at random with {}", described);
      } else {
        blocks.push_back(std::move(described));
      }
      is_by_all = is_by_all && row->second.participants.size() == participants.size();
    }
  }
  const bool are_people = sessions.front().mode != results::Mode::simulated;
  CitingText text = apparatus(sessions) + rendering(protocol, done);
  text += describe_groups(groups, sessions);
  text += describe_planned_sessions(protocol, sessions, participants);
  text +=
      describe_sequence(protocol, is_by_all ? "Each participant" : "Participants", blocks, groups);
  text += changed_texts(protocol, sessions);
  text += unstarted_blocks(protocol, done);
  text += explorations(protocol, done);
  if (are_people) {
    text += blinding(protocol, done) + masking(protocol, done);
    text += questionnaires(protocol, done);
  }
  return text;
}
}  // namespace tapstudy::runner
