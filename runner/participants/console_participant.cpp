#include "runner/participants/console_participant.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "results/store_error.hpp"
#include "runner/participants/typed_answers.hpp"
#include "runner/terminal/say.hpp"
#include "runner/terminal/stop_signal.hpp"
#include "runner/terminal/whole_number.hpp"
namespace tapstudy::runner {
namespace {
std::optional<std::size_t> number_in(const std::string& word, std::size_t most) {
  const auto number = whole_number(word, 1, static_cast<int>(most));
  return number ? std::optional{static_cast<std::size_t>(*number - 1)} : std::nullopt;
}

std::optional<std::size_t> index_of(const std::string& label,
                                    const std::vector<std::string>& labels) {
  const auto found = std::ranges::find(labels, label);
  return found == labels.end() ? std::nullopt
                               : std::optional{static_cast<std::size_t>(found - labels.begin())};
}
}  // namespace

std::optional<std::string> ConsoleParticipant::next_of_participant(
    const std::function<bool()>& keep_waiting) {
  while (auto line = input_.next([&] { return keep_waiting() && !stop_was_asked(); })) {
    if (!line->starts_with(':')) {
      return line;
    }
    say("  {}\n> ", obey_(line->substr(1)));
  }
  return std::nullopt;
}

// A script is not asked: its lines are answers.
void ConsoleParticipant::wait_for_enter() {
  if (!input_.is_terminal()) {
    return;
  }
  say("\nTo go on, press Enter. ");
  bool has_quit = input_.forget_typed_ahead();
  while (!has_quit) {
    const auto line = next_of_participant([] { return true; });
    if (line && line->empty()) {
      return;
    }
    has_quit = !line || asks_to_quit(*line);
    say("{}", has_quit ? "" : "Type quit to stop here; or press Enter. ");
  }
  ask_to_stop();
  stop_if_asked();
}

void ConsoleParticipant::wait_while(const std::function<bool()>& is_paused) {
  say("\nPaused; force is off. To go on, type :resume\n> ");
  while (is_paused()) {
    const auto line = next_of_participant(is_paused);
    if (!line && is_paused()) {  // the end of input
      ask_to_stop();
    } else if (line && asks_to_quit(*line)) {
      ask_to_stop();
    } else if (line) {
      say("  paused: type :resume to go on, or quit\n> ");
    }
  }
}

void ConsoleParticipant::read(const std::string& instructions) {
  say("\n{}\n", instructions.substr(0, instructions.find_last_not_of('\n') + 1));
  wait_for_enter();
}

void ConsoleParticipant::rest(double min_seconds) {
  say("\nTime for a break{}.\n",
      min_seconds > 0.0 ? fmt::format(", of {:.3g} s at least", min_seconds) : "");
  const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>{min_seconds};
  while (std::chrono::steady_clock::now() < until) {
    stop_if_asked();
    std::this_thread::sleep_for(std::chrono::milliseconds{20});
  }
  wait_for_enter();
}

// Without one at the end of input, or when the session is to stop: the answer is stored all the
// same.
std::optional<int> ConsoleParticipant::confidence(const protocols::Confidence& scale) {
  if (input_.forget_typed_ahead()) {
    ask_to_stop();
    return std::nullopt;
  }
  say("  How sure are you? 1 ({}) to {} ({}): ", scale.low, scale.steps, scale.high);
  while (const auto line = next_of_participant([] { return true; })) {
    if (asks_to_quit(*line)) {
      ask_to_stop();
      return std::nullopt;
    }
    if (const auto step =
            number_in(upper_case_without_spaces(*line), static_cast<std::size_t>(scale.steps))) {
      return static_cast<int>(*step) + 1;
    }
    say("  please type a number from 1 to {}: ", scale.steps);
  }
  return std::nullopt;
}

void ConsoleParticipant::feedback(bool is_correct, const std::string& right_label) {
  say("  {}: it was {}\n", is_correct ? "right" : "not right", right_label);
}

void ConsoleParticipant::get_ready(const TrialPrompt& prompt) {
  move_hand_();
  if (input_.forget_typed_ahead()) {
    ask_to_stop();
  }
  say("\nTrial {} of {}{}. {}\n", prompt.number, prompt.total,
      prompt.block->is_practice ? " (practice)" : "", prompt.block->question);
  if (prompt.previous) {
    say("  (correct and {}: what your last answer should have been)\n",
        expected_answer(prompt.previous->answers));
  }
  const bool are_named = prompt.answers_name_alternatives();
  const std::vector<protocols::Option>& options = prompt.answers.options;
  for (std::size_t i = 0; !are_named && i < options.size(); ++i) {
    say("  {}  {}\n", i + 1, options[i].label);
  }
  if (!prompt.alternative_labels.empty()) {
    say("  {}: feel that one.{}\n", fmt::join(prompt.alternative_labels, ", "),
        how_to_answer(prompt));
  }
  if (prompt.answers.modulus) {
    say("  {} is {}\n", prompt.alternative_labels.front(), *prompt.answers.modulus);
  }
}

std::optional<std::string> ConsoleParticipant::next_line(const TrialPrompt& prompt,
                                                         Exploration& exploration) {
  while (true) {
    say("> ");
    const auto line = next_of_participant([&] { return exploration.is_running(); });
    if (!line || asks_to_quit(*line)) {
      return std::nullopt;
    }
    if (!corrects(*line, prompt, exploration)) {
      return line;
    }
  }
}

bool ConsoleParticipant::corrects(const std::string& line, const TrialPrompt& prompt,
                                  Exploration& exploration) const {
  constexpr std::string_view command{"CORRECT"};
  if (!prompt.previous || !upper_case_without_spaces(line).starts_with(command)) {
    return false;
  }
  const std::string text = line.substr(std::min(line.size(), line.find_first_of("tT") + 1));
  const auto answer = answer_in(text, prompt.previous->answers);
  if (!answer) {
    say("  please type correct and {}\n", expected_answer(prompt.previous->answers));
    return true;
  }
  const std::shared_future<void> stored = prompt.previous->correct(text);
  while (stored.wait_for(std::chrono::seconds{0}) != std::future_status::ready &&
         exploration.is_running()) {
    exploration.pass_time(0.01);
  }
  try {
    stored.get();
    say("  your last answer is now {}\n", label_of_answer(*answer, prompt.previous->answers));
  } catch (const results::StoreError& error) {
    say("  your last answer is not corrected: {}\n", error.what());
  }
  return true;
}

std::optional<std::string> ConsoleParticipant::perform(const TrialPrompt& prompt,
                                                       Exploration& exploration) {
  return prompt.alternative_labels.empty() ? answer_by_itself(prompt, exploration)
                                           : answer_among_alternatives(prompt, exploration);
}

void ConsoleParticipant::let_script_wait(const TrialPrompt& prompt, std::size_t alternative,
                                         Exploration& exploration) const {
  constexpr double step_s = 0.005;
  constexpr double patience_s = 60.0;
  const double until_s = exploration.time_s() + patience_s + prompt.block->explore.min_seconds;
  while (!input_.is_terminal() && exploration.is_running() && !stop_was_asked() &&
         (exploration.contacts(alternative) < prompt.block->explore.min_contacts ||
          exploration.time_s() < prompt.block->explore.min_seconds)) {
    if (exploration.time_s() > until_s) {
      say("  the plate was tapped {} of {} times in {:.0f} s: nobody is there\n",
          exploration.contacts(alternative), prompt.block->explore.min_contacts, patience_s);
      ask_to_stop();
    }
    exploration.pass_time(step_s);
  }
}

std::optional<std::string> ConsoleParticipant::answer_by_itself(const TrialPrompt& prompt,
                                                                Exploration& exploration) {
  while (const auto line = next_line(prompt, exploration)) {
    if (auto answer = answer_typed(*line, prompt, exploration)) {
      let_script_wait(prompt, 0, exploration);
      return answer;
    }
    say("  please type {}, or quit\n", expected_answer(prompt.answers));
  }
  return std::nullopt;
}

std::optional<std::string> ConsoleParticipant::answer_among_alternatives(const TrialPrompt& prompt,
                                                                         Exploration& exploration) {
  const std::vector<std::string>& labels = prompt.alternative_labels;
  while (const auto line = next_line(prompt, exploration)) {
    if (auto answer = answer_typed(*line, prompt, exploration)) {
      return answer;
    }
    if (const auto alternative = index_of(upper_case_without_spaces(*line), labels)) {
      exploration.switch_to(*alternative);
      say("  now {} (takes effect once the finger is off the plate)\n", labels[*alternative]);
      let_script_wait(prompt, *alternative, exploration);
      continue;
    }
    if (adjusts(*line, prompt, exploration)) {
      continue;
    }
    say("  please type {} to feel one, {}, or quit\n", fmt::join(labels, ", "),
        expected_among_alternatives(prompt));
  }
  return std::nullopt;
}

// As far as there are settings.
bool ConsoleParticipant::adjusts(const std::string& line, const TrialPrompt& prompt,
                                 Exploration& exploration) const {
  const auto moved = settings_moved(line);
  if (prompt.answers.settings == 0 || !moved) {
    return false;
  }
  const auto last = static_cast<std::ptrdiff_t>(prompt.answers.settings) - 1;
  const auto from = static_cast<std::ptrdiff_t>(exploration.setting());
  const std::ptrdiff_t to = std::clamp<std::ptrdiff_t>(from + *moved, 0, last);
  const std::string& label = prompt.alternative_labels.back();
  if (to == from) {
    say("  {} goes no further that way\n", label);
    return true;
  }
  exploration.adjust(static_cast<std::size_t>(to));
  say("  {} is changed (takes effect once the finger is off the plate){}\n", label,
      to == from + *moved ? "" : fmt::format("; {} goes no further that way", label));
  let_script_wait(prompt, prompt.alternative_labels.size() - 1, exploration);
  return true;
}

void ConsoleParticipant::repeats(const TrialPrompt& prompt) {
  say("  trial {} is presented again\n", prompt.number);
}

void ConsoleParticipant::skipped(const TrialPrompt& prompt) {
  say("  trial {} is skipped\n", prompt.number);
}

void ConsoleParticipant::refused(const TrialPrompt& /*prompt*/, const TooEarly& why) {
  say("  {}\n", to_text(why));
}

void ConsoleParticipant::timed_out(const TrialPrompt& prompt, bool is_presented_again) {
  say("\n  the time for trial {} is over{}\n", prompt.number,
      is_presented_again ? ": it comes again later" : "");
  wait_for_enter();  // or trials would run on without anybody
}

// Only an empty line is a yes: an answer that was typed ahead is not.
bool ConsoleParticipant::saves_again(const std::string& cause) {
  say("\n{}\n  The trial is not stored yet, but kept. Press Enter to try again, or type quit: ",
      cause);
  if (input_.forget_typed_ahead()) {
    return false;
  }
  const auto line = next_of_participant([] { return true; });
  return line && line->empty();
}

void ConsoleParticipant::saved(const TrialPrompt& prompt) {
  say("  saved, {} of {}\n", prompt.number, prompt.total);
}
}  // namespace tapstudy::runner
