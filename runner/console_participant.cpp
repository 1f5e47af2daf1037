#include "runner/console_participant.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <charconv>

#include "runner/stop_signal.hpp"
namespace tapstudy::runner {
namespace {
template <class... Parts>
void say(fmt::format_string<Parts...> format, Parts&&... parts) {
  fmt::print(stderr, format, std::forward<Parts>(parts)...);
}

std::string upper_case_without_spaces(const std::string& line) {
  std::string word;
  for (const char c : line) {
    if (std::isspace(static_cast<unsigned char>(c)) == 0) {
      word += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    }
  }
  return word;
}

std::optional<std::size_t> number_in(const std::string& word, std::size_t most) {
  std::size_t number{};
  const char* const end = word.data() + word.size();
  const auto [stopped, error] = std::from_chars(word.data(), end, number);
  const bool is_allowed = error == std::errc{} && stopped == end && number >= 1 && number <= most;
  return is_allowed ? std::optional{number - 1} : std::nullopt;
}

std::optional<std::size_t> index_of(const std::string& label,
                                    const std::vector<std::string>& labels) {
  const auto found = std::ranges::find(labels, label);
  return found == labels.end() ? std::nullopt
                               : std::optional{static_cast<std::size_t>(found - labels.begin())};
}
}  // namespace

void ConsoleParticipant::get_ready(const Presentation& presentation) {
  move_hand_();
  input_.forget_typed_ahead();
  say("\nTrial {} of {}{}. {}\n", presentation.number, presentation.total,
      presentation.is_practice ? " (practice)" : "", presentation.question);
  if (presentation.task == protocols::Task::identification) {
    for (std::size_t i = 0; i < presentation.option_labels.size(); ++i) {
      say("  {}  {}\n", i + 1, presentation.option_labels[i]);
    }
    return;
  }
  say("  {}: feel that one.   = {}: choose it.\n", fmt::join(presentation.options, ", "),
      presentation.options.front());
}

std::optional<std::string> ConsoleParticipant::next_line(const Exploration& exploration) {
  say("> ");
  const auto line = input_.next([&] { return exploration.is_running() && !stop_was_asked(); });
  if (!line) {
    return std::nullopt;
  }
  std::string word = upper_case_without_spaces(*line);
  return word == "QUIT" ? std::nullopt : std::optional{std::move(word)};
}

std::optional<std::size_t> ConsoleParticipant::perform(const Presentation& presentation,
                                                       Exploration& exploration) {
  return presentation.task == protocols::Task::identification ? identify(presentation, exploration)
                                                              : choose(presentation, exploration);
}

std::optional<std::size_t> ConsoleParticipant::identify(const Presentation& presentation,
                                                        const Exploration& exploration) {
  while (const auto word = next_line(exploration)) {
    if (const auto option = number_in(*word, presentation.options.size())) {
      return option;
    }
    say("  please type a number from 1 to {}, or quit\n", presentation.options.size());
  }
  return std::nullopt;
}

std::optional<std::size_t> ConsoleParticipant::choose(const Presentation& presentation,
                                                      Exploration& exploration) {
  while (const auto word = next_line(exploration)) {
    const bool is_choice = word->starts_with('=');
    const auto option = index_of(is_choice ? word->substr(1) : *word, presentation.options);
    if (option && is_choice) {
      return option;
    }
    if (option) {
      exploration.switch_to(*option);
      say("  now {} (from the next moment the finger is off the plate)\n",
          presentation.options[*option]);
      continue;
    }
    say("  please type {} to feel one, = and a label to choose it, or quit\n",
        fmt::join(presentation.options, ", "));
  }
  return std::nullopt;
}

void ConsoleParticipant::saved(const Presentation& presentation) {
  say("  saved, {} of {}\n", presentation.number, presentation.total);
}
}  // namespace tapstudy::runner
