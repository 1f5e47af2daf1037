#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "protocols/protocol.hpp"
#include "results/journal.hpp"
namespace tapstudy::runner {
// How well a participant has answered the practice blocks that have a criterion.
class PracticeRecord {
 public:
  PracticeRecord() = default;
  // Of earlier sessions: the participant's answers to whatever blocks, as they were given: a
  // correction changes what is known, but not how well was practised.
  explicit PracticeRecord(const std::vector<results::JournalledAnswer>& answers);
  void add(const std::string& block, bool is_correct) { answers_[block].push_back(is_correct); }
  // Whether the block's criterion was met at any time; false if it has none.
  bool is_met(const protocols::Block& block) const;
  // "7 of the last 8 right".
  std::string latest(const protocols::Block& block) const;

 private:
  std::map<std::string, std::vector<bool>> answers_;  // in the order given
};
}  // namespace tapstudy::runner
