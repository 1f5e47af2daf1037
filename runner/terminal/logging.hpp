#pragma once
#include <string>
namespace tapstudy::runner {
// Log lines go to stderr, results to stdout; never the other way round.
void set_up_logging();
void warn(const std::string& what);
}  // namespace tapstudy::runner
