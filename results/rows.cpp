#include "results/rows.hpp"

#include "results/store_error.hpp"
namespace tapstudy::results {
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
  for (const TrialStatus status : {answered, interrupted, repeated, timed_out, skipped}) {
    if (to_text(status) == text) {
      return status;
    }
  }
  throw StoreError{"trial.status: '" + text +
                   "' is none of answered, interrupted, repeated, timed_out, skipped"};
}

GivenBy given_by_from(const std::string& text) {
  for (const GivenBy given_by : {GivenBy::participant, GivenBy::operator_of_session}) {
    if (to_text(given_by) == text) {
      return given_by;
    }
  }
  throw StoreError{"response.given_by: '" + text + "' is none of participant, operator"};
}

Mode mode_from(const std::string& text) {
  for (const Mode mode : {Mode::real, Mode::pilot, Mode::simulated}) {
    if (to_text(mode) == text) {
      return mode;
    }
  }
  throw StoreError{"session.mode: '" + text + "' is none of real, pilot, simulated"};
}
}  // namespace tapstudy::results
