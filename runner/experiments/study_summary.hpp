#pragma once
#include <string>
#include <vector>

#include "analysis/report/summary.hpp"
#include "results/store.hpp"
#include "runner/experiments/study_store.hpp"
namespace tapstudy::runner {
enum class Detail { all, main_results };  // of a report, or of a simulated design

// What a study says of its participants of one mode; those who were excluded, practice and catch
// trials are named, and left out of the results. Throws InvalidInput if there is no answer, two
// stores are of different protocols, or a participant is in two of them.
analysis::Summary summary_of_study(const std::vector<StudyStore>& stores, results::Mode mode,
                                   Detail detail = Detail::all);
}  // namespace tapstudy::runner
