#include "core/text/spreadsheet_cell.hpp"

#include <algorithm>
#include <array>

#include "core/text/plain_text.hpp"
namespace tapstudy::core {
namespace {
bool begins_as_formula(std::string_view text) {
  constexpr std::array<std::string_view, 11> beginnings{"=",
                                                        "+",
                                                        "-",
                                                        "@",
                                                        "\t",
                                                        "\r",
                                                        "\n",
                                                        "\xEF\xBC\x9D",
                                                        "\xEF\xBC\x8B",
                                                        "\xEF\xBC\x8D",
                                                        "\xEF\xBC\xA0"};
  return std::ranges::any_of(beginnings,
                             [&](std::string_view begin) { return text.starts_with(begin); });
}

bool is_number(std::string_view text) {
  const bool has_its_characters =
      text.find_first_not_of("0123456789+-.eE") == std::string_view::npos;
  return has_its_characters && number_in<double>(text.substr(text.starts_with('+') ? 1 : 0));
}

// Whether it is a formula, or one behind apostrophes.
bool is_formula(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of('\''), text.size()));
  return begins_as_formula(text) && !is_number(text);
}
}  // namespace

std::string guarded_cell(std::string_view text) {
  return is_formula(text) ? "'" + std::string{text} : std::string{text};
}

std::string_view text_of_cell(std::string_view cell) {
  return cell.starts_with('\'') && is_formula(cell) ? cell.substr(1) : cell;
}
}  // namespace tapstudy::core
