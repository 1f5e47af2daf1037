// Questionnaires at the terminal, an item at a time.
#include <fmt/format.h>

#include "runner/participants/terminal_participant.hpp"
#include "runner/terminal/marked_text.hpp"
#include "runner/terminal/say.hpp"
#include "runner/terminal/stop_signal.hpp"
#include "runner/terminal/whole_number.hpp"
namespace tapstudy::runner {
namespace {
using protocols::ItemKind;

std::string what_to_type(const protocols::FormItem& item) {
  switch (item.kind) {
    case ItemKind::likert:
      return fmt::format("1 ({}) to {} ({})", item.low, item.steps, item.high);
    case ItemKind::scale:
      return fmt::format("from 0 ({}) to 1 ({})", item.low, item.high);
    case ItemKind::number:
      return fmt::format("a number from {:.6g} to {:.6g}", item.min, item.max);
    case ItemKind::single_choice:
      return "the number of your answer";
    case ItemKind::text:
      break;
  }
  return "a line of text";
}

// Options are numbered at the terminal; numbers may have a decimal comma.
std::string as_stored(const protocols::FormItem& item, const std::string& typed) {
  switch (item.kind) {
    case ItemKind::single_choice: {
      const auto number = whole_number(typed, 1, static_cast<int>(item.options.size()));
      return number ? item.options[static_cast<std::size_t>(*number - 1)].name : typed;
    }
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
  return item.kind == ItemKind::single_choice && item.options.size() > 1
             ? fmt::format("please answer with a number from 1 to {}", item.options.size())
             : wrong;
}

constexpr std::string_view without_this_form =
    "every answer given before this form is kept; --resume begins the form again";
}  // namespace

std::string TerminalParticipant::answer_to(const protocols::FormItem& item) {
  say("\n{}\n", item.question);
  for (std::size_t i = 0; i < item.options.size(); ++i) {
    say("  {}  {}\n", i + 1, item.options[i].label);
  }
  while (true) {
    say("  {}{}: ", what_to_type(item), item.is_required ? "" : "; Enter leaves it out");
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

Participant::FormAnswers TerminalParticipant::fill_in(const protocols::Form& form) {
  if (forget_typed_ahead()) {
    ask_to_stop();
    stop_if_asked(without_this_form);
  }
  say("\n{}\n{}\n", form.title, marked_text(form.text, is_shown_by_terminal()));
  FormAnswers answers;
  for (const protocols::FormItem& item : form.items) {
    if (std::string answer = answer_to(item); !answer.empty()) {
      answers.emplace(item.name, std::move(answer));
    }
  }
  return answers;
}
}  // namespace tapstudy::runner
