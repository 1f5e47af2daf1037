#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "protocols/protocol.hpp"
#include "runner/studies/shares/share_file.hpp"
namespace tapstudy::runner {
struct SimulatedDesign {
  std::string protocol_file;
  int participants{};
  int studies{};
  std::uint64_t seed{};
  Share share{};  // of the studies
};

// Simulates whole studies, each with other participants, and makes the report of each; as many at
// once as there are processors. Nothing is kept on disk. The main results of those that are in the
// share, in order. Throws as simulate() and summary_of_study() do, and as part_of().
std::vector<ResultsOfStudy> simulate_design(const SimulatedDesign& design,
                                            const protocols::Protocol& protocol);

// The main results over all studies of a design: their spread, how often they are significant. As
// `check --simulations` and `merge` print them.
std::string describe_design(int participants, const std::vector<ResultsOfStudy>& studies);
}  // namespace tapstudy::runner
