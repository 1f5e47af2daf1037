#pragma once
#include <optional>
#include <string>
#include <vector>

#include "analysis/identification/identification_data.hpp"
#include "analysis/statistics/permutation_test.hpp"
namespace tapstudy::analysis {
// Accuracy, and agreement in each factor, against chance by randomisation within participants.
struct ChanceTests {
  std::string test;  // how, or why not
  std::optional<PermutationResult> accuracy;
  std::vector<PermutationResult> factors;  // in the order given; empty where not tested
};
// So many draws; 0: as many as a report can afford, which it says.
struct ChanceDraws {
  int draws{};
  std::uint64_t seed{1};
};
// By the study's own orders, drawn again; beyond 20 000 answers by shuffling each participant's
// answers over the trials.
ChanceTests chance_tests(const BlockDesign& design, const IdentificationData& data,
                         const std::vector<std::string>& factors, const ChanceDraws& wanted = {});
}  // namespace tapstudy::analysis
