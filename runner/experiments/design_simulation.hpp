#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "protocols/protocol.hpp"
namespace tapstudy::runner {
struct SimulatedDesign {
  std::string protocol_file;
  int participants{};
  int studies{};
  std::uint64_t seed{};
};

// How one of a block's main results came out in many simulated studies.
struct ResultOfDesign {
  std::string block;
  std::string name;
  int found{};            // in so many of the studies
  double mean{};          // of the estimates
  double spread{};        // their standard deviation; NaN of a single one
  double median_width{};  // of the 95 % intervals over participants
  int tested{};
  int significant{};  // of these, p < .05
};

// Simulates whole studies, each with other participants, and makes the report of each. Nothing is
// kept on disk. Throws as simulate() and summary_of_study() do.
std::vector<ResultOfDesign> simulate_design(const SimulatedDesign& design,
                                            const protocols::Protocol& protocol);
}  // namespace tapstudy::runner
