#pragma once
#include <string>

#include "analysis/report/summary.hpp"
#include "results/store.hpp"
namespace tapstudy::runner {
// What a study says of its participants of one mode; those who were excluded, practice and catch
// trials are named, and left out of the results. directory: in messages. Throws InvalidInput if
// there is no answer.
analysis::Summary summary_of_study(results::Store& store, results::Mode mode,
                                   const std::string& directory);
}  // namespace tapstudy::runner
