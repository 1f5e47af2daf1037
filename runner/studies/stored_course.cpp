#include "runner/studies/stored_course.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "core/error.hpp"
#include "core/text/plain_text.hpp"
#include "protocols/form.hpp"
#include "protocols/schedule/groups.hpp"
#include "protocols/schedule/schedule.hpp"
#include "results/store/form_amendments.hpp"
#include "runner/session/engine/alternative_rows.hpp"
#include "runner/session/engine/session_states.hpp"
#include "runner/session/operators/operator.hpp"
namespace tapstudy::runner {
namespace {
using core::quoted_name;
using protocols::PlannedTrial;
using protocols::Protocol;
using results::Statement;
using results::Store;

// Unset: this version draws another order.
std::optional<protocols::Schedule> schedule_of(const results::SessionRow& session,
                                               const Protocol& protocol) {
  try {
    protocols::Schedule schedule = protocols::make_schedule(
        protocol, session.seed, session.order_index, session.planned_order);
    return described(schedule) == session.planned_order ? std::optional{std::move(schedule)}
                                                        : std::nullopt;
  } catch (const core::Error&) {
    return std::nullopt;
  }
}

// Printed and read by another machine, values may differ in their last digits.
bool are_equal(const protocols::AxisValues& planned, const results::AxisValues& stored) {
  constexpr double rounding = 1e-9;
  return std::ranges::equal(planned, stored, [](const auto& one, const auto& other) {
    return one.first == other.first &&
           std::abs(one.second - other.second) <= rounding * std::abs(one.second);
  });
}

// What a procedure chooses is not planned: the comparison's values, and those of all alternatives
// on further axes.
bool are_equal(const std::vector<results::AlternativeRow>& planned,
               const std::vector<results::AlternativeRow>& stored, const protocols::Block& block) {
  const auto without_chosen = [&](results::AxisValues values) {
    std::erase_if(values, [&](const auto& value) {
      return block.comparison && std::ranges::find(block.comparison->further_axes, value.first) !=
                                     block.comparison->further_axes.end();
    });
    return values;
  };
  return std::ranges::equal(planned, stored, [&](const auto& one, const auto& other) {
    return one.label == other.label && one.stimulus == other.stimulus &&
           one.is_comparison == other.is_comparison &&
           (one.axis_values.empty() ||
            are_equal(one.axis_values, without_chosen(other.axis_values)));
  });
}

// Names what a stored trial, a row of `trial`, has otherwise; empty: nothing.
std::string differing(const PlannedTrial& planned, Statement& row,
                      const std::vector<results::AlternativeRow>& alternatives,
                      const Protocol& protocol) {
  const protocols::Block& block = protocol.block(planned.block);
  std::string names;
  const auto note = [&](const char* name, bool is_equal) {
    names += is_equal ? "" : (names.empty() ? "" : ", ") + std::string{name};
  };
  note("block", row.text(3) == planned.block);
  note("repetition", row.small_integer(4) == planned.repetition);
  note("is_practice", row.flag(5) == planned.is_practice);
  note("is_catch", row.flag(6) == planned.is_catch);
  note("presented", row.flag(7) == (block.presented == protocols::Presented::real_plates));
  note("alternative", are_equal(alternative_rows(planned, block), alternatives, block));
  return names;
}

void check_trials(Store& store, const Protocol& protocol, CheckedCourse& course) {
  std::map<std::int64_t, protocols::Schedule> schedules;
  for (const results::SessionRow& session : store.sessions()) {
    if (auto schedule = schedule_of(session, protocol)) {
      schedules.emplace(session.id, std::move(*schedule));
    } else {
      ++course.unknown_orders;
    }
  }
  const results::AlternativesOfTrials alternatives = store.alternatives();
  store.each_row(
      "SELECT trial_id, session_id, number, block, repetition, is_practice, is_catch, "
      "presented = 'real' FROM trial ORDER BY trial_id",
      [&](Statement& row) {
        const auto schedule = schedules.find(row.integer(1));
        if (schedule == schedules.end()) {
          return;
        }
        const auto planned =
            std::ranges::find(schedule->second, row.small_integer(2), &PlannedTrial::number);
        if (planned == schedule->second.end()) {
          course.wrong.push_back(
              fmt::format("trial {}: number {} is not in the order of session {}", row.integer(0),
                          row.integer(2), row.integer(1)));
          return;
        }
        const auto stored = alternatives.find(row.integer(0));
        const std::string names = differing(
            *planned, row,
            stored == alternatives.end() ? std::vector<results::AlternativeRow>{} : stored->second,
            protocol);
        if (!names.empty()) {
          course.wrong.push_back(fmt::format("trial {}: {} not as in the order of session {}",
                                             row.integer(0), names, row.integer(1)));
        }
      });
}

std::string name_of_group(const std::string& group) {
  return group.empty() ? "no group" : "group " + quoted_name(group);
}

bool has_blocks_of(const protocols::Group& group, const results::SessionRow& session) {
  std::set<std::string> planned;
  for (const auto& [block, number] : protocols::first_trials(session.planned_order)) {
    planned.insert(block);
  }
  return planned == std::set<std::string>(group.blocks.begin(), group.blocks.end());
}

// A group follows from the participant's place among the orders, whoever assigned it.
void check_groups(Store& store, const Protocol& protocol, CheckedCourse& course) {
  std::set<std::string> seen;
  for (const results::SessionRow& session : store.sessions()) {
    const protocols::Group* const group = protocols::group_of(protocol, session.order_index);
    const std::string expected = group == nullptr ? "" : group->name;
    const std::string stored = session.group ? session.group->name : "";
    if (expected != stored && seen.insert(session.participant_id).second) {
      course.wrong.push_back(fmt::format("participant {}: is stored in {}, order_index {} is of {}",
                                         quoted_name(session.participant_id), name_of_group(stored),
                                         session.order_index, name_of_group(expected)));
    }
    if (group != nullptr && !has_blocks_of(*group, session)) {
      course.wrong.push_back(fmt::format("session {}: its order has not the blocks of group {}",
                                         session.id, quoted_name(group->name)));
    }
  }
}

std::string name_of_session(const std::string& session) {
  return session.empty() ? "no session of the protocol" : "session " + quoted_name(session);
}

// Each session is one of the protocol's, no earlier one than the participant's before, and its
// trials are of that one's blocks.
void check_planned_sessions(Store& store, const Protocol& protocol, CheckedCourse& course) {
  std::map<std::int64_t, std::string> planned_of;
  std::map<std::string, const protocols::PlannedSession*> latest;  // by participant
  for (const results::SessionRow& session : store.sessions()) {
    const std::string& planned = planned_of[session.id] = session.planned_session.value_or("");
    const protocols::PlannedSession* const found = protocol.find_session(planned);
    if ((found == nullptr) != protocol.sessions.empty()) {
      course.wrong.push_back(fmt::format("session {}: is stored as {}, which the protocol lacks",
                                         session.id, name_of_session(planned)));
    } else if (found < std::exchange(latest[session.participant_id], found)) {
      course.wrong.push_back(fmt::format("session {}: comes after a later one than {}", session.id,
                                         name_of_session(planned)));
    }
  }
  store.each_row("SELECT session_id, block, min(trial_id) FROM trial GROUP BY session_id, block",
                 [&](Statement& row) {
                   const protocols::Block* const block = protocol.find_block(row.text(1));
                   if (block != nullptr && block->session != planned_of[row.integer(0)]) {
                     course.wrong.push_back(
                         fmt::format("trial {}: its block is of {}, session {} is stored as {}",
                                     row.integer(2), name_of_session(block->session),
                                     row.integer(0), name_of_session(planned_of[row.integer(0)])));
                   }
                 });
}

std::optional<SessionState> state_named(const std::string& text) {
  for (int i = 0; i <= static_cast<int>(SessionState::ended); ++i) {
    if (const auto state = static_cast<SessionState>(i); name(state) == text) {
      return state;
    }
  }
  return std::nullopt;
}

// One session's changes of state, in the order in which they were stored.
struct Followed {
  std::optional<SessionState> state;
  std::optional<int> number;
  double t_s{};
};

bool is_within_trial(SessionState state) {
  using enum SessionState;
  switch (state) {
    case exploring:
    case answering:
    case confirmed:
    case confidence:
    case saved:
    case repeated:
    case timed_out:
    case skipped:
    case feedback:
      return true;
    case begun:
    case instructions:
    case resting:
    case form:
    case ready:
    case paused:
    case practised:
    case faulted:
    case stopped:
    case ended:
      break;
  }
  return false;
}

// Why this change cannot come next; empty: it can.
std::string objection(const Followed& before, SessionState state, std::optional<int> number,
                      double t_s) {
  const bool may_come =
      before.state ? may_follow(*before.state, state) : state == SessionState::begun;
  if (!may_come) {
    return before.state ? fmt::format("cannot follow '{}'", name(*before.state))
                        : std::string{"cannot come first"};
  }
  const bool interrupts =
      state == SessionState::paused &&
      (before.state == SessionState::exploring || before.state == SessionState::answering);
  if ((is_within_trial(state) || interrupts) && number != before.number) {
    return "is of another trial than what came before";
  }
  const bool begins_or_fails = state == SessionState::ready || state == SessionState::faulted;
  if (begins_or_fails != number.has_value() && !is_within_trial(state) && !interrupts) {
    return number ? "is of a trial, but stands between trials" : "is of no trial";
  }
  return t_s < before.t_s ? "is earlier than what came before" : "";
}

void check_states(Store& store, CheckedCourse& course) {
  std::map<std::int64_t, Followed> sessions;
  store.each_row(
      "SELECT session_id, state, number, t_s FROM session_event ORDER BY rowid",
      [&](Statement& row) {
        const std::int64_t session = row.integer(0);
        const std::optional<SessionState> state = state_named(row.text(1));
        Followed& before = sessions[session];
        const std::string wrong = state
                                      ? objection(before, *state, row.optional_int(2), row.real(3))
                                      : std::string{"is no state of a session"};
        if (!wrong.empty()) {
          course.wrong.push_back(fmt::format("session {}: {} at {} s {}", session,
                                             quoted_name(row.text(1)), row.real(3), wrong));
        }
        before = {state, row.optional_int(2), row.real(3)};
      });
  for (const auto& [session, last] : sessions) {
    if (last.state && last.state != SessionState::ended && last.state != SessionState::stopped &&
        last.state != SessionState::faulted) {
      course.open_sessions.push_back(fmt::format(
          "session {} was neither ended nor stopped (is it running, was its program killed?)",
          session));
    }
  }
  std::vector<std::string> never_begun;
  for (const results::SessionRow& session : store.sessions()) {
    if (session.mode == results::Mode::simulated && !sessions.contains(session.id)) {
      never_begun.push_back(session.participant_id);
    }
  }
  if (!never_begun.empty()) {
    course.open_sessions.push_back(fmt::format(
        "{} simulated sessions never began, from {} on: the simulation is unfinished (is it "
        "running, was its program killed?)",
        never_begun.size(), never_begun.front()));
  }
}

// Empty: it corrects an answer that there is, from what that was to what can be answered.
std::string objection_to(const results::FormAmendment& amendment,
                         std::map<std::string, std::optional<std::string>>& answers,
                         const Protocol& protocol) {
  const auto held = answers.find(fmt::format("{} {} {} {}", amendment.session_id, amendment.form,
                                             amendment.asked, amendment.item));
  if (held == answers.end()) {
    return "there is no answer to it";
  }
  if (held->second != amendment.before) {
    return "the answer before it was another one";
  }
  held->second = amendment.after;
  const auto form = protocol.forms.find(amendment.form);
  if (form == protocol.forms.end()) {
    return "";  // which is found elsewhere
  }
  const auto item =
      std::ranges::find(form->second.items, amendment.item, &protocols::FormItem::name);
  const bool is_allowed =
      item == form->second.items.end() || wrong_with(*item, amendment.after).empty();
  return is_allowed ? "" : "it is no answer that the item takes";
}

void check_form_amendments(Store& store, const Protocol& protocol, CheckedCourse& course) {
  std::map<std::string, std::optional<std::string>> answers;
  store.each_row(
      "SELECT session_id, form, asked, item, answer FROM form_answer", [&](Statement& row) {
        answers[fmt::format("{} {} {} {}", row.integer(0), row.text(1), row.text(2), row.text(3))] =
            row.optional_text(4);
      });
  for (const results::FormAmendment& amendment : results::form_amendments(store)) {
    const std::string wrong = objection_to(amendment, answers, protocol);
    if (!wrong.empty()) {
      course.wrong.push_back(fmt::format("correction of {} in session {}: {}",
                                         quoted_name(amendment.form + "." + amendment.item),
                                         amendment.session_id, wrong));
    }
  }
}

void check_actions(Store& store, CheckedCourse& course) {
  store.each_row("SELECT action, min(action_id) FROM operator_action GROUP BY action",
                 [&](Statement& row) {
                   const std::string action = row.text(0);
                   if (action != results::form_amendment_action &&
                       std::ranges::find(operator_actions(), action, &ActionInfo::name) ==
                           operator_actions().end()) {
                     course.wrong.push_back(fmt::format("action {}: {} is no action of an operator",
                                                        row.integer(1), quoted_name(action)));
                   }
                 });
}
}  // namespace

CheckedCourse checked_course(Store& store, const Protocol& protocol) {
  CheckedCourse course;
  check_groups(store, protocol, course);
  check_planned_sessions(store, protocol, course);
  check_trials(store, protocol, course);
  check_states(store, course);
  check_actions(store, course);
  check_form_amendments(store, protocol, course);
  return course;
}
}  // namespace tapstudy::runner
