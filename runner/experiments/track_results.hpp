#pragma once
#include <vector>

#include "analysis/procedures/procedures_section.hpp"
#include "protocols/protocol.hpp"
#include "results/export/table.hpp"
#include "runner/experiments/study_store.hpp"
namespace tapstudy::runner {
// Of the procedures of the blocks that are no practice, for each participant of one mode who was
// not excluded.
std::vector<analysis::TrackResult> track_results(const protocols::Protocol& protocol,
                                                 const std::vector<StudyStore>& stores,
                                                 results::Mode mode);
// Sets the answers' tracks, of one store.
void set_tracks(const protocols::Protocol& protocol, results::Store& store,
                std::vector<results::AnswerRow>& answers);
// Which of its block's procedures chose each answered trial's level.
results::Table tracks_table(const protocols::Protocol& protocol, results::Store& store);
}  // namespace tapstudy::runner
