#pragma once
#include <string>
#include <vector>

#include "analysis/report/summary.hpp"
#include "protocols/protocol.hpp"
#include "results/store.hpp"
#include "runner/experiments/study_summary.hpp"
namespace tapstudy::runner {
// What one store holds of the participants of a mode, excluded ones aside.
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
