#include "runner/reproduction/claim.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "analysis/tables/cells.hpp"
namespace tapstudy::runner {
namespace {
std::string with_unit(double value, const std::string& unit) {
  return analysis::rounded(value) + (unit.empty() ? "" : " " + unit);
}

std::string missed(const Measure& measure) {
  return fmt::format("{} is {}, not {} {}", measure.name, with_unit(measure.value, measure.unit),
                     name(measure.relation), with_unit(measure.limit, measure.unit));
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
  switch (relation) {
    case Relation::at_least:
      return value >= limit;
    case Relation::at_most:
      return value <= limit;
    case Relation::shown:
      break;
  }
  return true;
}

Measure at_least(double limit, const std::string& name, double value, const std::string& unit) {
  return {name, value, unit, Relation::at_least, limit};
}
Measure at_most(double limit, const std::string& name, double value, const std::string& unit) {
  return {name, value, unit, Relation::at_most, limit};
}
Measure shown(const std::string& name, double value, const std::string& unit) {
  return {name, value, unit};
}

std::string_view name(Relation relation) {
  switch (relation) {
    case Relation::at_least:
      return "at least";
    case Relation::at_most:
      return "at most";
    case Relation::shown:
      break;
  }
  return "shown";
}

bool Method::confirms() const {
  return std::ranges::all_of(measures, &Measure::holds);
}

std::string_view name(Verdict verdict) {
  switch (verdict) {
    case Verdict::confirmed:
      return "true";
    case Verdict::refuted:
      return "false";
    case Verdict::depends:
      break;
  }
  return "depends";
}

Verdict Claim::verdict() const {
  const auto confirming = std::ranges::count_if(methods, &Method::confirms);
  if (confirming == 0) {
    return Verdict::refuted;
  }
  return confirming == std::ssize(methods) ? Verdict::confirmed : Verdict::depends;
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
