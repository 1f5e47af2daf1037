#pragma once
#include <cstdint>
#include <string>

#include "results/rows.hpp"
namespace tapstudy::runner {
enum class Sent : std::uint8_t { yes, no };

// Tells another program or instrument what the session does, at once.
class MarkerOutput {
 public:
  virtual ~MarkerOutput() = default;
  // Never waits: what cannot be sent now is lost.
  virtual Sent send(const results::SessionEventRow& change) = 0;
  // For messages.
  virtual std::string name() const = 0;
};
}  // namespace tapstudy::runner
