#include "results/journal_heads.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/sha256.hpp"
#include "results/journal_lines.hpp"
namespace tapstudy::results {
namespace {
// The keys of the first line whose values the other has not.
std::string differing_keys(const std::string& one, const std::string& other) {
  const nlohmann::ordered_json first = nlohmann::ordered_json::parse(one);
  const nlohmann::ordered_json second = nlohmann::ordered_json::parse(other);
  std::vector<std::string> keys;
  for (const auto& [key, value] : first.items()) {
    if (!second.contains(key) || second.at(key) != value) {
      keys.push_back(key);
    }
  }
  return fmt::format("{}", fmt::join(keys, ", "));
}

}  // namespace

std::vector<std::string> differing_study_and_sessions(const StudyRow& study,
                                                      const std::vector<SessionRow>& sessions,
                                                      const JournalContent& journal) {
  std::vector<std::string> differences;
  if (core::sha256(study.protocol_text) != study.protocol_sha256) {
    differences.emplace_back("study: protocol_sha256 is not that of protocol_text");
  }
  if (const auto keys = differing_keys(to_line(study), to_line(journal.study)); !keys.empty()) {
    differences.push_back(fmt::format("study: {} not as in answers.journal", keys));
  }
  for (const SessionRow& journalled : journal.sessions) {
    const auto stored = std::ranges::find(sessions, journalled.id, &SessionRow::id);
    if (stored == sessions.end()) {
      differences.push_back(fmt::format("session {}: missing in study.db", journalled.id));
    } else if (const auto keys = differing_keys(to_line(*stored), to_line(journalled));
               !keys.empty()) {
      differences.push_back(fmt::format("session {} (participant {}): {} not as in answers.journal",
                                        journalled.id, journalled.participant_id, keys));
    }
  }
  return differences;
}
}  // namespace tapstudy::results
