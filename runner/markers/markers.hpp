#pragma once
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "protocols/rig.hpp"
#include "runner/markers/marker_output.hpp"
namespace tapstudy::runner {
// All that a rig asks to be told of what the session does, from any thread. What is lost is
// counted; of each output that loses markers the operator is warned once, and told at the end how
// many they were.
class Markers {
 public:
  // Throws InvalidInput or DeviceError if one cannot be opened.
  explicit Markers(const protocols::MarkerSettings& settings);
  ~Markers();
  Markers(const Markers&) = delete;
  Markers& operator=(const Markers&) = delete;
  Markers(Markers&&) = delete;
  Markers& operator=(Markers&&) = delete;
  void send(const results::SessionEventRow& change);
  std::int64_t lost() const;

 private:
  struct Counted {
    std::unique_ptr<MarkerOutput> output;
    std::int64_t lost{0};
  };
  mutable std::mutex mutex_;
  std::vector<Counted> outputs_;
};
}  // namespace tapstudy::runner
