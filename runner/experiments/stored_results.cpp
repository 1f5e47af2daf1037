#include "runner/experiments/stored_results.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "results/participant_courses.hpp"
#include "results/stored_answers.hpp"
#include "runner/experiments/counted_answers.hpp"
#include "runner/experiments/places_in_blocks.hpp"
#include "runner/experiments/track_results.hpp"
#include "runner/session/given_up_trials.hpp"
namespace tapstudy::runner {
namespace {
using results::Mode;
using Excluded = std::map<std::string, std::string>;  // by id: why

// Who was not excluded.
std::set<std::string> participants_of(const std::vector<results::SessionRow>& sessions,
                                      const Excluded& excluded, Mode mode) {
  std::set<std::string> participants;
  for (const results::SessionRow& session : sessions) {
    if (session.mode == mode && !excluded.contains(session.participant_id)) {
      participants.insert(session.participant_id);
    }
  }
  return participants;
}

std::vector<std::string> unfinished(results::Store& store, const protocols::Protocol& protocol,
                                    const std::set<std::string>& participants) {
  std::vector<std::string> found;
  for (const std::string& participant : participants) {
    const TrialsDone trials = trials_done(protocol, participant, store);
    if (!trials.are_all()) {
      found.push_back(fmt::format("{}: {} of {} trials", participant, trials.done, trials.planned));
    }
  }
  return found;
}

std::vector<std::string> excluded_of(const Excluded& excluded,
                                     const std::vector<results::SessionRow>& sessions, Mode mode) {
  std::vector<std::string> found;
  for (const auto& [participant, reason] : excluded) {
    const auto session =
        std::ranges::find(sessions, participant, &results::SessionRow::participant_id);
    if (session != sessions.end() && session->mode == mode) {
      found.push_back(fmt::format("{}: {}", participant, reason));
    }
  }
  return found;
}

// "P03: answers corrected: 2 (1 of them from wrong to right), trials skipped: 1"; empty: all went
// as planned.
std::string deviations_of(const results::ParticipantCourseRow& course) {
  std::vector<std::string> parts;
  if (course.corrected > 0) {
    parts.push_back(fmt::format("answers corrected: {} ({} of them from wrong to right)",
                                course.corrected, course.corrected_to_right));
  }
  if (course.skipped > 0) {
    parts.push_back(fmt::format("trials skipped: {}", course.skipped));
  }
  if (course.timed_out > 0) {
    parts.push_back(fmt::format("presentations that timed out: {}", course.timed_out));
  }
  if (course.catch_right < course.catch_trials) {
    parts.push_back(fmt::format("catch trials missed: {} of {}",
                                course.catch_trials - course.catch_right, course.catch_trials));
  }
  return parts.empty() ? "" : fmt::format("{}: {}", course.participant_id, fmt::join(parts, ", "));
}

std::vector<std::string> deviations_of(results::Store& store, Mode mode) {
  std::vector<std::string> found;
  for (const results::ParticipantCourseRow& course : results::participant_courses(store)) {
    const std::string deviations = deviations_of(course);
    if (course.mode == mode && !course.exclusion_reason && !deviations.empty()) {
      found.push_back(deviations);
    }
  }
  return found;
}

std::vector<analysis::VisitOrder> visit_orders(results::Store& store) {
  std::vector<analysis::VisitOrder> orders;
  for (const results::VisitedPosition& visit : results::visited_positions(store)) {
    if (orders.empty() || orders.back().trial_id != visit.trial_id) {
      orders.push_back({visit.trial_id, {}});
    }
    orders.back().positions.push_back(visit.position);
  }
  return orders;
}

std::map<std::string, int> missing_replies(results::Store& store,
                                           const std::set<std::string>& participants) {
  std::map<std::string, int> missing;
  for (const std::string& participant : participants) {
    for (const results::UnansweredTrial& trial : store.unanswered_trials(participant)) {
      ++missing[trial.block];
    }
  }
  return missing;
}

template <class Row>
void append(std::vector<Row>& all, std::vector<Row> more) {
  all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}
}  // namespace

StoredResults stored_results(results::Store& store, const protocols::Protocol& protocol, Mode mode,
                             Detail detail) {
  const Excluded excluded = store.excluded_participants();
  StoredResults found;
  found.sessions = store.sessions();
  found.answers = counted_answers(store, mode);
  set_places(protocol, found.sessions, found.answers);
  if (detail == Detail::all) {  // which replays the procedures
    set_tracks(protocol, store, found.answers);
  }
  std::set<std::string> answering;
  for (const results::AnswerRow& answer : found.answers) {
    answering.insert(answer.participant_id);
  }
  found.visits = results::stored_visits(store);
  std::erase_if(found.visits, [&](const results::VisitRow& visit) {
    return !answering.contains(visit.participant_id);
  });
  const std::set<std::string> participants = participants_of(found.sessions, excluded, mode);
  found.unfinished = unfinished(store, protocol, participants);
  found.excluded = excluded_of(excluded, found.sessions, mode);
  found.deviations = deviations_of(store, mode);
  found.presentations = {analysis::orders_of(visit_orders(store), found.answers),
                         missing_replies(store, participants)};
  std::erase_if(found.sessions, [&](const results::SessionRow& session) {
    return session.mode != mode || excluded.contains(session.participant_id);
  });
  return found;
}

void append(StoredResults& all, StoredResults more) {
  int next_index = 0;
  for (const results::AnswerRow& answer : all.answers) {
    next_index = std::max(next_index, answer.participant_index + 1);
  }
  std::int64_t last_trial_id = 0;  // ids of trials are those of their store
  for (const results::AnswerRow& answer : all.answers) {
    last_trial_id = std::max(last_trial_id, answer.trial_id);
  }
  for (results::AnswerRow& answer : more.answers) {
    answer.participant_index += next_index;
    answer.trial_id += last_trial_id;
  }
  for (analysis::VisitOrder& order : more.presentations.orders) {
    order.trial_id += last_trial_id;
  }
  append(all.sessions, std::move(more.sessions));
  append(all.answers, std::move(more.answers));
  append(all.visits, std::move(more.visits));
  append(all.unfinished, std::move(more.unfinished));
  append(all.excluded, std::move(more.excluded));
  append(all.deviations, std::move(more.deviations));
  append(all.presentations.orders, std::move(more.presentations.orders));
  for (const auto& [block, missing] : more.presentations.missing_replies) {
    all.presentations.missing_replies[block] += missing;
  }
}
}  // namespace tapstudy::runner
