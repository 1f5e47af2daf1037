#include "results/rows.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <initializer_list>

#include "results/store_error.hpp"
namespace tapstudy::results {
namespace {
// The one of that name. Throws StoreError, with where it was read and what it could have been.
template <class Enum>
Enum named(const std::string& text, std::initializer_list<Enum> all, const char* where) {
  std::vector<std::string> names;
  for (const Enum one : all) {
    names.push_back(to_text(one));
    if (names.back() == text) {
      return one;
    }
  }
  throw StoreError{fmt::format("{}: '{}' is none of {}", where, text, fmt::join(names, ", "))};
}
}  // namespace

std::string to_text(Mode mode) {
  switch (mode) {
    case Mode::real:
      return "real";
    case Mode::pilot:
      return "pilot";
    case Mode::simulated:
      return "simulated";
  }
  return "";
}

std::string assignment_of(const GroupRow& group) {
  return group.is_given ? "given" : "balanced";
}

std::string to_text(GivenBy given_by) {
  return given_by == GivenBy::participant ? "participant" : "operator";
}

std::string to_text(TrialStatus status) {
  switch (status) {
    case TrialStatus::answered:
      return "answered";
    case TrialStatus::interrupted:
      return "interrupted";
    case TrialStatus::repeated:
      return "repeated";
    case TrialStatus::timed_out:
      return "timed_out";
    case TrialStatus::skipped:
      return "skipped";
  }
  return "";
}

TrialStatus trial_status_from(const std::string& text) {
  using enum TrialStatus;
  return named(text, {answered, interrupted, repeated, timed_out, skipped}, "trial.status");
}

GivenBy given_by_from(const std::string& text) {
  return named(text, {GivenBy::participant, GivenBy::operator_of_session}, "response.given_by");
}

GroupRow group_from(const std::string& name, const std::string& assignment) {
  GroupRow group{name, assignment == "given"};
  if (assignment_of(group) != assignment) {
    throw StoreError{
        fmt::format("participant.group_assignment: '{}' is none of balanced, given", assignment)};
  }
  return group;
}

Mode mode_from(const std::string& text) {
  return named(text, {Mode::real, Mode::pilot, Mode::simulated}, "session.mode");
}
}  // namespace tapstudy::results
