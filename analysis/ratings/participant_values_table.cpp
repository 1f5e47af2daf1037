#include "analysis/ratings/participant_values_table.hpp"
namespace tapstudy::analysis {
ReportTable participant_values_table(const std::string& title, const Column& of,
                                     const std::vector<std::string>& participants,
                                     const std::vector<std::string>& stimuli,
                                     const RatingTable& values) {
  ReportTable table{"participants",
                    title,
                    {column("participant", "participant_id"), column("stimulus", "stimulus"), of}};
  table.is_for_programs = true;
  for (std::size_t person = 0; person < participants.size(); ++person) {
    for (std::size_t i = 0; i < stimuli.size(); ++i) {
      table.rows.push_back(
          {word(participants[person]), word(stimuli[i]), number(values[person][i])});
    }
  }
  return table;
}
}  // namespace tapstudy::analysis
