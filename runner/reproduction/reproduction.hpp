#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "runner/reproduction/claim_table.hpp"
namespace tapstudy::runner {
struct MeasuredGroup {
  std::string title;
  std::vector<Claim> claims;
};

struct Reproduction {
  std::uint64_t seed{};
  Effort effort{};
  std::string program;  // its version and commit
  std::string machine;  // processor and system, on which times were measured
  std::vector<MeasuredGroup> groups;
  std::vector<NotReproducible> not_reproducible;
};

// Measures every claim. A minute's progress is told in words; throws what a stop request throws.
Reproduction reproduce(Bench& bench);
}  // namespace tapstudy::runner
