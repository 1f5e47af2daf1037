// How a person at the terminal explores and answers a trial.
#include "runner/session/participants/terminal_trial.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

#include "results/store_error.hpp"
#include "runner/session/participants/terminal_participant.hpp"
#include "runner/terminal/process_exit.hpp"
#include "runner/terminal/terminal_output.hpp"
namespace tapstudy::runner {
namespace {
// "= B", or "= 3" for an option that is none of the alternatives.
std::optional<std::string> option_after_equals(const std::string& word,
                                               const protocols::Answers& answers) {
  if (!word.starts_with('=')) {
    return std::nullopt;
  }
  const auto& options = answers.options;
  const auto option = std::ranges::find(options, word.substr(1), &protocols::Option::label);
  return option == options.end() ? answer_in(word.substr(1), answers) : std::optional{option->name};
}

std::string further_options(const TrialPrompt& prompt) {
  std::string all;
  for (std::size_t i = prompt.alternative_labels.size(); i < prompt.answers.options.size(); ++i) {
    all += fmt::format("   = {}: {}.", i + 1, prompt.answers.options[i].label);
  }
  return all;
}

// "= C A B": labels of alternatives are single letters.
std::optional<std::string> order_after_equals(const std::string& word,
                                              const protocols::Answers& answers) {
  if (!word.starts_with('=')) {
    return std::nullopt;
  }
  std::string places;
  for (const char letter : word.substr(1)) {
    const auto option =
        std::ranges::find(answers.options, std::string{letter}, &protocols::Option::label);
    places += fmt::format("{} ", option - answers.options.begin() + 1);
  }
  return answer_in(places, answers);
}

// "   f: A. j: B."
std::string by_keys(const protocols::Answers& answers) {
  std::string all = "  ";
  for (std::size_t i = 0; i < answers.options.size(); ++i) {
    all += fmt::format(" {}: {}.", key_of_option(i, answers), answers.options[i].label);
  }
  return all;
}

bool is_order(const TrialPrompt& prompt) {
  return prompt.answers.kind == protocols::AnswerKind::order;
}

std::optional<std::string> labels_after_equals(const std::string& word,
                                               const protocols::Answers& answers) {
  return answers.kind == protocols::AnswerKind::order ? order_after_equals(word, answers)
                                                      : option_after_equals(word, answers);
}
}  // namespace

std::string upper_case_without_spaces(const std::string& line) {
  std::string word;
  for (const char c : line) {
    if (std::isspace(static_cast<unsigned char>(c)) == 0) {
      word += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    }
  }
  return word;
}

std::optional<std::string> answer_typed(const std::string& line, const TrialPrompt& prompt,
                                        const TrialControl& control) {
  if (prompt.answers.settings > 0) {
    return upper_case_without_spaces(line) == "="
               ? std::optional{fmt::format("{}", control.setting() + 1)}
               : std::nullopt;
  }
  if (auto by_key = option_of_key(line, prompt.answers)) {
    return by_key;
  }
  return prompt.answers_name_alternatives()
             ? labels_after_equals(upper_case_without_spaces(line), prompt.answers)
             : answer_in(line, prompt.answers);
}

std::optional<int> settings_moved(const std::string& line) {
  const std::string word = upper_case_without_spaces(line);
  const bool is_up = word.find_first_not_of('+') == std::string::npos;
  const bool is_down = word.find_first_not_of('-') == std::string::npos;
  return word.empty() || !(is_up || is_down)
             ? std::nullopt
             : std::optional{(is_up ? 1 : -1) * static_cast<int>(word.size())};
}

std::string answer_instructions(const TrialPrompt& prompt) {
  if (prompt.answers.settings > 0) {
    return fmt::format("   + or -: change {}, ++ by more.   =: it is set.",
                       prompt.alternative_labels.back());
  }
  if (!prompt.answers_name_alternatives()) {
    return "";
  }
  if (!prompt.answers.keys.empty()) {
    return by_keys(prompt.answers);
  }
  return is_order(prompt)
             ? fmt::format("   = {}: your order, the first one first.",
                           fmt::join(prompt.alternative_labels, " "))
             : fmt::format("   = {}: choose it.{}", prompt.answers.options.front().label,
                           further_options(prompt));
}

std::string expected_among_alternatives(const TrialPrompt& prompt) {
  if (prompt.answers.settings > 0) {
    return fmt::format("+ or - to change {}, = when it is set", prompt.alternative_labels.back());
  }
  if (!prompt.answers_name_alternatives()) {
    return expected_answer(prompt.answers) + " to answer";
  }
  if (!prompt.answers.keys.empty()) {
    return expected_answer(prompt.answers) + " to choose";
  }
  return is_order(prompt) ? "= and all labels in order" : "= and a label to choose it";
}

using Phase = IntervalState::Phase;

void TypedIntervals::announce(const TrialControl& control) {
  const IntervalState* const state = control.intervals();
  if (state == nullptr || told_ == *state) {
    return;
  }
  if (state->phase == Phase::leaving) {
    say("\n  lift your finger\n> ");
  } else if (state->phase == Phase::open) {
    say("\n  now {}{}\n> ", labels_.at(control.current()), is_scripted_ ? "" : ": tap it");
  } else if (told_ && told_->phase == Phase::open) {
    say("\n  stop{}\n> ",
        state->phase != Phase::over ? "; the next one follows"
        : state->replays_left > 0
            ? fmt::format("; your answer, or again (left: {})", state->replays_left)
            : "; your answer");
  }
  told_ = *state;
}

std::string interval_instructions(const TrialPrompt& prompt) {
  const auto& intervals = prompt.block->explore.intervals;
  if (!intervals) {
    return "";
  }
  return fmt::format(
      "  {} come one after the other, for {:.3g} s each{}.{}",
      fmt::join(prompt.alternative_labels, ", "), intervals->seconds,
      prompt.block->explore.scripted_taps ? "" : ": tap each as soon as you are told",
      intervals->max_replays > 0 ? "   again: all of them once more." : "");
}

std::optional<int> TypedCountdown::due(double time_s) {
  for (const int seconds : {5, 10, 30}) {
    if (limit_s_ && seconds < *limit_s_ && *limit_s_ - time_s <= seconds) {
      const bool is_said = said_ && *said_ <= seconds;
      said_ = is_said ? said_ : seconds;
      return is_said ? std::nullopt : said_;
    }
  }
  return std::nullopt;
}

bool replays(const std::string& line, TrialControl& control) {
  const IntervalState* const state = control.intervals();
  if (state == nullptr || upper_case_without_spaces(line) != "AGAIN") {
    return false;
  }
  if (state->phase != Phase::over) {
    say("  they are not over yet\n");
  } else if (state->replays_left == 0) {
    say("  they do not come again: please answer\n");
  }
  control.replay();
  return true;
}

namespace {
constexpr double script_patience_s = 60.0;

std::optional<std::size_t> index_of(const std::string& label,
                                    const std::vector<std::string>& labels) {
  const auto found = std::ranges::find(labels, label);
  return found == labels.end() ? std::nullopt
                               : std::optional{static_cast<std::size_t>(found - labels.begin())};
}

// "1 for A, 2 for B".
std::string expected_correction(const protocols::Answers& answers) {
  if (answers.kind != protocols::AnswerKind::option) {
    return expected_answer(answers);
  }
  std::vector<std::string> numbers;
  for (const protocols::Option& option : answers.options) {
    numbers.push_back(
        fmt::format("{} for {}", key_of_option(numbers.size(), answers), option.label));
  }
  return fmt::format("{}", fmt::join(numbers, ", "));
}

// Empty where answers name alternatives, which have labels of their own.
std::string options_in_lines(const TrialPrompt& prompt) {
  if (prompt.answers_name_alternatives()) {
    return "";
  }
  const protocols::Answers& answers = prompt.answers;
  const bool have_numbers = !answers.ends.low.empty() && answers.keys.empty();  // steps of a scale
  std::string lines;
  for (std::size_t i = 0; i < answers.options.size(); ++i) {
    lines += have_numbers
                 ? fmt::format("  {}\n", answers.options[i].label)
                 : fmt::format("  {}  {}\n", key_of_option(i, answers), answers.options[i].label);
  }
  return lines;
}
}  // namespace

void TerminalParticipant::get_ready(const TrialPrompt& prompt) {
  move_hand_();
  if (forget_typed_ahead()) {
    ask_to_stop();
  }
  say("\nTrial {}{}. {}\n", place_in(prompt.progress),
      prompt.block->is_practice ? " (practice)" : "", prompt.block->question);
  if (const auto limit_s = prompt.block->explore.max_seconds) {
    say("  within {:g} s from when it can be felt\n", *limit_s);
  }
  if (prompt.previous) {
    say("  (to change your last answer, type correct and {})\n",
        expected_correction(prompt.previous->answers));
  }
  say("{}", options_in_lines(prompt));
  if (prompt.answers.kind == protocols::AnswerKind::line) {
    say("  {}\n", expected_answer(prompt.answers));
  }
  if (prompt.block->explore.scripted_taps) {
    say("  hold the device still: the plate is tapped for you\n");
  }
  intervals_.emplace(prompt);
  countdown_.emplace(prompt.block->explore.max_seconds);
  if (!prompt.alternative_labels.empty()) {
    const std::string intervals = interval_instructions(prompt);
    say("{}{}\n",
        intervals.empty()
            ? fmt::format("  {}: feel that one.", fmt::join(prompt.alternative_labels, ", "))
            : intervals,
        answer_instructions(prompt));
  }
  if (prompt.answers.modulus) {
    say("  {} is {}\n", prompt.alternative_labels.front(), *prompt.answers.modulus);
  }
}

std::optional<std::string> TerminalParticipant::next_line(const TrialPrompt& prompt,
                                                          TrialControl& control) {
  while (true) {
    say("> ");
    const auto line = next_of_participant([&] {
      intervals_->announce(control);
      if (const auto seconds = countdown_->due(control.time_s())) {
        say("\n  {} s left to answer\n> ", *seconds);
      }
      return control.poll();
    });
    if (!line || asks_to_quit(*line)) {
      return std::nullopt;
    }
    if (!corrects(*line, prompt, control)) {
      return line;
    }
  }
}

bool TerminalParticipant::corrects(const std::string& line, const TrialPrompt& prompt,
                                   TrialControl& control) const {
  constexpr std::string_view command{"CORRECT"};
  if (!prompt.previous || !upper_case_without_spaces(line).starts_with(command)) {
    return false;
  }
  const std::string text = line.substr(std::min(line.size(), line.find_first_of("tT") + 1));
  const auto answer = answer_in(text, prompt.previous->answers);
  if (!answer) {
    say("  please type correct and {}\n", expected_correction(prompt.previous->answers));
    return true;
  }
  const std::shared_future<void> stored = prompt.previous->correct(text);
  while (stored.wait_for(std::chrono::seconds{0}) != std::future_status::ready && control.poll()) {
    control.pass_time(0.01);
  }
  try {
    stored.get();
    say("  your last answer is now {}\n", label_of_answer(*answer, prompt.previous->answers));
  } catch (const results::StoreError& error) {
    say("  your last answer is not corrected: {}\n", error.what());
  }
  return true;
}

std::optional<std::string> TerminalParticipant::perform(const TrialPrompt& prompt,
                                                        TrialControl& control) {
  return prompt.alternative_labels.empty() ? answer_by_itself(prompt, control)
                                           : answer_among_alternatives(prompt, control);
}

bool TerminalParticipant::passes_time_until(const std::function<bool()>& is_done,
                                            TrialControl& control) const {
  constexpr double step_s = 0.005;
  if (input_.is_terminal() || !control.poll() || stop_was_asked() || is_done()) {
    return false;
  }
  control.pass_time(step_s);
  return true;
}

void TerminalParticipant::let_script_wait(const TrialPrompt& prompt, std::size_t alternative,
                                          TrialControl& control) const {
  const protocols::ExploreLimits& limits = prompt.block->explore;
  const auto is_done = [&] {
    return control.contacts(alternative) >= limits.min_contacts &&
           control.time_s() >= limits.min_seconds;
  };
  const double until_s = control.time_s() + script_patience_s + limits.min_seconds;
  while (passes_time_until(is_done, control)) {
    if (control.time_s() > until_s) {
      say("  the plate was tapped {} of {} times in {:.0f} s: no response, stopping\n",
          control.contacts(alternative), limits.min_contacts, script_patience_s);
      ask_to_stop();
    }
  }
}

void TerminalParticipant::wait_for_intervals(const TrialPrompt& prompt, TrialControl& control) {
  const IntervalState* const state = control.intervals();
  if (state == nullptr) {
    return;
  }
  const double lasts_s =
      static_cast<double>(prompt.alternative_labels.size()) *
      (prompt.block->explore.intervals->seconds + prompt.block->explore.intervals->gap_seconds);
  const double until_s = control.time_s() + script_patience_s + lasts_s;
  const auto is_over = [&] { return state->phase == IntervalState::Phase::over; };
  while (passes_time_until(is_over, control)) {
    intervals_->announce(control);
    if (control.time_s() > until_s) {
      say("  an interval was not tapped in for {:.0f} s: no response, stopping\n",
          script_patience_s);
      ask_to_stop();
    }
  }
}

std::optional<std::string> TerminalParticipant::answer_by_itself(const TrialPrompt& prompt,
                                                                 TrialControl& control) {
  while (const auto line = next_line(prompt, control)) {
    if (auto answer = answer_typed(*line, prompt, control)) {
      let_script_wait(prompt, 0, control);
      return answer;
    }
    say("  please type {}, or quit\n", expected_answer(prompt.answers));
  }
  return std::nullopt;
}

std::optional<std::string> TerminalParticipant::answer_among_alternatives(const TrialPrompt& prompt,
                                                                          TrialControl& control) {
  const std::vector<std::string>& labels = prompt.alternative_labels;
  while (const auto line = next_line(prompt, control)) {
    wait_for_intervals(prompt, control);
    if (auto answer = answer_typed(*line, prompt, control)) {
      return answer;
    }
    if (replays(*line, control)) {
      continue;
    }
    const auto alternative = index_of(upper_case_without_spaces(*line), labels);
    if (alternative && control.intervals() == nullptr) {
      control.switch_to(*alternative);
      say("  now {} (takes effect once the finger is off the plate)\n", labels[*alternative]);
      let_script_wait(prompt, *alternative, control);
      continue;
    }
    if (adjusts(*line, prompt, control)) {
      continue;
    }
    say("  please type {}{}, or quit\n",
        control.intervals() == nullptr ? fmt::format("{} to feel one, ", fmt::join(labels, ", "))
                                       : "",
        expected_among_alternatives(prompt));
  }
  return std::nullopt;
}

// As far as there are settings.
bool TerminalParticipant::adjusts(const std::string& line, const TrialPrompt& prompt,
                                  TrialControl& control) const {
  const auto moved = settings_moved(line);
  if (prompt.answers.settings == 0 || !moved) {
    return false;
  }
  const auto last = static_cast<std::ptrdiff_t>(prompt.answers.settings) - 1;
  const auto from = static_cast<std::ptrdiff_t>(control.setting());
  const std::ptrdiff_t to = std::clamp<std::ptrdiff_t>(from + *moved, 0, last);
  const std::string& label = prompt.alternative_labels.back();
  if (to == from) {
    say("  {} is at its limit in that direction\n", label);
    return true;
  }
  control.adjust(static_cast<std::size_t>(to));
  say("  {} is changed (takes effect once the finger is off the plate){}\n", label,
      to == from + *moved ? "" : fmt::format("; {} is at its limit in that direction", label));
  let_script_wait(prompt, prompt.alternative_labels.size() - 1, control);
  return true;
}
}  // namespace tapstudy::runner
