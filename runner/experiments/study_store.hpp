#pragma once
#include <string>

#include "results/store.hpp"
namespace tapstudy::runner {
// A store of a study: of one rig, where there were several.
struct StudyStore {
  std::string directory;  // in messages
  results::Store* store;
};
}  // namespace tapstudy::runner
