#pragma once
#include <cstdint>
#include <string>

#include "protocols/protocol.hpp"
namespace tapstudy::runner {
struct SimulatedStudy {
  std::string protocol_file;
  std::string directory;
  int participants{};
  std::uint64_t seed{};
};
struct SimulatedTime {
  int trials{};
  double tapped_s{};  // of virtual time
  double wall_s{};    // of ours
};

// The whole study with participants sim-01, sim-02 …, on all cores, faster than real time. The same
// seed gives the same data: to the last bit with one build on one machine, the same answers and
// forces to 1e-9 elsewhere. Throws as TrialEngine::run and Store do, and InvalidInput if one of the
// participants is in the study already.
SimulatedTime simulate(const SimulatedStudy& study, const protocols::Protocol& protocol);
}  // namespace tapstudy::runner
