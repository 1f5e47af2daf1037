#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "protocols/protocol.hpp"
#include "runner/session/stimuli/model_library.hpp"
namespace tapstudy::runner {
struct SimulatedStudy {
  std::string protocol_file;
  std::string directory;
  int participants{};
  std::uint64_t seed{};
  bool keeps_traces{true};  // otherwise events and answers only
  std::string progress{};   // what to say of it on the terminal; empty: nothing
  unsigned threads{};       // 0: as many as keep all processors busy
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
// With the models of studies before, of the same protocol.
SimulatedTime simulate(const SimulatedStudy& study, const protocols::Protocol& protocol,
                       ModelLibrary& models);

struct SimulatedDesign {
  std::string protocol_file;
  int participants{};
  int studies{};
  std::uint64_t seed{};
};

// One of a block's main results over many simulated studies.
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

// Simulates whole studies, each with other participants, and makes the report of each; as many at
// once as there are processors. Nothing is kept on disk. Throws as simulate() and
// summary_of_study() do.
std::vector<ResultOfDesign> simulate_design(const SimulatedDesign& design,
                                            const protocols::Protocol& protocol);
}  // namespace tapstudy::runner
