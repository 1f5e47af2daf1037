#include "runner/experiments/study_summary.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "runner/experiments/stored_protocol.hpp"
#include "runner/experiments/study_design.hpp"
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

// The sessions that ended early: "P03: 5 of 8 trials".
std::vector<std::string> unfinished(results::Store& store, const protocols::Protocol& protocol,
                                    const std::vector<results::SessionRow>& sessions, Mode mode) {
  const std::map<std::string, std::string> excluded = store.excluded_participants();
  std::map<std::string, std::ptrdiff_t> planned;
  for (const results::SessionRow& session : sessions) {
    if (session.mode == mode && !excluded.contains(session.participant_id)) {
      planned[session.participant_id] = std::ranges::count(session.planned_order, '\n');
    }
  }
  std::vector<std::string> found;
  for (const auto& [participant, trials] : planned) {
    const auto done = std::ssize(store.answered_trials(participant)) +
                      std::ssize(given_up_trials(protocol, participant, store)) +
                      std::ssize(unneeded_trials(protocol, participant, store));
    if (done < trials) {
      found.push_back(fmt::format("{}: {} of {} trials", participant, done, trials));
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
}  // namespace

Summary summary_of_study(results::Store& store, Mode mode, const std::string& directory) {
  const results::StudyRow study = store.study();
  const std::vector<results::SessionRow> sessions = store.sessions();
  const std::map<std::string, std::string> excluded = store.excluded_participants();
  std::vector<results::AnswerRow> answers = store.answers();
  std::erase_if(answers, [&](const results::AnswerRow& answer) {
    return answer.mode != mode || answer.is_practice || answer.is_catch ||
           excluded.contains(answer.participant_id);
  });
  if (answers.empty()) {
    throw core::InvalidInput{fmt::format("{}: no answers of {} participants to report", directory,
                                         results::to_text(mode))};
  }
  results::AlternativesOfTrials alternatives = store.alternatives();
  for (results::AnswerRow& answer : answers) {
    answer.alternatives = std::move(alternatives[answer.trial_id]);
  }
  const protocols::Protocol protocol = stored_protocol(study);
  std::vector<results::VisitRow> visits = store.visits();
  std::erase_if(visits, [&](const results::VisitRow& visit) {
    return std::ranges::find(answers, visit.participant_id, &results::AnswerRow::participant_id) ==
           answers.end();
  });
  Summary summary = analysis::summarise(design_of(protocol, mode), answers, visits);
  summary.provenance = provenance(study, sessions, mode);
  summary.unfinished = unfinished(store, protocol, sessions, mode);
  summary.excluded = excluded_of(excluded, sessions, mode);
  summary.deviations = deviations_of(store, excluded, mode);
  return summary;
}
}  // namespace tapstudy::runner
