#include "runner/experiments/screens.hpp"

#include <fmt/format.h>

#include "protocols/schedule.hpp"
namespace tapstudy::runner {
namespace {
std::string counted(std::size_t count, std::string_view thing) {
  return fmt::format("{} {}{}", count, thing, count == 1 ? "" : "s");
}

void add_instructions(const std::string& text, const std::string& whose,
                      std::vector<ScreenGroup>& screens) {
  if (!text.empty()) {
    screens.push_back({"instructions of " + whose, 1});
  }
}

void add_forms(const protocols::Protocol& protocol, const std::vector<std::string>& names,
               std::vector<ScreenGroup>& screens) {
  for (const std::string& name : names) {
    const std::size_t items = protocol.forms.at(name).items.size();
    screens.push_back({fmt::format("questionnaire {}: {}", name, counted(items, "question")), 1});
  }
}

void add_trials(const protocols::Block& block, std::vector<ScreenGroup>& screens) {
  const int trials = protocols::planned_trials(block);
  const bool may_end_early = block.criterion || block.comparison;
  screens.push_back({fmt::format("{}: {}{}", block.name, may_end_early ? "at most " : "",
                                 counted(static_cast<std::size_t>(trials), "trial")),
                     trials});
  if (block.confidence) {
    screens.push_back(
        {fmt::format("confidence in {} steps, after each", block.confidence->steps), trials});
  }
  if (block.gives_feedback) {
    screens.push_back({"feedback, after each", trials});
  }
  if (block.breaks) {
    const protocols::Breaks& breaks = *block.breaks;
    const std::string length =
        breaks.min_seconds > 0.0 ? fmt::format(" of at least {} s", breaks.min_seconds) : "";
    const auto every = static_cast<std::size_t>(breaks.every_trials);
    screens.push_back({fmt::format("a break{}, after every {}", length, counted(every, "trial")),
                       (trials - 1) / breaks.every_trials});
  }
}
}  // namespace

std::vector<ScreenGroup> screens_of(const protocols::Protocol& protocol) {
  std::vector<ScreenGroup> screens;
  add_instructions(protocol.instructions, "the study", screens);
  add_forms(protocol, protocol.forms_before, screens);
  for (const protocols::Block& block : protocol.blocks) {
    add_instructions(block.instructions, block.name, screens);
    add_trials(block, screens);
    add_forms(protocol, block.forms_after, screens);
  }
  add_forms(protocol, protocol.forms_after, screens);
  return screens;
}
}  // namespace tapstudy::runner
