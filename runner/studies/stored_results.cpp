#include "runner/studies/stored_results.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "analysis/statistics/resampling/replicates.hpp"
#include "protocols/procedures/quest_plus_track.hpp"
#include "protocols/protocol.hpp"
#include "protocols/schedule/schedule.hpp"
#include "results/export/table.hpp"
#include "results/rows.hpp"
#include "results/store/form_amendments.hpp"
#include "results/store/study_queries.hpp"
#include "runner/session/engine/between_trials.hpp"
#include "runner/session/engine/remaining_trials.hpp"
#include "runner/studies/stored_study.hpp"
namespace tapstudy::runner {
namespace {
// Fills in each answer's place in its block, from the order that was stored.
void set_places(const std::vector<results::SessionRow>& sessions,
                std::vector<results::AnswerRow>& answers) {
  // all sessions of a participant have one order
  std::unordered_map<std::string, std::map<std::string, int>> first_trials_of;
  for (const results::SessionRow& session : sessions) {
    first_trials_of.try_emplace(session.participant_id,
                                protocols::first_trials(session.planned_order));
  }
  for (results::AnswerRow& answer : answers) {
    answer.place_in_block =
        answer.number - first_trials_of.at(answer.participant_id).at(answer.block);
  }
}

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
  result.procedure = settings.describe();
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
                                 posterior.standard_deviation,
                                 protocols::is_at_end_of_grid(posterior, settings)});
  }
  return result;
}

// What a replay takes of the store.
struct AnswersInOrder {
  results::SessionRow session;  // the participant's latest; all have one order
  std::vector<results::JournalledAnswer> answers;
};

AdaptiveBlocks replayed(const protocols::Protocol& protocol, const AnswersInOrder& of) {
  return {protocol, of.session.seed,
          protocols::make_schedule(protocol, of.session.seed, of.session.order_index,
                                   of.session.planned_order),
          of.answers};
}

void add_tracks(const protocols::Protocol& protocol, const std::string& participant,
                const AdaptiveBlocks& adaptive, std::vector<TrackResult>& results) {
  for (const Block& block : protocol.blocks) {
    for (std::size_t i = 0; has_results(block) && i < block.comparison->tracks.size(); ++i) {
      TrackResult result =
          result_of(adaptive.tracks_of(block.name).track(i), *block.comparison->tracks[i]);
      result.participant_id = participant;
      result.block = block.name;
      result.is_signed = block.comparison->side == protocols::Side::either;
      result.track = static_cast<int>(i) + 1;
      results.push_back(std::move(result));
    }
  }
}
}  // namespace

ReplayedTracks::ReplayedTracks(const protocols::Protocol& protocol, results::Store& store)
    : protocol_{protocol},
      store_{store},
      has_any_{std::ranges::any_of(protocol.blocks, has_results)} {}

void ReplayedTracks::replay(const std::set<std::string>& participants) {
  std::vector<std::pair<AnswersInOrder, std::optional<AdaptiveBlocks>*>> missing;
  for (const std::string& participant : participants) {
    const auto [person, is_new] = people_.try_emplace(participant);
    if (!is_new || !has_any_) {
      continue;
    }
    if (auto session = store_.latest_session(participant)) {
      missing.push_back(
          {{std::move(*session), store_.answers_as_given(participant)}, &person->second});
    }
  }
  analysis::parallel_for(missing.size(), 0, [&](std::size_t i) {
    missing[i].second->emplace(replayed(protocol_, missing[i].first));
  });
}

std::vector<TrackResult> ReplayedTracks::results_of(const std::set<std::string>& participants) {
  replay(participants);
  std::vector<TrackResult> results;
  for (const std::string& participant : participants) {
    if (const auto& adaptive = people_.at(participant)) {
      add_tracks(protocol_, participant, *adaptive, results);
    }
  }
  return results;
}

void ReplayedTracks::set_tracks(std::vector<results::AnswerRow>& answers) {
  std::set<std::string> participants;
  for (const results::AnswerRow& answer : answers) {
    participants.insert(answer.participant_id);
  }
  replay(participants);
  for (results::AnswerRow& answer : answers) {
    if (const auto& adaptive = people_.at(answer.participant_id)) {
      const auto track = adaptive->track_of(answer.number);
      answer.track = track ? std::optional{static_cast<int>(*track) + 1} : std::nullopt;
    }
  }
}

namespace {
// Of a trial that a procedure chose.
results::Cell level_of(const std::vector<results::AlternativeRow>& alternatives,
                       const protocols::Comparison& comparison) {
  const auto compared =
      std::ranges::find(alternatives, true, &results::AlternativeRow::is_comparison);
  if (compared == alternatives.end()) {
    return {};
  }
  const auto value = compared->axis_values.find(comparison.axis);
  return value == compared->axis_values.end() ? results::Cell{}
                                              : results::Cell{comparison.level_of(value->second)};
}

// How far a participant's track has been gone through, and where it turned.
struct TrackSoFar {
  std::size_t trials{};
  std::vector<protocols::Reversal> reversals;
};
// By participant, block and track.
using TracksSoFar = std::map<std::tuple<std::string, std::string, int>, TrackSoFar>;

bool is_reversal(const AdaptiveBlocks& replayed, const results::AnswerRow& answer,
                 TracksSoFar& tracks) {
  const auto [track, is_new] =
      tracks.try_emplace({answer.participant_id, answer.block, *answer.track});
  if (is_new) {
    track->second.reversals = replayed.tracks_of(answer.block)
                                  .track(static_cast<std::size_t>(*answer.track) - 1)
                                  .summary()
                                  .reversals;
  }
  return std::ranges::find(track->second.reversals, ++track->second.trials,
                           &protocols::Reversal::trial) != track->second.reversals.end();
}
}  // namespace

results::Table tracks_table(const protocols::Protocol& protocol, results::Store& store) {
  std::vector<results::AnswerRow> answers = results::stored_answers(store);
  std::ranges::stable_sort(answers, {}, &results::AnswerRow::trial_id);
  ReplayedTracks replayed{protocol, store};
  replayed.set_tracks(answers);
  const results::AlternativesOfTrials alternatives = store.alternatives();
  TracksSoFar tracks;
  std::vector<results::Row> rows;
  for (const results::AnswerRow& answer : answers) {
    if (answer.track) {
      rows.push_back(
          {answer.trial_id, answer.participant_id, answer.block, std::int64_t{answer.number},
           std::int64_t{*answer.track},
           level_of(alternatives.at(answer.trial_id), *protocol.block(answer.block).comparison),
           answer.is_correct ? results::Cell{std::int64_t{*answer.is_correct}} : results::Cell{},
           std::int64_t{is_reversal(replayed.blocks_of(answer.participant_id), answer, tracks)}});
    }
  }
  return results::table_of(
      "tracks", "A row an answered trial whose level a procedure chose.",
      results::known_columns(
          "trial_id participant_id block number track level is_correct is_reversal"),
      std::move(rows));
}

namespace {
using results::Mode;
using Excluded = std::map<std::string, std::string>;  // by id: why

// The participants who were not excluded.
std::set<std::string> counted_participants(const std::vector<results::SessionRow>& sessions,
                                           const Excluded& excluded, Mode mode) {
  std::set<std::string> participants;
  for (const results::SessionRow& session : sessions) {
    if (session.mode == mode && !excluded.contains(session.participant_id)) {
      participants.insert(session.participant_id);
    }
  }
  return participants;
}

// Those whose answer to a form ended their session, and which: as the protocol says, but to be
// told.
std::map<std::string, std::string> who_took_no_part(results::Store& store,
                                                    const protocols::Protocol& protocol,
                                                    const std::set<std::string>& participants) {
  std::map<std::string, std::string> found;
  for (const std::string& participant : participants) {
    if (const auto answer = ending_answer(protocol, store.form_answers_of(participant))) {
      found.emplace(participant, *answer);
    }
  }
  return found;
}

std::vector<std::string> unfinished(results::Store& store, const protocols::Protocol& protocol,
                                    const std::set<std::string>& participants,
                                    const std::map<std::string, std::string>& without_part) {
  std::vector<std::string> found;
  for (const std::string& participant : participants) {
    if (without_part.contains(participant)) {
      continue;
    }
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
    parts.push_back(fmt::format(
        "answers corrected: {}{}", course.corrected,
        course.corrected_to_right > 0
            ? fmt::format(" ({} of them from wrong to right)", course.corrected_to_right)
            : ""));
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
  if (course.incomplete_trials > 0) {
    parts.push_back(
        fmt::format("trials in which more than {:g} % of the loop's periods were missed: {}",
                    100.0 * results::max_skipped_share, course.incomplete_trials));
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

// "P03: answer to 'age' of form 'about' corrected from 13 to 31"; free text is nobody's business.
std::vector<std::string> amended_answers(results::Store& store, const protocols::Protocol& protocol,
                                         const std::set<std::string>& participants) {
  std::map<std::int64_t, std::string> people;
  for (const results::SessionRow& session : store.sessions()) {
    people.emplace(session.id, session.participant_id);
  }
  std::vector<std::string> found;
  for (const results::FormAmendment& amendment : results::form_amendments(store)) {
    const std::string& participant = people.at(amendment.session_id);
    const auto form = protocol.forms.find(amendment.form);
    const protocols::Form none;
    const auto& items = (form == protocol.forms.end() ? none : form->second).items;
    const auto item = std::ranges::find(items, amendment.item, &protocols::FormItem::name);
    const bool is_text = item == items.end() || item->kind == protocols::ItemKind::text;
    if (participants.contains(participant)) {
      found.push_back(fmt::format(
          "{}: answer to '{}' of form '{}' corrected{}", participant, amendment.item,
          amendment.form,
          is_text ? ""
                  : fmt::format(" from {} to {}", amendment.before.value_or("no answer"),
                                amendment.after)));
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

std::set<std::string> participants_of(results::Store& store, Mode mode) {
  return counted_participants(store.sessions(), store.excluded_participants(), mode);
}

StoredResults stored_results(results::Store& store, const protocols::Protocol& protocol, Mode mode,
                             ReplayedTracks* tracks) {
  const Excluded excluded = store.excluded_participants();
  StoredResults found;
  found.sessions = store.sessions();
  found.answers = counted_answers(store, mode);
  set_places(found.sessions, found.answers);
  if (tracks != nullptr) {
    tracks->set_tracks(found.answers);
  }
  std::set<std::string> answering;
  for (const results::AnswerRow& answer : found.answers) {
    answering.insert(answer.participant_id);
  }
  found.visits = results::stored_visits(store);
  std::erase_if(found.visits, [&](const results::VisitRow& visit) {
    return !answering.contains(visit.participant_id);
  });
  const std::set<std::string> participants = counted_participants(found.sessions, excluded, mode);
  const auto without_part = who_took_no_part(store, protocol, participants);
  found.unfinished = unfinished(store, protocol, participants, without_part);
  found.excluded = excluded_of(excluded, found.sessions, mode);
  found.deviations = deviations_of(store, mode);
  std::ranges::move(amended_answers(store, protocol, participants),
                    std::back_inserter(found.deviations));
  for (const auto& [participant, answer] : without_part) {
    found.deviations.push_back(fmt::format("{} took no part: answered {}", participant, answer));
  }
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
