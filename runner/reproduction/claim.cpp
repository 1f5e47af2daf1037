#include "runner/reproduction/claim.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "analysis/tables/cells.hpp"
namespace tapstudy::runner {
namespace {
std::string with_unit(double value, const std::string& unit) {
  return analysis::rounded(value) + (unit.empty() ? "" : " " + unit);
}

std::string missed(const Measure& measure) {
  return fmt::format("{} is {}, not {}", measure.name, value_in_words(measure),
                     limits_in_words(measure));
}

std::string missed(const Method& method) {
  constexpr std::size_t most = 3;  // the table has all
  std::vector<std::string> words;
  for (const Measure& measure : method.measures) {
    if (!measure.holds()) {
      words.push_back(missed(measure));
    }
  }
  const std::size_t more = words.size() > most ? words.size() - most : 0;
  words.resize(words.size() - more);
  return fmt::format("{}: {}{}", method.name, fmt::join(words, "; "),
                     more > 0 ? fmt::format("; and {} more", more) : "");
}
}  // namespace

bool Measure::holds() const {
  return !is_judged() ||
         (value >= at_least.value_or(-HUGE_VAL) && value <= at_most.value_or(HUGE_VAL));
}

Measure at_least(double limit, const std::string& name, double value, const std::string& unit) {
  return {name, value, unit, limit, {}};
}
Measure at_most(double limit, const std::string& name, double value, const std::string& unit) {
  return {name, value, unit, {}, limit};
}
Measure within(double low, double high, const std::string& name, double value,
               const std::string& unit) {
  return {name, value, unit, low, high};
}
Measure shown(const std::string& name, double value, const std::string& unit) {
  return {name, value, unit};
}

double difference_percent(double value, double printed) {
  return 100.0 * std::abs(value / printed - 1.0);
}

std::string value_in_words(const Measure& measure) {
  return with_unit(measure.value, measure.unit);
}

std::string limits_in_words(const Measure& measure) {
  const auto& low = measure.at_least;
  const auto& high = measure.at_most;
  if (low && high) {
    return fmt::format("between {} and {}", analysis::rounded(*low),
                       with_unit(*high, measure.unit));
  }
  if (low) {
    return "at least " + with_unit(*low, measure.unit);
  }
  return high ? "at most " + with_unit(*high, measure.unit) : "";
}

bool Method::confirms() const {
  return std::ranges::all_of(measures, &Measure::holds);
}

std::string_view name(ClaimVerdict verdict) {
  switch (verdict) {
    case ClaimVerdict::confirmed:
      return "true";
    case ClaimVerdict::refuted:
      return "false";
    case ClaimVerdict::depends:
      break;
  }
  return "depends";
}

ClaimVerdict Claim::verdict() const {
  const auto confirming = std::ranges::count_if(methods, &Method::confirms);
  if (confirming == 0) {
    return ClaimVerdict::refuted;
  }
  return confirming == std::ssize(methods) ? ClaimVerdict::confirmed : ClaimVerdict::depends;
}

std::vector<std::string> Claim::reasons() const {
  std::vector<std::string> confirming;
  std::vector<std::string> others;
  for (const Method& method : methods) {
    if (method.confirms()) {
      confirming.push_back(method.name);
    } else {
      others.push_back(fmt::format("Does not hold {}.", missed(method)));
    }
  }
  if (!confirming.empty()) {
    others.insert(others.begin(), fmt::format("Holds {}.", fmt::join(confirming, "; ")));
  }
  return others;
}
}  // namespace tapstudy::runner
