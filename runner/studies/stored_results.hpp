#pragma once
#include <string>
#include <vector>

#include "analysis/report/study/adaptive_tracks.hpp"
#include "analysis/report/summary.hpp"
#include "protocols/protocol.hpp"
#include "results/export/table.hpp"
#include "results/store/store.hpp"
#include "runner/studies/stored_study.hpp"
#include "runner/studies/study_summary.hpp"
namespace tapstudy::runner {
// Results of the adaptive procedures in blocks that are no practice, for each participant of one
// mode who was not excluded.
std::vector<analysis::TrackResult> track_results(const protocols::Protocol& protocol,
                                                 const std::vector<StudyStore>& stores,
                                                 results::Mode mode);
// Sets the answers' tracks, of one store.
void set_tracks(const protocols::Protocol& protocol, results::Store& store,
                std::vector<results::AnswerRow>& answers);
// The procedure that chose each answered trial's level.
results::Table tracks_table(const protocols::Protocol& protocol, results::Store& store);

// The contents of one store for the participants of a mode, excluded ones aside.
struct StoredResults {
  std::vector<results::SessionRow> sessions;
  std::vector<results::AnswerRow> answers;  // that count
  std::vector<results::VisitRow> visits;    // of those who gave them
  std::vector<std::string> unfinished;      // "P03: 5 of 8 trials"
  std::vector<std::string> excluded;        // "P05: fell asleep"
  std::vector<std::string> deviations;      // "P03: trials skipped: 1"
  analysis::Presentations presentations;
};

StoredResults stored_results(results::Store& store, const protocols::Protocol& protocol,
                             results::Mode mode, Detail detail);

// Participants are counted on, since each of them has an order of their own to draw again. Their
// balanced orders stay those that they had.
void append(StoredResults& all, StoredResults more);
}  // namespace tapstudy::runner
