#include "runner/experiments/study_summary.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "analysis/report/block_contrasts.hpp"
#include "core/error.hpp"
#include "runner/experiments/counted_answers.hpp"
#include "runner/experiments/places_in_blocks.hpp"
#include "runner/experiments/procedure_words.hpp"
#include "runner/experiments/stored_protocol.hpp"
#include "runner/experiments/study_design.hpp"
#include "runner/experiments/study_sections.hpp"
#include "runner/experiments/track_results.hpp"
#include "runner/session/given_up_trials.hpp"
namespace tapstudy::runner {
namespace {
using analysis::Summary;
using results::Mode;

std::vector<std::pair<std::string, std::string>> provenance(
    const results::StudyRow& study, const std::vector<results::SessionRow>& sessions, Mode mode) {
  std::set<std::string> programs;
  std::set<std::string> devices;
  std::vector<std::string> seeds;
  for (const results::SessionRow& session : sessions) {
    if (session.mode == mode) {
      programs.insert(
          fmt::format("{} ({}, {})", session.program_version, session.git_hash, session.compiler));
      devices.insert(
          fmt::format("{}, {} Hz, {}", session.device, session.rate_hz, session.scheduler));
      seeds.push_back(fmt::format("{} {}", session.participant_id, session.seed));
    }
  }
  return {{"protocol", study.protocol_file},
          {"protocol SHA-256", study.protocol_sha256},
          {"tapstudy", fmt::format("{}", fmt::join(programs, "; "))},
          {"device", fmt::format("{}", fmt::join(devices, "; "))},
          {"seeds", fmt::format("{}", fmt::join(seeds, ", "))}};
}

std::vector<results::SessionRow> sessions_of(const std::vector<results::SessionRow>& all,
                                             Mode mode) {
  std::vector<results::SessionRow> of;
  std::ranges::copy_if(all, std::back_inserter(of),
                       [&](const results::SessionRow& session) { return session.mode == mode; });
  return of;
}

// The sessions that ended early: "P03: 5 of 8 trials".
std::vector<std::string> unfinished(results::Store& store, const protocols::Protocol& protocol,
                                    const std::vector<results::SessionRow>& sessions, Mode mode) {
  const std::map<std::string, std::string> excluded = store.excluded_participants();
  std::set<std::string> participants;
  for (const results::SessionRow& session : sessions) {
    if (session.mode == mode && !excluded.contains(session.participant_id)) {
      participants.insert(session.participant_id);
    }
  }
  std::vector<std::string> found;
  for (const std::string& participant : participants) {
    const TrialsDone trials = trials_done(protocol, participant, store);
    if (!trials.are_all()) {
      found.push_back(fmt::format("{}: {} of {} trials", participant, trials.done, trials.planned));
    }
  }
  return found;
}

using Excluded = std::map<std::string, std::string>;  // by id: why
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

// "P03: 2 answers corrected (1 of them from wrong to right), 1 trial skipped".
std::vector<std::string> deviations_of(results::Store& store, const Excluded& excluded, Mode mode) {
  std::vector<std::string> found;
  for (const results::DeviationRow& row : store.deviations()) {
    if (row.mode != mode || excluded.contains(row.participant_id)) {
      continue;
    }
    std::vector<std::string> parts;
    if (row.corrected > 0) {
      parts.push_back(fmt::format("answers corrected: {} ({} of them from wrong to right)",
                                  row.corrected, row.corrected_to_right));
    }
    if (row.skipped > 0) {
      parts.push_back(fmt::format("trials skipped: {}", row.skipped));
    }
    if (row.timed_out > 0) {
      parts.push_back(fmt::format("presentations that timed out: {}", row.timed_out));
    }
    if (row.missed_catch_trials > 0) {
      parts.push_back(
          fmt::format("catch trials missed: {} of {}", row.missed_catch_trials, row.catch_trials));
    }
    found.push_back(fmt::format("{}: {}", row.participant_id, fmt::join(parts, ", ")));
  }
  return found;
}
// Of one store.
struct StoredResults {
  std::vector<results::SessionRow> sessions;
  std::vector<results::AnswerRow> answers;  // that count
  std::vector<results::VisitRow> visits;    // of those who gave them
  std::vector<std::string> unfinished;
  std::vector<std::string> excluded;
  std::vector<std::string> deviations;
  analysis::Presentations presentations;
};

// Of trials with several alternatives. Settings of an adjusted alternative are not told apart.
std::vector<analysis::VisitOrder> visit_orders(results::Store& store) {
  std::vector<analysis::VisitOrder> orders;
  store.each_row(
      "SELECT trial_id, position FROM v_visits WHERE status = 'answered' AND EXISTS "
      "(SELECT 1 FROM alternative AS second WHERE second.trial_id = v_visits.trial_id "
      "AND second.position = 1) ORDER BY trial_id, visit",
      [&](results::Statement& row) {
        if (orders.empty() || orders.back().trial_id != row.integer(0)) {
          orders.push_back({row.integer(0), {}});
        }
        orders.back().positions.push_back(row.small_integer(1));
      });
  return orders;
}

std::map<std::string, int> missing_replies(results::Store& store, const Excluded& excluded,
                                           const std::vector<results::SessionRow>& sessions,
                                           Mode mode) {
  std::set<std::string> participants;
  for (const results::SessionRow& session : sessions) {
    if (session.mode == mode && !excluded.contains(session.participant_id)) {
      participants.insert(session.participant_id);
    }
  }
  std::map<std::string, int> missing;
  for (const std::string& participant : participants) {
    for (const results::UnansweredTrial& trial : store.unanswered_trials(participant)) {
      ++missing[trial.block];
    }
  }
  return missing;
}

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
  std::set<std::string> participants;
  for (const results::AnswerRow& answer : found.answers) {
    participants.insert(answer.participant_id);
  }
  found.visits = store.visits();
  std::erase_if(found.visits, [&](const results::VisitRow& visit) {
    return !participants.contains(visit.participant_id);
  });
  found.unfinished = unfinished(store, protocol, found.sessions, mode);
  found.excluded = excluded_of(excluded, found.sessions, mode);
  found.deviations = deviations_of(store, excluded, mode);
  found.presentations = {analysis::orders_of(visit_orders(store), found.answers),
                         missing_replies(store, excluded, found.sessions, mode)};
  return found;
}

void check_same_protocol(const std::vector<StudyStore>& stores) {
  const results::StudyRow first = stores.front().store->study();
  for (const StudyStore& other : stores) {
    const results::StudyRow study = other.store->study();
    if (study.protocol_sha256 != first.protocol_sha256 || study.surfaces != first.surfaces) {
      throw core::InvalidInput{fmt::format(
          "{} and {} hold different protocols: their answers cannot be put into one report",
          stores.front().directory, other.directory)};
    }
  }
}

// Of whatever name: a redacted copy has the sessions of its study.
void check_different_participants(const std::vector<StudyStore>& stores) {
  std::map<std::string, std::string> directories;
  std::map<std::pair<std::uint64_t, std::string>, std::string> begun;
  for (const StudyStore& each : stores) {
    std::set<std::string> here;
    for (const results::SessionRow& session : each.store->sessions()) {
      here.insert(session.participant_id);
      const auto [other, is_new] =
          begun.try_emplace({session.seed, session.started_utc}, each.directory);
      if (!is_new && other->second != each.directory) {
        throw core::InvalidInput{
            fmt::format("{} and {} hold the same session, begun {} with the seed {}: is one a copy "
                        "of the other?",
                        other->second, each.directory, session.started_utc, session.seed)};
      }
    }
    for (const std::string& participant : here) {
      const auto [before, is_new] = directories.try_emplace(participant, each.directory);
      if (!is_new) {
        throw core::InvalidInput{fmt::format("participant {} is in {} and in {}", participant,
                                             before->second, each.directory)};
      }
    }
  }
}

template <class Row>
void append(std::vector<Row>& all, std::vector<Row> more) {
  all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

// Participants are counted on, since each of them has an order of their own to draw again. Their
// balanced orders stay those that they had.
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
}  // namespace

Summary summary_of_study(const std::vector<StudyStore>& stores, Mode mode, Detail detail) {
  check_same_protocol(stores);
  check_different_participants(stores);
  const results::StudyRow study = stores.front().store->study();
  const protocols::Protocol protocol = stored_protocol(study);
  StoredResults all;
  std::vector<std::string> directories;
  for (const StudyStore& each : stores) {
    append(all, stored_results(*each.store, protocol, mode, detail));
    directories.push_back(each.directory);
  }
  if (all.answers.empty()) {
    throw core::InvalidInput{fmt::format(
        "{}: no answers of {} participants to report{}", fmt::join(directories, ", "),
        results::to_text(mode),
        all.excluded.empty() ? "" : fmt::format(" ({} excluded)", all.excluded.size()))};
  }
  analysis::StudyDesign design = design_of(protocol, mode);
  if (detail == Detail::main_results) {
    for (analysis::BlockDesign& block : design.blocks) {
      block.is_for_main_results = true;
    }
    return analysis::summarise(design, all.answers, all.visits, all.presentations);
  }
  Summary summary = analysis::summarise(design, all.answers, all.visits, all.presentations);
  summary.sections = study_sections(protocol, stores, mode);
  const bool is_order_fixed = protocol.block_order.order == protocols::Order::listed;
  if (auto contrasts = analysis::block_contrasts(summary.blocks, is_order_fixed)) {
    summary.sections.insert(summary.sections.begin(), std::move(*contrasts));
  }
  summary.provenance = provenance(study, all.sessions, mode);
  summary.procedure = procedure_words(protocol, sessions_of(all.sessions, mode));
  summary.unfinished = std::move(all.unfinished);
  summary.excluded = std::move(all.excluded);
  summary.deviations = std::move(all.deviations);
  return summary;
}
}  // namespace tapstudy::runner
