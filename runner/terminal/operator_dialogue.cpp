#include "runner/terminal/operator_dialogue.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <functional>

#include "core/error.hpp"
#include "core/text/plain_text.hpp"
#include "runner/terminal/process_exit.hpp"
#include "runner/terminal/terminal_output.hpp"
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

void TypedCommands::obey(const std::string& line) {
  if (!post_) {
    say("  no session has begun yet: {} is not possible\n", line);
    return;
  }
  try {
    outcomes_.add(post_(line.substr(1)));
  } catch (const core::InvalidInput& error) {
    say("  {}\n> ", error.what());
  }
}

bool TypedCommands::obey_typed_ahead(const TypedAhead& typed) {
  std::ranges::for_each(typed.of_operator, [this](const std::string& line) { obey(line); });
  return typed.has_quit;
}

std::optional<std::string> TypedCommands::next_of_participant(
    LineInput& input, const std::function<bool()>& keep_waiting) {
  const auto waits = [&] {
    outcomes_.say_known();
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

bool asked_and_done(LineInput& input, TypedCommands& commands, const std::string& task,
                    const std::string& word) {
  const std::string how = word.empty() ? "press Enter" : fmt::format("type {}", word);
  say("{} {}. ", task, how);
  if (commands.obey_typed_ahead(input.forget_typed_ahead())) {
    return false;
  }
  while (const auto line = commands.next_of_participant(input, [] { return true; })) {
    if (*line == word) {
      return true;
    }
    if (asks_to_quit(*line)) {
      return false;
    }
    say("Type quit to stop here; or {}. ", how);
  }
  return false;
}

std::string OperatorAtTerminal::next_line(const std::function<void()>& keep_waiting) {
  const auto line = input_.next([&] {
    keep_waiting();
    return !stop_was_asked();
  });
  if (!line || asks_to_quit(*line)) {
    throw Stopped{"stopped; nothing was written"};
  }
  return *line;
}

void OperatorAtTerminal::please(const std::string& task) {
  if (!asked_and_done(input_, commands_, task + ", then")) {
    throw Stopped{"stopped; nothing was written"};
  }
}

void OperatorAtTerminal::warn(const std::string& what) noexcept {
  write_to_terminal("\n" + what + "\n");
}

double OperatorAtTerminal::how_much(const std::string& task, double max,
                                    const std::function<void()>& keep_waiting) {
  while (true) {
    say("{}: ", task);
    const std::string line = next_line(keep_waiting);
    const auto value = core::number_in<double>(line);
    if (value && *value > 0.0 && *value <= max) {
      return *value;
    }
    say("  please type a number above 0, at most {}\n", max);
  }
}
}  // namespace tapstudy::runner
