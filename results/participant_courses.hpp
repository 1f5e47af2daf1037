#pragma once
#include <map>
#include <string>
#include <vector>

#include "results/store.hpp"
namespace tapstudy::results {
// How the sessions of each participant went; of all participants, sorted by mode and index. Throws
// StoreError.
std::vector<ParticipantCourseRow> participant_courses(Store& store);
// By block; those without an answer are not in it. Throws StoreError.
std::map<std::string, BlockCourseRow> block_courses(Store& store, Mode mode);
}  // namespace tapstudy::results
