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
  bool keeps_traces{true};   // otherwise events and answers only
  std::string of_studies{};  // which of how many, for progress; empty: the only one
};
struct SimulatedTime {
  int trials{};
  double tapped_s{};  // of virtual time
  double wall_s{};    // real time
};

// Runs the whole study with participants sim-01, sim-02 …, on all cores, faster than real time. The
// same seed gives the same data: bitwise identical with one build on one machine, elsewhere the
// same answers and forces to within 1e-9. Throws as TrialEngine::run and Store do, and InvalidInput
// if one of the participants is already in the study.
SimulatedTime simulate(const SimulatedStudy& study, const protocols::Protocol& protocol);
}  // namespace tapstudy::runner
