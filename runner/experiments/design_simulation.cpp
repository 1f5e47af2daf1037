#include "runner/experiments/design_simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "analysis/statistics/quantiles.hpp"
#include "core/rng.hpp"
#include "results/store.hpp"
#include "runner/experiments/scratch_directory.hpp"
#include "runner/experiments/simulated_study.hpp"
#include "runner/experiments/study_summary.hpp"
#include "runner/terminal/stop_signal.hpp"
namespace tapstudy::runner {
namespace {
constexpr double alpha = 0.05;

struct Found {
  std::string block;
  std::string name;
  std::vector<analysis::MainResult> results;
};

ResultOfDesign result_of(const Found& found) {
  std::vector<double> estimates;
  std::vector<double> widths;
  ResultOfDesign result{
      .block = found.block, .name = found.name, .found = static_cast<int>(found.results.size())};
  for (const analysis::MainResult& one : found.results) {
    estimates.push_back(one.estimate);
    widths.push_back(one.range.high - one.range.low);
    result.tested += one.p ? 1 : 0;
    result.significant += one.p && *one.p < alpha ? 1 : 0;
  }
  const analysis::MeanAndSpread estimated = analysis::mean_and_spread(estimates);
  result.mean = estimated.mean;
  result.spread = estimated.standard_deviation;
  result.median_width = analysis::quantile(widths, 0.5);
  return result;
}

analysis::Summary summary_of_one(const SimulatedDesign& design, int study,
                                 const protocols::Protocol& protocol) {
  const std::uint64_t seed =
      core::derived_seed(design.seed, core::Purpose::study, static_cast<std::uint64_t>(study));
  const ScratchDirectory directory{seed};
  simulate({design.protocol_file, directory.path(), design.participants, seed, false,
            fmt::format("study {} of {}: ", study + 1, design.studies)},
           protocol);
  results::Store store = results::Store::open_existing(directory.path());
  return summary_of_study({{directory.path(), &store}}, results::Mode::simulated,
                          Detail::main_results);
}
}  // namespace

std::vector<ResultOfDesign> simulate_design(const SimulatedDesign& design,
                                            const protocols::Protocol& protocol) {
  std::vector<Found> all;
  for (int i = 0; i < design.studies; ++i) {
    stop_if_asked();
    for (const auto& block : summary_of_one(design, i, protocol).blocks) {
      for (const analysis::MainResult& result : block->main_results()) {
        auto known = std::ranges::find_if(all, [&](const Found& found) {
          return found.block == block->block && found.name == result.name;
        });
        known = known == all.end() ? all.insert(known, {block->block, result.name, {}}) : known;
        known->results.push_back(result);
      }
    }
  }
  std::vector<ResultOfDesign> results;
  std::ranges::transform(all, std::back_inserter(results), result_of);
  return results;
}
}  // namespace tapstudy::runner
