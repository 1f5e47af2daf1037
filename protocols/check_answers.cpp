#include <fmt/format.h>

#include <map>

#include "protocols/read_sections.hpp"
namespace tapstudy::protocols {
namespace {
// Blanks collapsed, as a page does, and Latin capitals small.
std::string as_it_reads(const std::string& label) {
  std::string read;
  for (const char letter : label) {
    if (letter != ' ') {
      read += letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
    } else if (!read.empty() && read.back() != ' ') {
      read += letter;
    }
  }
  return read.ends_with(' ') ? read.substr(0, read.size() - 1) : read;
}
}  // namespace

void check_labels_differ(MapReader& block_reader, const Protocol& protocol, const Block& block) {
  std::map<std::string, std::string> name_of_label;
  for (const Option& option : block.task->answers(block, protocol).options) {
    const auto [known, is_new] = name_of_label.emplace(as_it_reads(option.label), option.name);
    if (!is_new) {
      block_reader.reject(fmt::format("the answers '{}' and '{}' have the same label, '{}'",
                                      known->second, option.name, option.label));
    }
  }
}

void check_targets(MapReader& block_reader, const Protocol& protocol, const Block& block) {
  if (!block.comparison || block.comparison->side == Side::either ||
      block.task->has_own_guess_rate()) {
    return;
  }
  constexpr double least_above = 0.02;
  const double by_guessing = block.task->guess_rate(block, protocol);
  for (const auto& track : block.comparison->tracks) {
    const auto target = track->settles_at();
    if (target && *target < by_guessing + least_above) {
      block_reader.reject("procedures",
                          fmt::format("one settles at {:.3g} correct, which guessing reaches "
                                      "({:.3g}): its value would wander",
                                      *target, by_guessing));
    }
  }
}
}  // namespace tapstudy::protocols
