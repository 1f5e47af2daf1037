#pragma once
#include <optional>
#include <string>
#include <vector>

#include "analysis/report/document/block_summary.hpp"
#include "analysis/statistics/confusion_matrix.hpp"
namespace tapstudy::analysis {
// An answered trial; stimulus and response are places in the lists of the data.
struct IdentifiedTrial {
  std::size_t stimulus{};
  std::size_t response{};
  bool is_right{};
  std::size_t place{};                    // in the block's order, from 0
  int repetition{};                       // of the stimulus, from 1; 0: not known
  std::optional<double> response_time_s;  // from the start of the trial
  std::optional<double> time_from_first_contact_s;
  std::int64_t impacts{};
  std::optional<double> mean_impact_speed_m_s;
  double contact_s{};
};

struct IdentifyingParticipant {
  std::string id;
  Place place;
  std::vector<IdentifiedTrial> trials;  // as they followed one another
};

struct IdentificationData {
  std::vector<Item> stimuli;
  std::vector<Item> responses;
  std::vector<IdentifyingParticipant> participants;  // in the order of their first answers
};
// Throws InvalidInput if an answer does not fit the design.
IdentificationData identification_data(const BlockDesign& design,
                                       const std::vector<results::AnswerRow>& answers);

// Stimuli by responses.
CountTable counts_of(const IdentificationData& data, const IdentifyingParticipant& participant);

// A participant's counts; of a table whose participants are not known, all counts without an id.
struct ParticipantCounts {
  std::string id;
  CountTable counts;
};
std::vector<CountTable> tables_of(const std::vector<ParticipantCounts>& participants);

// The matrix with responses as both: each stimulus's counts in the row of the response that is
// right for it. Unset if a stimulus has none.
std::optional<CountTable> by_right_response(const std::vector<Item>& stimuli,
                                            const std::vector<Item>& responses,
                                            const CountTable& counts);
// Levels of a factor by levels answered, in the order of the stimuli; unset if a response has no
// level of it.
struct LevelCounts {
  std::vector<std::string> levels;
  CountTable counts;
};
std::optional<LevelCounts> by_level(const ConfusionMatrix& matrix, const std::string& factor);
}  // namespace tapstudy::analysis
