#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/report/document/block_summary.hpp"
#include "analysis/statistics/scaling/power_law.hpp"
namespace tapstudy::analysis {
// Numbers that participants gave for the magnitude of one presented stimulus a trial, the last of
// its alternatives: one before it is the modulus, whose number they were told.
struct MagnitudeOfValue {
  std::optional<double> value;  // on the block's axis; unset where the stimulus has none
  double geometric_mean{};  // of participants' geometric means, who judged all values if any did
  int participants{};
  int estimates{};
};

struct StimulusMagnitudes {
  std::string stimulus;
  std::vector<MagnitudeOfValue> values;  // from low to high
  std::vector<std::string>
      participants;                     // by name, who judged all values: theirs are the exponents
  std::vector<std::string> incomplete;  // by name, who did not
  std::optional<PowerLaw> power_law;
  std::string no_power_law;  // why there is none; empty: there is
};

// Of each stimulus that was presented, by name. Throws InvalidInput for answers that are not
// numbers above 0.
std::vector<StimulusMagnitudes> magnitude_results(const BlockDesign& design,
                                                  const std::vector<results::AnswerRow>& answers);

// Magnitude estimation: geometric means of each stimulus and value, and where the values vary along
// design.axis the exponent of Stevens' power law. Throws InvalidInput as magnitude_results does.
std::shared_ptr<BlockSummary> summarise_magnitudes(const BlockDesign& design,
                                                   const BlockRows& rows);
}  // namespace tapstudy::analysis
