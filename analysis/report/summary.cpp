#include "analysis/report/summary.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <set>

#include "analysis/identification/identification_summary.hpp"
#include "analysis/report/statistic.hpp"
namespace tapstudy::analysis {
namespace {
using results::AnswerRow;
using results::VisitRow;

LoopQuality loop_quality(const std::vector<AnswerRow>& answers) {
  LoopQuality quality;
  for (const AnswerRow& answer : answers) {
    quality.ticks += answer.ticks;
    quality.late += answer.late;
    quality.skipped += answer.skipped;
    quality.dropped_samples += answer.dropped_samples;
  }
  return quality;
}
}  // namespace

Summary summarise(const StudyDesign& design, const std::vector<AnswerRow>& answers,
                  const std::vector<results::VisitRow>& visits) {
  Summary summary;
  summary.title = design.title;
  summary.notes = design.notes;
  std::set<std::string> modes;
  std::set<std::string> participants;
  for (const AnswerRow& answer : answers) {
    modes.insert(results::to_text(answer.mode));
    participants.insert(answer.participant_id);
  }
  summary.modes = fmt::format("{}", fmt::join(modes, ", "));
  summary.participants = static_cast<int>(participants.size());
  summary.loop = loop_quality(answers);
  for (const BlockDesign& block : design.blocks) {
    BlockRows rows;
    std::ranges::copy_if(answers, std::back_inserter(rows.answers),
                         [&](const AnswerRow& answer) { return answer.block == block.name; });
    std::ranges::copy_if(visits, std::back_inserter(rows.visits),
                         [&](const VisitRow& visit) { return visit.block == block.name; });
    summary.blocks.push_back(find_statistic(block.statistic).summarise(block, rows));
  }
  return summary;
}

Summary summarise(const ConfusionMatrix& matrix, const std::string& title) {
  Summary summary;
  summary.title = title;
  summary.modes = "counts";
  summary.blocks.push_back(std::make_shared<const IdentificationSummary>("", "", matrix));
  return summary;
}

bool is_simulated(const Summary& summary) {
  return summary.modes.find("simulated") != std::string::npos;
}

std::string methods(const Summary& summary) {
  if (summary.modes == "counts") {
    return "Computed from a table of counts; participants are not known, so intervals (Wilson "
           "1927) "
           "treat all answers as independent.";
  }
  std::string text = fmt::format("{} participants ({}). ", summary.participants, summary.modes);
  text +=
      "Intervals are 95 % score intervals (Wilson 1927); pooled over participants they treat "
      "answers "
      "as independent. Accuracy is tested by shuffling each participant's responses over that "
      "participant's own trials, choices by the exact binomial and multinomial distributions. ";
  if (summary.loop) {
    text += fmt::format(
        "The haptic loop made {} ticks; {} were late, {} were skipped, and {} force samples were "
        "lost.",
        summary.loop->ticks, summary.loop->late, summary.loop->skipped,
        summary.loop->dropped_samples);
  }
  return text;
}
}  // namespace tapstudy::analysis
