#include "runner/session/participants/terminal_participant.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <set>
#include <sstream>
#include <thread>

#include "runner/session/participants/terminal_trial.hpp"
#include "runner/terminal/process_exit.hpp"
#include "runner/terminal/terminal_output.hpp"
#include "runner/terminal/typed_input.hpp"
namespace tapstudy::runner {
namespace {
constexpr std::string_view kept_for_resume =
    "every answer given so far is kept (go on with --resume)";

// "[picture: two plates side by side]", instead of the picture.
std::string shown(const std::optional<protocols::Picture>& picture) {
  return picture ? fmt::format("[picture: {}]", picture->text) : "";
}

std::optional<std::size_t> number_in(const std::string& word, std::size_t most) {
  const auto number = whole_number(word, 1, static_cast<int>(most));
  return number ? std::optional{static_cast<std::size_t>(*number - 1)} : std::nullopt;
}
}  // namespace

std::optional<std::string> TerminalParticipant::next_of_participant(
    const std::function<bool()>& keep_waiting) {
  return commands_.next_of_participant(input_, keep_waiting);
}

bool TerminalParticipant::forget_typed_ahead() {
  return commands_.obey_typed_ahead(input_.forget_typed_ahead());
}

// The operator is heard meanwhile, and quit. A script is not read: its lines are answers.
void TerminalParticipant::wait_until(std::chrono::steady_clock::time_point earliest) {
  const auto is_early = [&] { return std::chrono::steady_clock::now() < earliest; };
  while (is_early()) {
    stop_if_asked(kept_for_resume);
    const auto line =
        input_.is_terminal() ? next_of_participant(is_early) : std::optional<std::string>{};
    if (line && asks_to_quit(*line)) {
      ask_to_stop();
    } else if (!line) {
      std::this_thread::sleep_for(std::chrono::milliseconds{20});
    }
  }
}

// A script is not asked: its lines are answers.
void TerminalParticipant::wait_for_enter(std::chrono::steady_clock::time_point latest) {
  if (!input_.is_terminal()) {
    return;
  }
  const auto is_early = [&] { return std::chrono::steady_clock::now() < latest; };
  say("\nTo go on, press Enter. ");
  bool has_quit = forget_typed_ahead();
  while (!has_quit) {
    const auto line = next_of_participant(is_early);
    if (line ? line->empty() : !is_early()) {
      return;
    }
    has_quit = !line || asks_to_quit(*line);
    say("{}", has_quit ? "" : "Type quit to stop here; or press Enter. ");
  }
  ask_to_stop();
  stop_if_asked(kept_for_resume);
}

void TerminalParticipant::wait_while(const std::function<bool()>& is_paused) {
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

void TerminalParticipant::read(const std::string& instructions,
                               const std::optional<protocols::Picture>& picture) {
  const std::string text = instructions.substr(0, instructions.find_last_not_of('\n') + 1);
  say("\n{}\n", marked_text(text, is_shown_by_terminal()));
  say_picture(picture);
  wait_for_enter();
}

void TerminalParticipant::practice_is_over() {
  say("\nThe practice is over. From now on your answers count.\n");
  wait_for_enter();
}

void TerminalParticipant::rest(const protocols::Breaks& breaks) {
  say("\nTime for a break{}{}.\n",
      breaks.min_seconds > 0.0 ? fmt::format(", of {:.3g} s at least", breaks.min_seconds) : "",
      breaks.max_seconds ? fmt::format(", of {:.3g} s at most", *breaks.max_seconds) : "");
  const RestTimes times = rest_times(breaks);
  wait_until(times.earliest);
  wait_for_enter(times.latest);
}

// Without one at the end of input, or when the session is to stop: the answer is stored all the
// same.
std::optional<int> TerminalParticipant::confidence(const protocols::Confidence& scale) {
  if (forget_typed_ahead()) {
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

void TerminalParticipant::feedback(bool is_correct, const std::string& right_label) {
  say("  {}: it was {}\n", is_correct ? "right" : "not right", right_label);
}

void TerminalParticipant::repeats(const TrialPrompt& prompt) {
  say("  trial {} is presented again\n", place_in(prompt.progress));
}

void TerminalParticipant::skipped(const TrialPrompt& prompt) {
  say("  trial {} is skipped\n", place_in(prompt.progress));
}

void TerminalParticipant::refused(const TrialPrompt& /*prompt*/, const TooEarly& why) {
  say("  {}\n", to_text(why));
}

void TerminalParticipant::timed_out(const TrialPrompt& prompt, bool is_presented_again) {
  say("\n  the time for trial {} is over{}\n", place_in(prompt.progress),
      is_presented_again ? ": it comes again later" : "");
  wait_for_enter();  // or trials would run on without anybody
}

// Only an empty line is a yes: an answer that was typed ahead is not. Nothing but quit gives up
// what was answered.
bool TerminalParticipant::saves_again(const std::string& cause) {
  constexpr std::string_view how{"Press Enter to try again, or type quit: "};
  say("\n{}\n  What was entered is not stored yet, but kept. {}", cause, how);
  if (forget_typed_ahead()) {
    return false;
  }
  while (const auto line = next_of_participant([] { return true; })) {
    if (line->empty() || asks_to_quit(*line)) {
      return line->empty();
    }
    say("  {}", how);
  }
  return false;
}

void TerminalParticipant::saved(const TrialPrompt& prompt) {
  say("  saved, {}{}\n", place_in(prompt.progress),
      prompt.progress.is_practice ? " for practice" : "");
}

// Questionnaires at the terminal, an item at a time.
namespace {
using protocols::ItemKind;

std::string input_hint(const protocols::FormItem& item) {
  switch (item.kind) {
    case ItemKind::likert:
      return fmt::format("1 ({}) to {} ({})", item.low, item.steps, item.high);
    case ItemKind::scale:
      return fmt::format("from 0 ({}) to 1 ({})", item.low, item.high);
    case ItemKind::number:
      return fmt::format("a number from {:.6g} to {:.6g}", item.min, item.max);
    case ItemKind::single_choice:
      return "the number of your answer";
    case ItemKind::multiple_choice:
      return "the numbers of your answers, with blanks between";
    case ItemKind::text:
      break;
  }
  return "a line of text";
}

std::optional<std::string> option_typed(const protocols::FormItem& item, const std::string& typed) {
  const auto number = whole_number(typed, 1, static_cast<int>(item.options.size()));
  return number ? std::optional{item.options[static_cast<std::size_t>(*number - 1)].name}
                : std::nullopt;
}

// In the form's order, each once.
std::string choices_typed(const protocols::FormItem& item, const std::string& typed) {
  std::set<std::string> chosen;
  std::string with_blanks = typed;
  std::ranges::replace(with_blanks, ',', ' ');
  std::istringstream numbers{with_blanks};
  for (std::string number; numbers >> number;) {
    const auto option = option_typed(item, number);
    if (!option) {
      return typed;
    }
    chosen.insert(*option);
  }
  std::string text;
  for (const protocols::Option& option : item.options) {
    if (chosen.contains(option.name)) {
      text += (text.empty() ? "" : std::string{protocols::between_choices}) + option.name;
    }
  }
  return text;
}

// Options are numbered at the terminal; numbers may have a decimal comma.
std::string as_stored(const protocols::FormItem& item, const std::string& typed) {
  switch (item.kind) {
    case ItemKind::single_choice:
      return option_typed(item, typed).value_or(typed);
    case ItemKind::multiple_choice:
      return choices_typed(item, typed);
    case ItemKind::scale:
    case ItemKind::number:
      return protocols::with_decimal_point(typed);
    case ItemKind::likert:
    case ItemKind::text:
      break;
  }
  return typed;
}

// Options were shown in the participant's language, by number.
std::string told(const protocols::FormItem& item, const std::string& wrong) {
  if (item.options.empty()) {
    return wrong;
  }
  return fmt::format("please answer with {} from 1 to {}",
                     item.kind == ItemKind::multiple_choice ? "numbers" : "a number",
                     item.options.size());
}

constexpr std::string_view without_this_form =
    "every answer given before this form is kept; --resume begins the form again";
}  // namespace

void TerminalParticipant::say_picture(const std::optional<protocols::Picture>& picture) {
  say("{}{}", shown(picture), picture ? "\n" : "");
}

std::string TerminalParticipant::answer_to(const protocols::FormItem& item) {
  say("\n{}\n", item.question);
  say_picture(item.picture);
  for (std::size_t i = 0; i < item.options.size(); ++i) {
    const std::string picture = shown(item.options[i].picture);
    say("  {}  {}{}{}\n", i + 1, item.options[i].label, picture.empty() ? "" : "  ", picture);
  }
  while (true) {
    say("  {}{}: ", input_hint(item), item.is_required ? "" : "; Enter leaves it out");
    const auto line = next_of_participant([] { return true; });
    if (!line || asks_to_quit(*line)) {
      ask_to_stop();
      stop_if_asked(without_this_form);
      return "";
    }
    const std::string answer = as_stored(item, *line);
    const std::string wrong = wrong_with(item, answer);
    if (wrong.empty()) {
      return answer;
    }
    say("  {}\n", told(item, wrong));
  }
}

protocols::FormAnswers TerminalParticipant::fill_in(const protocols::Form& form) {
  if (forget_typed_ahead()) {
    ask_to_stop();
    stop_if_asked(without_this_form);
  }
  say("\n{}\n{}\n", form.title, marked_text(form.text, is_shown_by_terminal()));
  say_picture(form.picture);
  protocols::FormAnswers answers;
  for (const protocols::FormItem& item : form.items) {
    const auto asked = asked_items(form, answers);  // so far
    if (std::ranges::find(asked, item.name, &protocols::FormItem::name) == asked.end()) {
      continue;
    }
    if (std::string answer = answer_to(item); !answer.empty()) {
      answers.emplace(item.name, std::move(answer));
    }
    if (item_that_ends(form, answers)) {
      break;
    }
  }
  return answers;
}
}  // namespace tapstudy::runner
