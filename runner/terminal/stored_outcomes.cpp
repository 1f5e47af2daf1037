#include "runner/terminal/stored_outcomes.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <functional>

#include "runner/terminal/say.hpp"
namespace tapstudy::runner {
namespace {
bool is_known(const PostedCommand& command) {
  return command.stored.wait_for(std::chrono::seconds{0}) == std::future_status::ready;
}
}  // namespace

void StoredOutcomes::say_outcome(const PostedCommand& command) const {
  try {
    command.stored.get();
    say("{}stored: {}\n{}", indent_, command.said, prompt_);
  } catch (const std::exception& error) {
    say("{}NOT STORED: {}: {}\n{}", indent_, command.said, error.what(), prompt_);
  }
}

void StoredOutcomes::say_known() {
  const auto known = std::stable_partition(open_.begin(), open_.end(), std::not_fn(is_known));
  std::for_each(known, open_.end(), [this](const PostedCommand& each) { say_outcome(each); });
  open_.erase(known, open_.end());
}

void StoredOutcomes::finish() {
  std::ranges::for_each(open_, [](const PostedCommand& each) { each.stored.wait(); });
  say_known();
}
}  // namespace tapstudy::runner
