#include "runner/experiments/track_results.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "protocols/schedule.hpp"
#include "results/export/columns.hpp"
#include "results/stored_answers.hpp"
#include "runner/session/adaptive_blocks.hpp"
namespace tapstudy::runner {
namespace {
using analysis::TrackResult;
using protocols::Block;
using protocols::TrackSummary;

bool has_results(const Block& block) {
  return block.comparison && !block.is_practice;
}

double quantile(const protocols::ParameterPosterior& posterior, double probability) {
  return std::ranges::find(posterior.quantiles, probability, &protocols::Quantile::probability)
      ->value;
}

// One value was given: its deviation is rounding.
bool is_fixed(const protocols::ParameterPosterior& posterior) {
  constexpr double rounding = 1e-12;
  return posterior.standard_deviation <= rounding * std::abs(posterior.mean);
}

TrackResult result_of(const protocols::Track& track, const protocols::TrackSettings& settings) {
  const TrackSummary summary = track.summary();
  TrackResult result;
  result.procedure = settings.words();
  result.trials = summary.trials;
  result.is_finished = summary.is_finished;
  result.estimate = summary.estimate;
  result.settles_at = summary.target;
  result.reversals = summary.reversals.size();
  result.trials_at_limit = summary.trials_at_limit;
  for (const protocols::ParameterPosterior& posterior : summary.parameters) {
    if (is_fixed(posterior)) {
      continue;
    }
    result.parameters.push_back({posterior.name,
                                 posterior.mean,
                                 {quantile(posterior, 0.025), quantile(posterior, 0.975)},
                                 posterior.standard_deviation});
  }
  return result;
}

// Unset: the participant has no session.
std::optional<AdaptiveBlocks> replayed(const protocols::Protocol& protocol,
                                       const std::string& participant, results::Store& store) {
  const auto session = store.latest_session(participant);
  if (!session) {
    return std::nullopt;
  }
  const protocols::Schedule schedule =
      protocols::make_schedule(protocol, session->seed, session->order_index);
  return AdaptiveBlocks{protocol, session->seed, schedule, store.answers_as_given(participant)};
}

void add_tracks(const protocols::Protocol& protocol, const std::string& participant,
                results::Store& store, std::vector<TrackResult>& results) {
  const auto adaptive = replayed(protocol, participant, store);
  if (!adaptive) {
    return;
  }
  for (const Block& block : protocol.blocks) {
    for (std::size_t i = 0; has_results(block) && i < block.comparison->tracks.size(); ++i) {
      TrackResult result =
          result_of(adaptive->tracks_of(block.name).track(i), *block.comparison->tracks[i]);
      result.participant_id = participant;
      result.block = block.name;
      result.is_signed = block.comparison->side == protocols::Side::either;
      result.track = static_cast<int>(i) + 1;
      results.push_back(std::move(result));
    }
  }
}
}  // namespace

std::vector<TrackResult> track_results(const protocols::Protocol& protocol,
                                       const std::vector<StudyStore>& stores, results::Mode mode) {
  std::vector<TrackResult> results;
  if (std::ranges::none_of(protocol.blocks, has_results)) {
    return results;
  }
  for (const StudyStore& each : stores) {
    const auto excluded = each.store->excluded_participants();
    std::set<std::string> participants;
    for (const results::SessionRow& session : each.store->sessions()) {
      if (session.mode == mode && !excluded.contains(session.participant_id)) {
        participants.insert(session.participant_id);
      }
    }
    for (const std::string& participant : participants) {
      add_tracks(protocol, participant, *each.store, results);
    }
  }
  return results;
}

void set_tracks(const protocols::Protocol& protocol, results::Store& store,
                std::vector<results::AnswerRow>& answers) {
  if (std::ranges::none_of(protocol.blocks, has_results)) {
    return;
  }
  std::map<std::string, std::optional<AdaptiveBlocks>> people;
  for (results::AnswerRow& answer : answers) {
    auto found = people.find(answer.participant_id);
    if (found == people.end()) {
      found =
          people.emplace(answer.participant_id, replayed(protocol, answer.participant_id, store))
              .first;
    }
    if (found->second) {
      const auto track = found->second->track_of(answer.number);
      answer.track = track ? std::optional{static_cast<int>(*track) + 1} : std::nullopt;
    }
  }
}

results::Table tracks_table(const protocols::Protocol& protocol, results::Store& store) {
  std::vector<results::AnswerRow> answers = results::stored_answers(store);
  set_tracks(protocol, store, answers);
  std::vector<results::Row> rows;
  for (const results::AnswerRow& answer : answers) {
    if (answer.track) {
      rows.push_back({answer.trial_id, answer.participant_id, answer.block,
                      std::int64_t{answer.number}, std::int64_t{*answer.track}});
    }
  }
  return results::table_of("tracks", "A row an answered trial whose level a procedure chose.",
                           results::known_columns("trial_id participant_id block number track"),
                           std::move(rows));
}
}  // namespace tapstudy::runner
