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
  std::vector<std::string> only;  // groups by name; empty: all
  std::string program;            // its version and commit
  std::string machine;            // processor and system, on which times were measured
  std::vector<MeasuredGroup> groups;
  std::vector<NotReproducible> not_reproducible;
};

// Measures the claims of these groups, or of all. Progress is told in words. Throws InvalidInput
// for a name that is of no group, and Stopped if a stop was requested.
Reproduction reproduce(Bench& bench, const std::vector<std::string>& only = {});
}  // namespace tapstudy::runner
