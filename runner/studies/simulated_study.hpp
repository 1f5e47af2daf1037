#pragma once
#include <cstdint>
#include <string>

#include "protocols/protocol.hpp"
#include "runner/session/stimuli/model_library.hpp"
#include "runner/studies/shares/share.hpp"
namespace tapstudy::runner {
struct SimulatedStudy {
  std::string protocol_file;
  std::string directory;
  int participants{};
  std::uint64_t seed{};
  bool keeps_traces{true};  // otherwise events and answers only
  std::string progress{};   // what to say of it on the terminal; empty: nothing
  unsigned threads{};       // 0: as many as keep all processors busy
  Share share{};            // of the participants
  std::string rig_file{};   // of the simulated hand; empty: 10 N, without an actuator
};
struct SimulatedTime {
  int trials{};
  double tapped_s{};  // of virtual time
  double wall_s{};    // real time
};

// Runs the whole study with participants sim-01, sim-02 …, on all cores, faster than real time. The
// same seed gives the same data: bitwise identical with one build on one machine, elsewhere the
// same answers and forces to within 1e-9. Of a share only its participants, who are as they are in
// the whole. Throws as TrialEngine::run, Store and part_of do, and InvalidInput if the study has
// simulated participants already.
SimulatedTime simulate(const SimulatedStudy& study, const protocols::Protocol& protocol);
// With the models of studies before, of the same protocol.
SimulatedTime simulate(const SimulatedStudy& study, const protocols::Protocol& protocol,
                       ModelLibrary& models);
}  // namespace tapstudy::runner
