#include "analysis/modal/recording/measured_unit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "analysis/modal/recording/sampling.hpp"
#include "core/text/plain_text.hpp"
namespace tapstudy::analysis {
namespace {
struct Unit {
  std::string_view text;
  std::string_view in_name;  // after "_" in a column's name; empty: not there
  std::optional<Quantity> quantity;
  double si;
};
constexpr double g_m_s2 = 9.80665;  // standard gravity, by definition (CGPM 1901)
constexpr std::array<Unit, 25> units{{
    {"m/s^2", "m_s2", Quantity::acceleration, 1.0},
    {"m/s2", "m_s_2", Quantity::acceleration, 1.0},
    {"m/s²", "mps2", Quantity::acceleration, 1.0},
    {"m/s**2", "", Quantity::acceleration, 1.0},
    {"ms^-2", "", Quantity::acceleration, 1.0},
    {"mm/s^2", "mm_s2", Quantity::acceleration, 1e-3},
    {"mm/s2", "", Quantity::acceleration, 1e-3},
    {"mm/s²", "", Quantity::acceleration, 1e-3},
    {"g", "g", Quantity::acceleration, g_m_s2},
    {"gn", "", Quantity::acceleration, g_m_s2},
    {"mg", "mg", Quantity::acceleration, 1e-3 * g_m_s2},
    {"m/s", "m_s", Quantity::velocity, 1.0},
    {"cm/s", "cm_s", Quantity::velocity, 1e-2},
    {"mm/s", "mm_s", Quantity::velocity, 1e-3},
    {"um/s", "um_s", Quantity::velocity, 1e-6},
    {"m", "m", Quantity::displacement, 1.0},
    {"cm", "cm", Quantity::displacement, 1e-2},
    {"mm", "mm", Quantity::displacement, 1e-3},
    {"um", "um", Quantity::displacement, 1e-6},
    {"nm", "nm", Quantity::displacement, 1e-9},
    {"v", "v", std::nullopt, 0.0},
    {"mv", "mv", std::nullopt, 0.0},
    {"volt", "volt", std::nullopt, 0.0},
    {"volts", "volts", std::nullopt, 0.0},
    {full_scale, "", std::nullopt, 0.0},
}};

MeasuredUnit measured(const Unit& unit, const std::string& text) {
  return {text, unit.quantity, unit.si};
}

// What stands in brackets at the end: "Acc (g)", "Acc [g]"; empty: nothing.
std::string in_brackets(const std::string& header) {
  constexpr std::array<std::pair<char, char>, 2> brackets{{{'(', ')'}, {'[', ']'}}};
  for (const auto& [open, close] : brackets) {
    const std::size_t begin = header.rfind(open);
    if (begin != std::string::npos && header.back() == close) {
      return core::trimmed(header.substr(begin + 1, header.size() - begin - 2));
    }
  }
  return "";
}

std::string folded(const std::string& text) {
  return core::lower_case(with_ascii_micro(text));
}

std::optional<MeasuredUnit> unit_called(const std::string& text) {
  const auto* const known = std::ranges::find(units, folded(text), &Unit::text);
  return known == units.end() ? std::nullopt : std::optional{measured(*known, text)};
}
}  // namespace

std::optional<MeasuredUnit> unit_in(const std::string& header) {
  if (const std::string text = in_brackets(header); !text.empty()) {
    return unit_called(text);
  }
  const std::string name = folded(header);
  const Unit* longest = nullptr;
  for (const Unit& unit : units) {
    const bool is_last = !unit.in_name.empty() && name.ends_with("_" + std::string{unit.in_name});
    if (is_last && (longest == nullptr || unit.in_name.size() > longest->in_name.size())) {
      longest = &unit;
    }
  }
  return longest == nullptr ? std::nullopt
                            : std::optional{measured(*longest, std::string{longest->text})};
}

std::string why_not_si(const Recording& recording, Quantity quantity) {
  const std::string inner = in_brackets(recording.unit);
  const auto stated = unit_called(inner.empty() ? recording.unit : inner);
  const auto unit = stated ? stated : unit_in(recording.channel);
  if (!unit) {
    return "";
  }
  const std::string values =
      fmt::format("{}: values of {} are in {}", recording.file, recording.channel, unit->text);
  if (!unit->quantity) {
    return fmt::format("{}: --scale says what one is in SI units", values);
  }
  if (*unit->quantity != quantity) {
    return fmt::format("{}, which is no {} (--quantity {})", values, name(quantity),
                       name(*unit->quantity));
  }
  return unit->si == 1.0 ? "" : fmt::format("{}: --scale {:g}", values, unit->si);
}
}  // namespace tapstudy::analysis
