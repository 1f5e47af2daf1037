#include "protocols/form.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <optional>

#include "core/number_in.hpp"
#include "core/plain_text.hpp"
namespace tapstudy::protocols {
namespace {
std::vector<std::string> names_of(const std::vector<Option>& options) {
  std::vector<std::string> names;
  std::ranges::transform(options, std::back_inserter(names), &Option::name);
  return names;
}

std::string unless_within(const std::string& text, double low, double high, bool is_whole) {
  const auto number = core::number_in<double>(text);
  const bool is_allowed = number && *number >= low && *number <= high &&
                          (!is_whole || *number == static_cast<double>(static_cast<int>(*number)));
  return is_allowed ? ""
                    : fmt::format("please answer with a {}number from {:.6g} to {:.6g}",
                                  is_whole ? "whole " : "", low, high);
}
}  // namespace

std::string wrong_with(const FormItem& item, const std::string& answer) {
  if (answer.empty()) {
    return item.is_required ? "please answer this question" : "";
  }
  switch (item.kind) {
    case ItemKind::likert:
      return unless_within(answer, 1.0, item.steps, true);
    case ItemKind::scale:
      return unless_within(answer, 0.0, 1.0, false);
    case ItemKind::number:
      return unless_within(answer, item.min, item.max, false);
    case ItemKind::single_choice:
      return std::ranges::find(item.options, answer, &Option::name) != item.options.end()
                 ? ""
                 : fmt::format("please answer with one of: {}",
                               fmt::join(names_of(item.options), ", "));
    case ItemKind::text:
      break;
  }
  if (!core::is_plain_text(answer)) {
    return "must be UTF-8 text without control characters";
  }
  return core::character_count(answer) <= max_form_text
             ? ""
             : fmt::format("at most {} characters", max_form_text);
}
}  // namespace tapstudy::protocols
