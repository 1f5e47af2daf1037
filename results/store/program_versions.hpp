#pragma once
#include <set>
#include <string>
namespace tapstudy::results {
// The versions of tapstudy that ran the sessions of the study in a directory; none where no study
// has begun there. Throws StoreError if study.db cannot be read.
std::set<std::string> program_versions_in(const std::string& directory);
}  // namespace tapstudy::results
