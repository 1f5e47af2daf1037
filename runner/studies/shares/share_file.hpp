#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "protocols/protocol.hpp"
#include "runner/studies/shares/share.hpp"
namespace tapstudy::runner {
// One of a block's main results in one simulated study.
struct ResultOfStudy {
  std::string block;
  std::string name;
  double estimate{};
  double low{};  // of the 95 % interval over participants
  double high{};
  std::optional<double> p{};  // unset: nothing was tested
};
using ResultsOfStudy = std::vector<ResultOfStudy>;

// All by which the shares of one simulation are known. Two of one simulation differ in `share`.
struct SharedSimulation {
  Share share;
  int participants{};
  int studies{};  // 0: it is one study, in a store of its own
  std::uint64_t seed{};
  bool keeps_traces{};
  std::string inputs;   // hashes of the protocol and of the files that it names
  std::string program;  // version, commit and compiler
};
SharedSimulation shared_simulation(const Share& share, const protocols::Protocol& protocol);

// DIR/share.json: which share the directory holds, and of simulated studies the main results, one
// list a study. Written when the share is complete, and by nobody later.
struct ShareFile {
  SharedSimulation of;
  std::vector<ResultsOfStudy> results{};
};
// Unset: the directory is no share. Throws InvalidInput if its file cannot be read.
std::optional<ShareFile> share_in(const std::string& directory);

// What one of the two says otherwise of the simulation than the other, "their seeds differ (1 and
// 2)"; empty: they are shares of one.
std::string difference_between(const SharedSimulation& one, const SharedSimulation& other);

// Makes the directory of a share all at once: of a program that was killed there is none, and the
// share is run again. `compute` fills the directory that it is given. A share that is complete is
// left as it is, which is said. Throws InvalidInput if there is anything else of that name.
using ComputeShare = std::function<std::vector<ResultsOfStudy>(const std::string& unfinished)>;
void write_complete_share(const std::string& directory, const SharedSimulation& share,
                          const ComputeShare& compute);
}  // namespace tapstudy::runner
