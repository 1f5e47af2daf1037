#pragma once
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "analysis/report/study/adaptive_tracks.hpp"
#include "analysis/report/summary.hpp"
#include "protocols/protocol.hpp"
#include "results/export/table.hpp"
#include "results/store/store.hpp"
#include "runner/session/engine/adaptive_blocks.hpp"
#include "runner/studies/stored_study.hpp"
namespace tapstudy::runner {
// The adaptive procedures of one store's participants, replayed from their answers once. Both
// outlive it.
class ReplayedTracks {
 public:
  ReplayedTracks(const protocols::Protocol& protocol, results::Store& store);
  // Replays those who have not been yet, at once on all processors.
  void replay(const std::set<std::string>& participants);
  // Results of the procedures in blocks that are no practice.
  std::vector<analysis::TrackResult> results_of(const std::set<std::string>& participants);
  // Sets the answers' tracks.
  void set_tracks(std::vector<results::AnswerRow>& answers);
  // As they stand after all answers of one who was replayed and has a session.
  const AdaptiveBlocks& blocks_of(const std::string& participant) const {
    return *people_.at(participant);
  }

 private:
  const protocols::Protocol& protocol_;
  results::Store& store_;
  bool has_any_;
  std::map<std::string, std::optional<AdaptiveBlocks>> people_;  // unset: has no session
};
// The procedure that chose each answered trial's level, and how its track went.
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

// With the tracks of their answers, unless they are not given.
StoredResults stored_results(results::Store& store, const protocols::Protocol& protocol,
                             results::Mode mode, ReplayedTracks* tracks);

// Those of the mode who were not excluded.
std::set<std::string> participants_of(results::Store& store, results::Mode mode);

// Participants are counted on, since each of them has an order of their own to draw again. Their
// balanced orders stay those that they had.
void append(StoredResults& all, StoredResults more);
}  // namespace tapstudy::runner
