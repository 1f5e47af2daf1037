#include "runner/experiments/study_summary.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "analysis/report/block_contrasts.hpp"
#include "core/error.hpp"
#include "runner/experiments/procedure_words.hpp"
#include "runner/experiments/stored_protocol.hpp"
#include "runner/experiments/stored_results.hpp"
#include "runner/experiments/study_design.hpp"
#include "runner/experiments/study_sections.hpp"
namespace tapstudy::runner {
namespace {
using analysis::Summary;
using results::Mode;

std::vector<std::pair<std::string, std::string>> provenance(
    const results::StudyRow& study, const std::vector<results::SessionRow>& sessions) {
  std::set<std::string> programs;
  std::set<std::string> devices;
  std::vector<std::string> seeds;
  for (const results::SessionRow& session : sessions) {
    programs.insert(
        fmt::format("{} ({}, {})", session.program_version, session.git_hash, session.compiler));
    devices.insert(
        fmt::format("{}, {} Hz, {}", session.device, session.rate_hz, session.scheduler));
    seeds.push_back(fmt::format("{} {}", session.participant_id, session.seed));
  }
  return {{"protocol", study.protocol_file},
          {"protocol SHA-256", study.protocol_sha256},
          {"tapstudy", fmt::format("{}", fmt::join(programs, "; "))},
          {"device", fmt::format("{}", fmt::join(devices, "; "))},
          {"seeds", fmt::format("{}", fmt::join(seeds, ", "))}};
}

void check_same_protocol(const std::vector<StudyStore>& stores) {
  const results::StudyRow first = stores.front().store->study();
  for (const StudyStore& other : stores) {
    const results::StudyRow study = other.store->study();
    if (study.protocol_sha256 != first.protocol_sha256 || study.surfaces != first.surfaces) {
      throw core::InvalidInput{fmt::format(
          "{} and {} hold different protocols: their answers cannot be put into one report",
          stores.front().directory, other.directory)};
    }
  }
}

// Of whatever name: a redacted copy has the sessions of its study.
void check_different_participants(const std::vector<StudyStore>& stores) {
  std::map<std::string, std::string> directories;
  std::map<std::pair<std::uint64_t, std::string>, std::string> begun;
  for (const StudyStore& each : stores) {
    std::set<std::string> here;
    for (const results::SessionRow& session : each.store->sessions()) {
      here.insert(session.participant_id);
      const auto [other, is_new] =
          begun.try_emplace({session.seed, session.started_utc}, each.directory);
      if (!is_new && other->second != each.directory) {
        throw core::InvalidInput{
            fmt::format("{} and {} hold the same session, begun {} with the seed {}: is one a copy "
                        "of the other?",
                        other->second, each.directory, session.started_utc, session.seed)};
      }
    }
    for (const std::string& participant : here) {
      const auto [before, is_new] = directories.try_emplace(participant, each.directory);
      if (!is_new) {
        throw core::InvalidInput{fmt::format("participant {} is in {} and in {}", participant,
                                             before->second, each.directory)};
      }
    }
  }
}
}  // namespace

Summary summary_of_study(const std::vector<StudyStore>& stores, Mode mode, Detail detail) {
  check_same_protocol(stores);
  check_different_participants(stores);
  const results::StudyRow study = stores.front().store->study();
  const protocols::Protocol protocol = stored_protocol(study);
  StoredResults all;
  std::vector<std::string> directories;
  for (const StudyStore& each : stores) {
    append(all, stored_results(*each.store, protocol, mode, detail));
    directories.push_back(each.directory);
  }
  if (all.answers.empty()) {
    throw core::InvalidInput{fmt::format(
        "{}: no answers of {} participants to report{}", fmt::join(directories, ", "),
        results::to_text(mode),
        all.excluded.empty() ? "" : fmt::format(" ({} excluded)", all.excluded.size()))};
  }
  analysis::StudyDesign design = design_of(protocol, mode);
  if (detail == Detail::main_results) {
    for (analysis::BlockDesign& block : design.blocks) {
      block.is_for_main_results = true;
    }
    return analysis::summarise(design, all.answers, all.visits, all.presentations);
  }
  Summary summary = analysis::summarise(design, all.answers, all.visits, all.presentations);
  const DoneBlocks done = done_blocks(stores, mode);
  summary.sections = study_sections(protocol, stores, mode, done);
  const bool is_order_fixed = protocol.block_order.order == protocols::Order::listed;
  if (auto contrasts = analysis::block_contrasts(summary.blocks, is_order_fixed)) {
    summary.sections.insert(summary.sections.begin(), std::move(*contrasts));
  }
  summary.provenance = provenance(study, all.sessions);
  summary.procedure = procedure_words(protocol, all.sessions, summary.participant_ids, done);
  summary.unfinished = std::move(all.unfinished);
  summary.excluded = std::move(all.excluded);
  std::ranges::move(all.deviations, std::back_inserter(summary.deviations));
  return summary;
}
}  // namespace tapstudy::runner
