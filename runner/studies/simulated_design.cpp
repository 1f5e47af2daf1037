#include "runner/studies/simulated_design.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>

#include "analysis/statistics/quantiles.hpp"
#include "analysis/statistics/resampling/replicates.hpp"
#include "core/files/scratch_directory.hpp"
#include "core/random/rng.hpp"
#include "results/store/store.hpp"
#include "runner/session/stimuli/model_library.hpp"
#include "runner/studies/simulated_study.hpp"
#include "runner/studies/study_summary.hpp"
#include "runner/terminal/logging.hpp"
#include "runner/terminal/process_exit.hpp"
namespace tapstudy::runner {
namespace {
analysis::Summary summary_of_one(const SimulatedDesign& design, int study,
                                 const protocols::Protocol& protocol, ModelLibrary& models) {
  const std::uint64_t seed =
      core::derived_seed(design.seed, core::Purpose::study, static_cast<std::uint64_t>(study));
  const core::ScratchDirectory directory;
  simulate({.protocol_file = design.protocol_file,
            .directory = directory.path(),
            .participants = design.participants,
            .seed = seed,
            .keeps_traces = false,
            .threads = 1},
           protocol, models);
  results::Store store = results::Store::open_existing(directory.path());
  return summary_of_study({{directory.path(), &store}}, results::Mode::simulated,
                          Detail::main_results);
}

ResultsOfStudy results_of(const analysis::Summary& summary) {
  ResultsOfStudy results;
  for (const auto& block : summary.blocks) {
    for (const analysis::MainResult& result : block->main_results) {
      const analysis::Interval range =
          result.range.value_or(analysis::Interval{result.estimate, result.estimate});
      results.push_back(
          {block->block, result.name, result.estimate, range.low, range.high, result.p});
    }
  }
  return results;
}

// One of a block's main results over many simulated studies.
struct ResultOfDesign {
  std::string block;
  std::string name;
  std::vector<double> estimates{};  // of the studies in which it was found
  std::vector<double> widths{};     // of the 95 % intervals over participants
  int tested{};
  int significant{};  // of these, p < .05
};

void add(const ResultOfStudy& found, ResultOfDesign& result) {
  constexpr double alpha = 0.05;
  result.estimates.push_back(found.estimate);
  result.widths.push_back(found.high - found.low);
  result.tested += found.p ? 1 : 0;
  result.significant += found.p && *found.p < alpha ? 1 : 0;
}

std::string describe(const ResultOfDesign& result, std::size_t studies) {
  const analysis::MeanAndSpread estimated = analysis::mean_and_spread(result.estimates);
  const std::size_t found = result.estimates.size();
  std::string line = fmt::format(
      "  {}: {} {:.3g}{}; median width of the 95 % intervals {:.2g}", result.block, result.name,
      estimated.mean,
      found > 1
          ? fmt::format(", standard deviation {:.2g} between studies", estimated.standard_deviation)
          : "",
      analysis::quantile(result.widths, 0.5));
  if (result.tested > 0) {
    line += fmt::format("; p < .05 in {} of {}", result.significant, result.tested);
  }
  if (found < studies) {
    line += fmt::format("; not found in {}", studies - found);
  }
  return line + "\n";
}
}  // namespace

std::vector<ResultsOfStudy> simulate_design(const SimulatedDesign& design,
                                            const protocols::Protocol& protocol) {
  const SharedOut part = part_of(design.share, design.studies, "studies");
  std::vector<ResultsOfStudy> results(static_cast<std::size_t>(part.end - part.first));
  Progress progress{
      fmt::format("simulating {} studies of {} participants", results.size(), design.participants)};
  ModelLibrary models;
  models.build_all(protocol);
  std::atomic<std::size_t> done{0};
  const core::CountHook count = progress.count();
  analysis::parallel_for(results.size(), 0, [&](std::size_t i) {
    stop_if_asked();
    results[i] =
        results_of(summary_of_one(design, part.first + static_cast<int>(i), protocol, models));
    count(++done, results.size());
  });
  return results;
}

std::string describe_design(int participants, const std::vector<ResultsOfStudy>& studies) {
  std::vector<ResultOfDesign> all;
  for (const ResultsOfStudy& study : studies) {
    for (const ResultOfStudy& found : study) {
      auto known = std::ranges::find_if(all, [&](const ResultOfDesign& result) {
        return result.block == found.block && result.name == found.name;
      });
      known = known == all.end() ? all.insert(known, {found.block, found.name}) : known;
      add(found, *known);
    }
  }
  std::string text =
      fmt::format("{} simulated studies of {} participants, with the parameters of `simulation`\n",
                  studies.size(), participants);
  for (const ResultOfDesign& result : all) {
    text += describe(result, studies.size());
  }
  return all.empty() ? text +
                           "  no simulated study had a result that is one number: no threshold "
                           "could be found, or what participants choose, prefer and rate follows "
                           "from the protocol's reference alone\n"
                     : text;
}
}  // namespace tapstudy::runner
