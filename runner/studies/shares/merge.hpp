#pragma once
#include <string>
#include <vector>

#include "runner/studies/shares/share_file.hpp"
namespace tapstudy::runner {
struct ShareDirectory {
  std::string directory;
  ShareFile file;
};
// The shares in these directories, from the first to the last. Throws InvalidInput if one holds
// none, they are not of one simulation, one is missing or there twice, or a store holds other
// participants than its share.
std::vector<ShareDirectory> whole_of(const std::vector<std::string>& directories);

// Whether all of these directories are shares; some that are, beside others that are not, are none.
bool are_shares(const std::vector<std::string>& directories);

// Writes the study that one run would have stored into an empty directory.
void write_whole(const std::vector<ShareDirectory>& shares, const std::string& directory);
// The main results of all studies of a simulated design, in order.
std::vector<ResultsOfStudy> results_of(const std::vector<ShareDirectory>& shares);
}  // namespace tapstudy::runner
