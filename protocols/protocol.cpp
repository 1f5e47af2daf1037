#include "protocols/protocol.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/error.hpp"
namespace tapstudy::protocols {
namespace {
template <class Item>
const Item& named(const std::vector<Item>& items, const std::string& name, const char* kind) {
  const auto found = std::ranges::find(items, name, &Item::name);
  if (found != items.end()) {
    return *found;
  }
  std::vector<std::string> names;
  std::ranges::transform(items, std::back_inserter(names), &Item::name);
  throw core::InvalidInput{fmt::format("{} '{}' is not in the protocol (it has: {})", kind, name,
                                       fmt::join(names, ", "))};
}
}  // namespace

const Stimulus& Protocol::stimulus(const std::string& name) const {
  return named(stimuli, name, "stimulus");
}
const Block& Protocol::block(const std::string& name) const {
  return named(blocks, name, "block");
}
const PlannedSession* Protocol::find_session(const std::string& name) const {
  const auto found = std::ranges::find(sessions, name, &PlannedSession::name);
  return found == sessions.end() ? nullptr : &*found;
}

const Group& Protocol::group(const std::string& name) const {
  return named(groups, name, "group");
}
const Block* Protocol::find_block(const std::string& name) const {
  const auto found = std::ranges::find(blocks, name, &Block::name);
  return found == blocks.end() ? nullptr : &*found;
}

const Block& Protocol::leader(const Block& block) const {
  const auto found = std::ranges::find_if(blocks, [&](const Block& other) {
    return !block.mixed_with.empty() && other.measure == block.mixed_with &&
           other.session == block.session;
  });
  return found == blocks.end() ? block : *found;
}

bool Protocol::are_mixed(const Block& one, const Block& other) const {
  return leader(one).name == leader(other).name;
}

bool may_procedures_end_early(const Block& block) {
  return block.comparison && std::ranges::any_of(block.comparison->tracks, [](const auto& track) {
           return track->may_end_early();
         });
}

bool may_end_early(const Block& block) {
  return block.criterion || may_procedures_end_early(block);
}

bool is_presented(const Block& block, const FilledForms& filled) {
  return !block.presented_if || is_met(*block.presented_if, filled).value_or(true);
}

bool do_skipped_trials_come_again(const Block& block) {
  return block.comparison.has_value();
}

Answers answers_of(const Block& block, const Protocol& protocol) {
  Answers answers = block.task->answers(block, protocol);
  answers.keys = block.keys;
  return answers;
}

std::vector<std::string> all_presented(const Block& block) {
  std::vector<std::string> names = block.stimuli;
  const auto add = [&](const std::string& name) {
    if (!name.empty() && std::ranges::find(names, name) == names.end()) {
      names.push_back(name);
    }
  };
  if (block.catch_trials) {
    for (const auto& [name, answer] : block.catch_trials->expected) {
      add(name);
    }
  }
  if (block.modulus) {
    add(block.modulus->stimulus);
  }
  if (block.adjustment) {
    add(block.adjustment->reference);
  }
  return names;
}
}  // namespace tapstudy::protocols
