#include "runner/terminal/typed_commands.hpp"

#include <algorithm>
#include <chrono>
#include <exception>

#include "core/error.hpp"
#include "runner/terminal/say.hpp"
#include "runner/terminal/stop_signal.hpp"
namespace tapstudy::runner {
namespace {
bool is_known(const TypedCommands::Posted& posted) {
  return posted.stored.wait_for(std::chrono::seconds{0}) == std::future_status::ready;
}

void say_outcome(const TypedCommands::Posted& posted) {
  try {
    posted.stored.get();
    say("  stored: {}\n> ", posted.said);
  } catch (const std::exception& error) {
    say("  NOT STORED: {}: {}\n> ", posted.said, error.what());
  }
}
}  // namespace

void TypedCommands::obey(const std::string& line) {
  if (!post_) {
    say("  no session has begun yet: {} is not possible\n", line);
    return;
  }
  try {
    open_.push_back(post_(line.substr(1)));
  } catch (const core::InvalidInput& error) {
    say("  {}\n> ", error.what());
  }
}

void TypedCommands::say_outcomes() {
  const auto known = std::stable_partition(open_.begin(), open_.end(), std::not_fn(is_known));
  std::for_each(known, open_.end(), say_outcome);
  open_.erase(known, open_.end());
}

bool TypedCommands::heed(const TypedAhead& typed) {
  std::ranges::for_each(typed.of_operator, [this](const std::string& line) { obey(line); });
  return typed.has_quit;
}

std::optional<std::string> TypedCommands::next_of_participant(
    LineInput& input, const std::function<bool()>& keep_waiting) {
  const auto waits = [&] {
    say_outcomes();
    return keep_waiting() && !stop_was_asked();
  };
  while (auto line = input.next(waits)) {
    if (!is_of_operator(*line)) {
      return line;
    }
    obey(*line);
  }
  return std::nullopt;
}

void TypedCommands::finish() {
  std::ranges::for_each(open_, [](const Posted& posted) { posted.stored.wait(); });
  say_outcomes();
}
}  // namespace tapstudy::runner
