#include "analysis/magnitudes/magnitude_results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/error.hpp"
#include "core/number_in.hpp"
namespace tapstudy::analysis {
namespace {
using results::AnswerRow;
using OnAxis = std::optional<double>;
// Logarithms to base 10 of one stimulus's estimates, by value and participant.
using Logarithms = std::map<OnAxis, std::map<std::string, std::vector<double>>>;

double number_of(const BlockDesign& design, const AnswerRow& answer) {
  const auto number = core::number_in<double>(answer.response);
  if (!number || !(*number > 0.0) || !std::isfinite(*number)) {
    throw core::InvalidInput{
        fmt::format("block '{}', {} in trial {}: a magnitude is a number above "
                    "0, not '{}'",
                    design.name, answer.participant_id, answer.number, answer.response)};
  }
  return *number;
}

// What stands before it is the modulus.
const results::AlternativeRow& judged(const AnswerRow& answer) {
  return answer.alternatives.back();
}

OnAxis value_of(const BlockDesign& design, const AnswerRow& answer) {
  if (!design.axis || answer.alternatives.empty()) {
    return std::nullopt;
  }
  const results::AxisValues& values = judged(answer).axis_values;
  const auto found = values.find(design.axis->name.key);
  return found == values.end() ? OnAxis{} : OnAxis{found->second};
}

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) {
    sum += value;
  }
  return sum / static_cast<double>(values.size());
}

MagnitudeOfValue mean_at(const OnAxis& value,
                         const std::map<std::string, std::vector<double>>& people) {
  MagnitudeOfValue result{value, 0.0, static_cast<int>(people.size()), 0};
  std::vector<double> means;
  for (const auto& [name, logarithms] : people) {
    means.push_back(mean_of(logarithms));
    result.estimates += static_cast<int>(logarithms.size());
  }
  result.geometric_mean = std::pow(10.0, mean_of(means));
  return result;
}

void add_power_law(StimulusMagnitudes& of, const Logarithms& logarithms) {
  std::map<std::string, Estimates> people;
  std::map<std::string, std::size_t> judged_values;
  for (const auto& [value, of_people] : logarithms) {
    if (!value) {
      of.no_power_law = "its trials have no value on an axis";
      return;
    }
    for (const auto& [name, estimates] : of_people) {
      ++judged_values[name];
      for (const double logarithm : estimates) {
        people[name].push_back({*value, std::pow(10.0, logarithm)});
      }
    }
  }
  std::vector<Estimates> all;
  for (const auto& [name, estimates] : people) {
    if (judged_values[name] < logarithms.size()) {
      of.incomplete.push_back(name);
      continue;
    }
    of.participants.push_back(name);
    all.push_back(estimates);
  }
  if (all.size() == 1 && people.size() > 1) {
    of.no_power_law = "only one participant judged all values";
    return;
  }
  try {
    of.power_law = power_law(all);
  } catch (const core::NotEstimable& error) {  // too few, or participants with other values
    of.no_power_law = error.what();
  }
}
}  // namespace

std::vector<StimulusMagnitudes> magnitude_results(const BlockDesign& design,
                                                  const std::vector<AnswerRow>& answers) {
  std::map<std::string, Logarithms> stimuli;
  for (const AnswerRow& answer : answers) {
    const std::string& stimulus =
        answer.alternatives.empty() ? answer.stimulus : judged(answer).stimulus;
    stimuli[stimulus][value_of(design, answer)][answer.participant_id].push_back(
        std::log10(number_of(design, answer)));
  }
  std::vector<StimulusMagnitudes> results;
  for (const auto& [stimulus, logarithms] : stimuli) {
    StimulusMagnitudes of;
    of.stimulus = stimulus;
    add_power_law(of, logarithms);
    for (auto [value, people] : logarithms) {
      if (of.power_law) {  // each has their own unit: means are of the same people
        std::erase_if(people, [&](const auto& person) {
          return std::ranges::find(of.incomplete, person.first) != of.incomplete.end();
        });
      }
      of.values.push_back(mean_at(value, people));
    }
    results.push_back(of);
  }
  return results;
}
}  // namespace tapstudy::analysis
