#pragma once
#include <string>
#include <vector>

#include "results/journal.hpp"
namespace tapstudy::results {
// What a database holds of its study and its sessions (the protocol and its hash, modes, seeds,
// orders, devices …) otherwise than the journal does, a line each; answers apart.
std::vector<std::string> differing_study_and_sessions(const StudyRow& study,
                                                      const std::vector<SessionRow>& sessions,
                                                      const JournalContent& journal);
}  // namespace tapstudy::results
