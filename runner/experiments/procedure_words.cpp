#include "runner/experiments/procedure_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "protocols/axes/axis.hpp"
#include "protocols/block_order.hpp"
#include "protocols/ordering.hpp"
#include "protocols/schedule.hpp"
#include "runner/devices/masking_noise.hpp"
#include "runner/experiments/counted.hpp"
namespace tapstudy::runner {
namespace {
using protocols::Block;
using protocols::Protocol;

std::string apparatus(const std::vector<results::SessionRow>& sessions) {
  std::set<std::string> devices;
  for (const results::SessionRow& session : sessions) {
    devices.insert(fmt::format("{} at {} Hz", session.device, session.rate_hz));
  }
  return fmt::format("Apparatus: {}. ", fmt::join(devices, "; "));
}

std::string rendering(const Protocol& protocol) {
  std::set<std::string_view> techniques;
  bool vibrates = false;
  for (const protocols::Stimulus& stimulus : protocol.stimuli) {
    techniques.insert(stimulus.technique->name);
    vibrates = vibrates || stimulus.technique->needs_model();
  }
  return fmt::format(
      "Contact was rendered by a spring of {:g} N/m with {} {}{}. ",
      protocol.rendering.penalty_stiffness_n_per_m,
      techniques.size() == 1 ? "the technique" : "the techniques", fmt::join(techniques, ", "),
      vibrates ? fmt::format("; modes of vibration up to {:g} Hz", protocol.band_limit_hz) : "");
}

// Balance holds for whole sets of orders.
std::string williams_words(int of_orders, std::size_t participants) {
  const auto orders = static_cast<std::size_t>(of_orders);
  return participants % orders == 0
             ? ", in orders balanced for immediate sequence over participants (Williams 1949)"
             : fmt::format(
                   ", in orders of a balanced design (Williams 1949) that {} do not "
                   "complete, of {} orders",
                   counted(participants, "participant"), orders);
}

std::string order_words(const Block& block, std::size_t participants) {
  if (!block.task->uses_order()) {
    return "";
  }
  switch (block.order) {
    case protocols::Order::listed:
      return ", in one order for all";
    case protocols::Order::shuffle:
      return ", in random order";
    case protocols::Order::shuffle_within_repetition:
      return ", in an order that was random within each repetition";
    case protocols::Order::williams:
      return williams_words(protocols::williams_sequences(
                                static_cast<int>(protocols::conditions(block)), block.repetitions),
                            participants);
  }
  return "";
}

// "Each participant did 'a' (…), then 'b' (…). ", or how the blocks followed one another.
std::string sequence_words(const Protocol& protocol, const std::vector<std::string>& blocks,
                           std::size_t participants) {
  const protocols::BlockOrder& order = protocol.block_order;
  if (order.order == protocols::Order::listed) {
    return fmt::format("Each participant did {}. ", fmt::join(blocks, ", then "));
  }
  return fmt::format(
      "Each participant did {}, where '{}' exchanged their places among participants{}. ",
      fmt::join(blocks, ", then "), fmt::join(order.blocks, "', '"),
      order.order == protocols::Order::shuffle
          ? ", in random order"
          : williams_words(protocols::balanced_block_orders(protocol), participants));
}

std::string practice_words(const Block& block) {
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
std::string level_words(const Block& block) {
  if (!block.comparison) {
    return "";
  }
  std::map<std::string, int> tracks;
  for (const auto& track : block.comparison->tracks) {
    ++tracks[track->words()];
  }
  std::vector<std::string> parts;
  for (const auto& [words, count] : tracks) {
    parts.push_back(count == 1 ? words : fmt::format("{} interleaved tracks of {}", count, words));
  }
  const auto quantity = [](const std::string& axis) {
    return protocols::find_axis(axis)->quantity;
  };
  std::vector<std::string_view> further;
  std::ranges::transform(block.comparison->further_axes, std::back_inserter(further), quantity);
  return fmt::format(
      ", levels of {}{} by {}", quantity(block.comparison->axis),
      further.empty() ? "" : fmt::format(" and values of {}", fmt::join(further, ", ")),
      fmt::join(parts, " and "));
}

std::string tap_words(const Block& block) {
  const auto& taps = block.explore.scripted_taps;
  return taps ? fmt::format(
                    ", scripted taps at {} of {:g} m/s, {:g} s each and {:g} s apart, felt "
                    "with the device held still",
                    taps->point, taps->speed_m_s, taps->dwell_s, taps->pause_s)
              : "";
}

std::string block_words(const Block& block, std::size_t participants) {
  const auto trials = static_cast<std::size_t>(protocols::planned_trials(block));
  return fmt::format(
      "'{}' ({} of {}{}, {}{}{}{}{}{}{}{})", block.name, block.task->name(),
      block.stimuli.size() == 1 ? "one stimulus" : fmt::format("{} stimuli", block.stimuli.size()),
      block.presented == protocols::Presented::real_plates ? ", the real plates themselves" : "",
      may_end_early(block) ? "at most " : "", counted(trials, "trial"),
      block.catch_trials ? fmt::format(", {} of them catch trials", block.catch_trials->count) : "",
      block.confidence ? fmt::format(", each with confidence in {} steps", block.confidence->steps)
                       : "",
      order_words(block, participants), level_words(block), tap_words(block),
      practice_words(block));
}

// Letters that stand for something else in each trial, and are what is answered.
bool has_blind_labels(const Block& block, const Protocol& protocol) {
  const protocols::Answers answers = block.task->answers(block, protocol);
  return !answers.options.empty() && answers.options.front().name == protocols::blind_label(0);
}

// What an answer to the block took.
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
  if (block.explore.max_seconds) {
    limits.push_back(fmt::format("at most {:g} s", *block.explore.max_seconds));
  }
  return fmt::format("{}", fmt::join(limits, ", "));
}

std::string explorations(const Protocol& protocol) {
  std::vector<std::pair<std::string, std::vector<std::string>>> blocks_of;  // by what it took
  for (const Block& block : protocol.blocks) {
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
    text += took.empty() ? "" : fmt::format("An answer{} required {}. ", where, took);
  }
  return text;
}

// Of people: a simulated participant sees nothing.
std::string blinding(const Protocol& protocol) {
  const bool are_labels_blind = std::ranges::any_of(
      protocol.blocks, [&](const Block& block) { return has_blind_labels(block, protocol); });
  return fmt::format(
      "Blinding: what participants saw did not depend on what was rendered{}; the operator's "
      "screen {} what was presented. ",
      are_labels_blind
          ? ", and alternatives had letters whose meaning was drawn anew for each trial"
          : "",
      protocol.display.is_operator_blind ? "did not show" : "showed");
}
}  // namespace

std::string procedure_words(const Protocol& protocol,
                            const std::vector<results::SessionRow>& sessions) {
  std::set<std::string> participants;
  for (const results::SessionRow& session : sessions) {
    participants.insert(session.participant_id);
  }
  std::vector<std::string> blocks;
  for (const Block& block : protocol.blocks) {
    blocks.push_back(block_words(block, participants.size()));
  }
  std::string text = apparatus(sessions) + rendering(protocol);
  text += sequence_words(protocol, blocks, participants.size());
  text += explorations(protocol);
  text += sessions.front().mode == results::Mode::simulated ? "" : blinding(protocol);
  text += protocol.masking ? fmt::format("Masking: {}. ", described(*protocol.masking)) : "";
  return text;
}
}  // namespace tapstudy::runner
