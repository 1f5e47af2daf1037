#include "runner/experiments/procedure_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

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
      "Contact was rendered by a spring of {:g} N/m with {}: {}{}. ",
      protocol.rendering.penalty_stiffness_n_per_m,
      techniques.size() == 1 ? "the technique" : "the techniques", fmt::join(techniques, ", "),
      vibrates ? fmt::format("; modes of vibration up to {:g} Hz", protocol.band_limit_hz) : "");
}

const char* order_words(const Block& block) {
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
      return ", in orders balanced for immediate sequence over participants (Williams 1949)";
  }
  return "";
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

std::string block_words(const Block& block) {
  const bool may_end_early = block.criterion || block.comparison;
  const auto trials = static_cast<std::size_t>(protocols::planned_trials(block));
  return fmt::format(
      "'{}' ({} of {}{}, {}{}{}{})", block.name, block.task->name(),
      block.stimuli.size() == 1 ? "one stimulus" : fmt::format("{} stimuli", block.stimuli.size()),
      block.presented == protocols::Presented::real_plates ? ", the real plates themselves" : "",
      may_end_early ? "at most " : "", counted(trials, "trial"), order_words(block),
      practice_words(block));
}

std::string exploration(const Block& block) {
  std::vector<std::string> limits;
  if (block.presented == protocols::Presented::virtual_plates && block.explore.min_contacts > 0) {
    limits.push_back(fmt::format(
        "at least {}", counted(static_cast<std::size_t>(block.explore.min_contacts), "contact")));
  }
  if (block.explore.min_seconds > 0.0) {
    limits.push_back(fmt::format("at least {:g} s", block.explore.min_seconds));
  }
  if (block.explore.max_seconds) {
    limits.push_back(fmt::format("at most {:g} s", *block.explore.max_seconds));
  }
  return limits.empty()
             ? ""
             : fmt::format("An answer in '{}' took {}. ", block.name, fmt::join(limits, ", "));
}

bool has_blind_labels(const Block& block) {
  return !block.is_practice && !block.task->uses_order() && block.task->is_random(block);
}

std::string blinding(const Protocol& protocol) {
  const bool are_labels_blind = std::ranges::any_of(protocol.blocks, has_blind_labels);
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
  std::vector<std::string> blocks;
  std::ranges::transform(protocol.blocks, std::back_inserter(blocks), block_words);
  std::string text = apparatus(sessions) + rendering(protocol);
  text += fmt::format("Each participant did {}. ", fmt::join(blocks, ", then "));
  for (const Block& block : protocol.blocks) {
    text += exploration(block);
  }
  text += blinding(protocol);
  text += protocol.masking ? fmt::format("Masking: {}. ", described(*protocol.masking)) : "";
  return text;
}
}  // namespace tapstudy::runner
