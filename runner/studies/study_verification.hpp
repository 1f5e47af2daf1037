#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "results/store/recomputation.hpp"
#include "results/store/store.hpp"
namespace tapstudy::runner {
// What is wrong in a study's database and its journal, and between them.
struct Verification {
  std::int64_t trials{};
  std::int64_t answers{};  // in the database
  std::int64_t journalled_answers{};
  results::Recomputation recomputed;
  std::int64_t actuator_samples{};  // rendered again
  // Rows of the database that break a rule (row_rules.hpp), name what the protocol lacks
  // (stored_names.hpp) or are not of a session's course (stored_course.hpp).
  std::vector<std::string> broken;
  std::vector<std::string> study_and_sessions;  // that differ from the journal's
  // Lines of answers and of what the operator did, as often as the other has them less often.
  std::vector<std::string> not_in_journal;
  std::vector<std::string> not_in_database;
  std::string journal_fault;         // why the journal cannot be read; empty: it can
  std::vector<std::string> remarks;  // on what is no fault

  bool is_sound() const;
};
// Throws StoreError where the database cannot be read.
Verification verification_of(results::Store& store, const std::string& directory,
                             const core::CountHook& count = {});
}  // namespace tapstudy::runner
