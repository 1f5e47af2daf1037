#include "analysis/report/summary.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>

#include "analysis/report/answer_tables/answer_table.hpp"
#include "analysis/report/confusion/confusion_summary.hpp"
#include "analysis/report/document/block_summary.hpp"
#include "analysis/report/statistic.hpp"
#include "analysis/report/study/planned_comparisons.hpp"
#include "analysis/statistics/rank_tests.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
using results::AnswerRow;
using results::Mode;
using results::VisitRow;

// Adjusts the probabilities of all declared hypotheses for their number, if there are several.
void adjust(const std::vector<std::shared_ptr<BlockSummary>>& blocks) {
  std::vector<HypothesisResult*> tested;
  std::vector<double> p;
  for (const auto& block : blocks) {
    for (HypothesisResult& result : block->hypotheses) {
      if (result.p) {
        tested.push_back(&result);
        p.push_back(*result.p);
      }
    }
  }
  const std::vector<double> adjusted = holm_adjusted(p);
  for (std::size_t i = 0; i < tested.size() && tested.size() > 1; ++i) {
    tested[i]->p_holm = adjusted[i];
  }
}

LoopQuality loop_quality(const std::vector<AnswerRow>& answers) {
  LoopQuality quality;
  for (const AnswerRow& answer : answers) {
    quality.ticks += answer.ticks;
    quality.late += answer.late;
    quality.skipped += answer.skipped;
    quality.dropped_samples += answer.dropped_samples;
    quality.impacts += answer.impacts;
    quality.late_impacts += answer.late_impacts;
  }
  return quality;
}
std::string left_out(const BlockDesign& block) {
  std::string words = fmt::format("block '{}' is left out: it has no answer", block.name);
  for (const PlannedHypothesis& planned : block.hypotheses) {
    words += fmt::format("; hypothesis '{}' is not tested", planned.name);
  }
  for (const PlannedComparison& planned : block.comparisons) {
    words += fmt::format("; hypothesis '{}' is not tested", planned.hypothesis.name);
  }
  return words;
}
}  // namespace

Summary summarise(const StudyDesign& design, const std::vector<AnswerRow>& answers,
                  const std::vector<results::VisitRow>& visits,
                  const Presentations& presentations) {
  Summary summary;
  summary.title = design.title;
  summary.notes = design.notes;
  for (const AnswerRow& answer : answers) {
    summary.modes.insert(results::to_text(answer.mode));
    summary.participant_ids.insert(answer.participant_id);
  }
  summary.participants = static_cast<int>(summary.participant_ids.size());
  summary.loop = loop_quality(answers);
  std::vector<std::shared_ptr<BlockSummary>> blocks;
  std::map<std::string, std::vector<AnswerRow>> compared;  // answers, by block
  for (std::size_t i = 0; i < design.blocks.size(); ++i) {
    const BlockDesign& block = design.blocks[i];
    core::tell_count(design.count, i, design.blocks.size());
    BlockRows rows;
    std::ranges::copy_if(answers, std::back_inserter(rows.answers),
                         [&](const AnswerRow& answer) { return answer.block == block.name; });
    std::ranges::copy_if(visits, std::back_inserter(rows.visits),
                         [&](const VisitRow& visit) { return visit.block == block.name; });
    if (rows.answers.empty()) {
      summary.deviations.push_back(left_out(block));
      continue;
    }
    rows.orders = orders_of(presentations.orders, rows.answers);
    const auto missing = presentations.missing_replies.find(block.name);
    rows.missing_replies = missing == presentations.missing_replies.end() ? 0 : missing->second;
    for (const BlockPart& part : parts_at_further_values(block, rows)) {
      blocks.push_back(find_statistic(block.statistic).summarise(part.design, part.rows));
    }
    if (!block.comparisons.empty()) {
      compared.emplace(block.name, std::move(rows.answers));
    }
  }
  add_planned_comparisons(design, compared, blocks);
  adjust(blocks);
  summary.blocks.assign(blocks.begin(), blocks.end());
  return summary;
}

Summary summarise(const ConfusionMatrix& matrix, const std::string& title, std::string_view task,
                  const std::set<std::string>& modes) {
  Summary summary;
  summary.title = title;
  summary.modes = modes;
  summary.modes.insert("counts");
  BlockDesign nameless;
  nameless.task = task;
  summary.blocks.push_back(std::make_shared<const IdentificationSummary>(nameless, matrix));
  return summary;
}

Summary summarise(const AnswerTable& table, const std::string& title, std::string_view task,
                  const std::set<std::string>& modes) {
  if (!table.are_participants_known) {
    ConfusionMatrix matrix{table.stimuli, table.responses};
    for (const AnswerRow& answer : table.answers) {
      matrix.add(answer.stimulus, answer.response);
    }
    return summarise(matrix, title, task, modes);
  }
  BlockDesign design;
  design.task = task;
  design.stimuli = table.stimuli;
  design.responses = table.responses;
  design.is_order_known = false;
  Summary summary;
  summary.title = title;
  summary.modes = modes;
  summary.modes.insert("answers");
  summary.participant_ids = distinct(table.answers, &AnswerRow::participant_id);
  summary.participants = static_cast<int>(summary.participant_ids.size());
  summary.blocks.push_back(std::make_shared<const IdentificationSummary>(
      design, identification_data(design, table.answers)));
  return summary;
}

namespace {
// Of all blocks, each once.
std::vector<std::string> tests_of(const Summary& summary) {
  std::vector<std::string> sentences;
  for (const auto& block : summary.blocks) {
    const std::string sentence = block->methods;
    if (!sentence.empty() && std::ranges::find(sentences, sentence) == sentences.end()) {
      sentences.push_back(sentence);
    }
  }
  return sentences;
}
}  // namespace

std::string words_of_modes(const Summary& summary) {
  return fmt::format("{}", fmt::join(summary.modes, ", "));
}

std::string banner(const Summary& summary) {
  const auto has = [&](Mode mode) { return summary.modes.contains(results::to_text(mode)); };
  if (has(Mode::simulated) && (has(Mode::real) || has(Mode::pilot))) {
    return "Some participants are SIMULATED: in part of these data no person took part.";
  }
  if (has(Mode::simulated)) {
    return "SIMULATED participants: no person took part. These data show what the physics and the "
           "assumed observer give.";
  }
  if (has(Mode::pilot)) {
    return "PILOT sessions: rehearsals, not the study.";
  }
  return "";
}

CitingText methods(const Summary& summary) {
  if (!summary.stated_methods.empty()) {
    return summary.stated_methods;
  }
  if (!summary.loop && summary.participants == 0) {
    return "Computed from a table of counts; participants are not known, so intervals and "
           "probabilities treat all answers as independent.";
  }
  CitingText text = fmt::format("{} participant{} ({}). ", summary.participants,
                                summary.participants == 1 ? "" : "s", words_of_modes(summary));
  text += summary.procedure;
  text += core::citing(
      "Intervals of proportions are 95 % score intervals ({}) where nothing else is said; those "
      "over participants hold for participants of whom these are a sample. ",
      "Wilson 1927"_source);
  for (const std::string& sentence : tests_of(summary)) {
    text += sentence + " ";
  }
  text += "Other statistics state their methods with their results. ";
  if (summary.loop && summary.modes != std::set<std::string>{results::to_text(Mode::simulated)}) {
    text += fmt::format(
        "The haptic loop made {} ticks; {} were late, {} were skipped, and {} force samples were "
        "lost. {} of {} impacts came up to 5 ms after a late tick.",
        summary.loop->ticks, summary.loop->late, summary.loop->skipped,
        summary.loop->dropped_samples, summary.loop->late_impacts, summary.loop->impacts);
  }
  return text;
}

namespace {
// By how they are adjusted for their number.
struct TestCounts {
  std::size_t declared{};
  std::size_t of_pairs{};  // adjusted within their table
  std::size_t others{};
};

// Tables have a column of p, and one beside it where these are adjusted.
void count_tests(const ReportTable& table, TestCounts& counts) {
  const auto has = [](const Column& column, const char* key) {
    return std::ranges::find(column.keys, key) != column.keys.end();
  };
  const bool are_adjusted = std::ranges::any_of(
      table.columns, [&](const Column& column) { return has(column, "p_holm"); });
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const auto& keys = table.columns[i].keys;
    const auto place = static_cast<std::size_t>(std::ranges::find(keys, "p") - keys.begin());
    for (const std::vector<Cell>& row : table.rows) {
      if (place < keys.size() && std::holds_alternative<double>(row[i].values.at(place))) {
        ++(are_adjusted ? counts.of_pairs : counts.others);
      }
    }
  }
}

TestCounts tests_in(const Summary& summary) {
  TestCounts counts;
  for (const auto& block : summary.blocks) {
    counts.declared += static_cast<std::size_t>(std::ranges::count_if(
        block->hypotheses, [](const HypothesisResult& result) { return result.p.has_value(); }));
    for (const ReportSection& section : block->sections) {
      std::ranges::for_each(section.tables,
                            [&](const ReportTable& table) { count_tests(table, counts); });
    }
  }
  for (const ReportSection& section : summary.sections) {
    std::ranges::for_each(section.tables,
                          [&](const ReportTable& table) { count_tests(table, counts); });
  }
  return counts;
}
}  // namespace

std::string tests_in_words(const Summary& summary) {
  const TestCounts counts = tests_in(summary);
  std::vector<std::string> parts;
  if (counts.declared > 0) {
    parts.push_back(fmt::format("{} of declared hypotheses{}", counts.declared,
                                counts.declared > 1 ? ", adjusted for one another" : ""));
  }
  if (counts.of_pairs > 0) {
    parts.push_back(fmt::format("{} adjusted within their table", counts.of_pairs));
  }
  if (counts.others > 0) {
    constexpr double alpha = 0.05;
    parts.push_back(
        fmt::format("{} neither declared nor adjusted (if nothing were true, about {} "
                    "of them would be below .05)",
                    counts.others, rounded(alpha * static_cast<double>(counts.others), 2)));
  }
  const std::size_t all = counts.declared + counts.of_pairs + counts.others;
  return all == 0 ? ""
                  : fmt::format("This report holds {} test{}: {}.", all, all == 1 ? "" : "s",
                                fmt::join(parts, "; "));
}

namespace {
std::vector<std::string> names_in(const Summary& summary) {
  std::vector<std::string> names;
  for (const auto& block : summary.blocks) {
    names.push_back(block->block);
    if (std::ranges::find(names, block->part_of) == names.end()) {
      names.push_back(block->part_of);
    }
  }
  for (const ReportSection& section : summary.sections) {
    names.push_back(section.name);
  }
  std::erase(names, "");
  return names;
}
}  // namespace

void check_are_parts(const std::vector<std::string>& names, const std::vector<std::string>& parts) {
  for (const std::string& name : names) {
    if (std::ranges::find(parts, name) == parts.end()) {
      throw core::InvalidInput{fmt::format("--only {}: is not part of this report (one of: {})",
                                           name, fmt::join(parts, ", "))};
    }
  }
}

void keep_only(Summary& summary, const std::vector<std::string>& names) {
  check_are_parts(names, names_in(summary));
  const auto is_left_out = [&](const std::string& name) {
    return std::ranges::find(names, name) == names.end();
  };
  std::erase_if(summary.blocks, [&](const auto& block) {
    return is_left_out(block->block) && (block->part_of.empty() || is_left_out(block->part_of));
  });
  std::erase_if(summary.sections, [&](const auto& part) { return is_left_out(part.name); });
}
}  // namespace tapstudy::analysis
