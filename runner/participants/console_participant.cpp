#include "runner/participants/console_participant.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <charconv>

#include "runner/terminal/stop_signal.hpp"
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

void ConsoleParticipant::get_ready(const TrialPrompt& prompt) {
  move_hand_();
  input_.forget_typed_ahead();
  say("\nTrial {} of {}{}. {}\n", prompt.number, prompt.total,
      prompt.is_practice ? " (practice)" : "", prompt.question);
  if (prompt.alternative_labels.empty()) {
    for (std::size_t i = 0; i < prompt.options.size(); ++i) {
      say("  {}  {}\n", i + 1, prompt.options[i].label);
    }
    return;
  }
  say("  {}: feel that one.   = {}: choose it.\n", fmt::join(prompt.alternative_labels, ", "),
      prompt.alternative_labels.front());
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

std::optional<std::size_t> ConsoleParticipant::perform(const TrialPrompt& prompt,
                                                       Exploration& exploration) {
  return prompt.alternative_labels.empty() ? number_of_answer(prompt, exploration)
                                           : chosen_alternative(prompt, exploration);
}

std::optional<std::size_t> ConsoleParticipant::number_of_answer(const TrialPrompt& prompt,
                                                                const Exploration& exploration) {
  while (const auto word = next_line(exploration)) {
    if (const auto option = number_in(*word, prompt.options.size())) {
      return option;
    }
    say("  please type a number from 1 to {}, or quit\n", prompt.options.size());
  }
  return std::nullopt;
}

std::optional<std::size_t> ConsoleParticipant::chosen_alternative(const TrialPrompt& prompt,
                                                                  Exploration& exploration) {
  const std::vector<std::string>& labels = prompt.alternative_labels;
  while (const auto word = next_line(exploration)) {
    const bool is_choice = word->starts_with('=');
    const auto alternative = index_of(is_choice ? word->substr(1) : *word, labels);
    if (alternative && is_choice) {
      return alternative;
    }
    if (alternative) {
      exploration.switch_to(*alternative);
      say("  now {} (takes effect once the finger is off the plate)\n", labels[*alternative]);
      continue;
    }
    say("  please type {} to feel one, = and a label to choose it, or quit\n",
        fmt::join(labels, ", "));
  }
  return std::nullopt;
}

void ConsoleParticipant::saved(const TrialPrompt& prompt) {
  say("  saved, {} of {}\n", prompt.number, prompt.total);
}
}  // namespace tapstudy::runner
