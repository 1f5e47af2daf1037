#include "analysis/report/document/wording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
namespace tapstudy::analysis {
namespace {
// As many digits of percent as the ends of an interval take to differ.
int digits_of(const Interval& interval) {
  constexpr int max_digits = 3;
  int digits = 0;
  const auto in_percent = [&](double share) {
    return fmt::format("{:.{}f}", 100.0 * share, digits);
  };
  while (digits < max_digits && in_percent(interval.low) == in_percent(interval.high)) {
    ++digits;
  }
  return digits;
}
}  // namespace

std::string fraction(const Proportion& proportion) {
  return fmt::format("{}/{}", proportion.successes, proportion.trials);
}

std::string percent(const Proportion& proportion) {
  return proportion.trials == 0 ? "–" : percent(proportion.value());
}

std::string percent(double share) {
  return fmt::format("{:.0f} %", 100.0 * share);
}

std::string fraction_and_percent(const Proportion& proportion) {
  return fmt::format("{} = {}", fraction(proportion), percent(proportion));
}

std::string with_interval(const Proportion& proportion) {
  if (proportion.trials == 0) {
    return "no answers";
  }
  const Interval interval = wilson_interval(proportion);
  return fmt::format("{} = {:.{}f} % (95 % CI {})", fraction(proportion),
                     100.0 * proportion.value(), digits_of(interval), percent_range(interval));
}

std::string percent_range(const Interval& shares) {
  const int digits = digits_of(shares);
  return fmt::format("{:.{}f}–{:.{}f} %", 100.0 * shares.low, digits, 100.0 * shares.high, digits);
}

std::string finding_of(const HypothesisResult& result) {
  return result.finding.empty() ? fmt::format("{} against {:.0f} % by chance",
                                              fraction(result.observed), 100.0 * result.chance)
                                : result.finding;
}

std::string adjusted_in_words(double p, double p_holm, bool are_several) {
  return p_value(p) +
         (are_several ? fmt::format(", {} after {}", p_value(p_holm), "Holm 1979"_source) : "");
}

std::string among_them(std::int64_t number, std::string_view what) {
  return number == 0 ? "" : fmt::format(", {} of them {}", number, what);
}

std::string people_in_words(std::int64_t number, std::int64_t took_part, std::int64_t beyond) {
  const std::int64_t all = std::max(number, took_part);
  const std::string of = number < all ? fmt::format(" of {}", all) : "";
  return fmt::format("{}{} participant{}{}", number, of, all == 1 ? "" : "s",
                     among_them(beyond, "beyond the levels"));
}

std::string contrast_in_words(double mean, const std::optional<Interval>& interval, bool is_ratio) {
  if (std::isnan(mean)) {
    return "by order alone";
  }
  const auto shown = [&](double value) { return rounded(is_ratio ? std::exp(value) : value); };
  const std::string range =
      interval ? fmt::format(", 95 % CI {} to {}", shown(interval->low), shown(interval->high))
               : "";
  return fmt::format("mean {} {}{}", is_ratio ? "ratio" : "difference", shown(mean), range);
}

std::string in_words(const MainResult& result, std::int64_t took_part) {
  const auto value = [&] {
    if (!result.range) {
      return fmt::format("{} for all", rounded(result.estimate));
    }
    return result.chance ? fmt::format("{} (95 % CI {}, chance {})", percent(result.estimate),
                                       percent_range(*result.range), percent(*result.chance))
                         : fmt::format("{} (95 % CI {} to {})", rounded(result.estimate),
                                       rounded(result.range->low), rounded(result.range->high));
  };
  return fmt::format("{} {}{}{}", result.name, value(),
                     result.people ? ", of " + people_in_words(*result.people, took_part) : "",
                     result.of_whom);
}

std::string p_value(const HypothesisResult& result) {
  if (!result.p) {
    return "not tested";
  }
  return result.p_floor > 0.0 ? fmt::format("p ≤ 1/{:.0f}", 1.0 / result.p_floor)
                              : p_value(*result.p);
}

std::string p_value(double p) {
  if (p < 0.001) {
    return "p < .001";
  }
  const std::string digits = fmt::format("{:.3f}", p);
  return "p = " + (digits.front() == '0' ? digits.substr(1) : digits);
}

std::string over_participants(const Proportion& all, const MeanShare& over) {
  const std::string mean = percent(over.mean);
  const std::string range =
      over.interval ? "95 % CI " + percent_range(*over.interval) : "no CI for so few";
  if (mean != percent(all.value())) {
    return fmt::format("(mean of {} participants {}, {})", over.participants, mean, range);
  }
  return over.interval ? fmt::format("(95 % CI over {} participants {})", over.participants,
                                     percent_range(*over.interval))
                       : fmt::format("({} participants, {})", over.participants, range);
}

Cell pooled_proportion(const std::vector<Proportion>& participants) {
  if (participants.size() == 1) {
    return proportion(participants.front());
  }
  const Proportion all = sum(participants);
  if (all.trials == 0) {
    return proportion(all);
  }
  Cell cell = counted(all);
  const auto over = mean_share(participants);
  if (over) {
    cell.text += " " + over_participants(all, *over);
  }
  if (over && over->interval) {
    cell.values.insert(cell.values.end(), {over->interval->low, over->interval->high});
  } else {
    cell.values.resize(cell.values.size() + 2);
  }
  return cell;
}
}  // namespace tapstudy::analysis
