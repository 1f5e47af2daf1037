#include "runner/session/explore_limits.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>
namespace tapstudy::runner {
namespace {
std::string times(int count) {
  return count == 1 ? "" : fmt::format(" {} times", count);
}

// Labels of the alternatives that still have to be touched.
std::vector<std::string> untouched(const TrialPrompt& prompt, std::size_t answer,
                                   const Exploration& exploration) {
  std::vector<std::string> labels;
  for (std::size_t i = 0; i < prompt.alternative_labels.size(); ++i) {
    const bool is_asked_for = prompt.explore.must_visit_all || i == answer;
    if (is_asked_for && exploration.contacts(i) < prompt.explore.min_contacts) {
      labels.push_back(prompt.alternative_labels[i]);
    }
  }
  return labels;
}
}  // namespace

std::string too_early(const TrialPrompt& prompt, std::size_t answer,
                      const Exploration& exploration) {
  const protocols::ExploreLimits& limits = prompt.explore;
  if (prompt.alternative_labels.empty()) {
    if (exploration.contacts(0) < limits.min_contacts) {
      return fmt::format("please tap the plate{} first", times(limits.min_contacts));
    }
  } else if (const auto labels = untouched(prompt, answer, exploration); !labels.empty()) {
    return fmt::format("please tap {}{} first", fmt::join(labels, ", "),
                       times(limits.min_contacts));
  }
  if (exploration.time_s() < limits.min_seconds) {
    return fmt::format("please take {:.3g} s at least", limits.min_seconds);
  }
  return "";
}
}  // namespace tapstudy::runner
