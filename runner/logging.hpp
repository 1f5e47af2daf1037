#pragma once
namespace tapstudy::runner {
// Log lines go to stderr, results to stdout; never the other way round.
void set_up_logging();
}  // namespace tapstudy::runner
