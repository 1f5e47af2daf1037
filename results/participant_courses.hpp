#pragma once
#include <vector>

#include "results/store.hpp"
namespace tapstudy::results {
// How the sessions of each participant went; of all participants, sorted by mode and index. Throws
// StoreError.
std::vector<ParticipantCourseRow> participant_courses(Store& store);
}  // namespace tapstudy::results
