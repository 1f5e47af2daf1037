#include "runner/experiments/design_simulation.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <utility>

#include "core/rng.hpp"
#include "results/store.hpp"
#include "runner/experiments/simulated_study.hpp"
#include "runner/experiments/study_summary.hpp"
#include "runner/terminal/stop_signal.hpp"
namespace tapstudy::runner {
namespace {
namespace fs = std::filesystem;
constexpr double alpha = 0.05;

// RAII: removed with all it holds.
class ScratchDirectory {
 public:
  explicit ScratchDirectory(std::uint64_t seed)
      : path_{fs::temp_directory_path() / fmt::format("tapstudy-{}-{:x}", ::getpid(), seed)} {}
  ~ScratchDirectory() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  ScratchDirectory(const ScratchDirectory&) = delete;
  ScratchDirectory& operator=(const ScratchDirectory&) = delete;
  ScratchDirectory(ScratchDirectory&&) = delete;
  ScratchDirectory& operator=(ScratchDirectory&&) = delete;
  std::string path() const { return path_.string(); }

 private:
  fs::path path_;
};

struct Sums {
  ResultOfDesign result;
  double squares{};
};

// Running mean and sum of squared deviations (Welford 1962).
void add(const analysis::MainResult& found, Sums& sums) {
  ResultOfDesign& result = sums.result;
  ++result.found;
  const double deviation = found.estimate - result.mean;
  result.mean += deviation / result.found;
  sums.squares += deviation * (found.estimate - result.mean);
  result.width += (found.range.high - found.range.low - result.width) / result.found;
  result.tested += found.p ? 1 : 0;
  result.significant += found.p && *found.p < alpha ? 1 : 0;
}

analysis::Summary summary_of_one(const SimulatedDesign& design, int study,
                                 const protocols::Protocol& protocol) {
  const std::uint64_t seed =
      core::derived_seed(design.seed, core::Purpose::study, static_cast<std::uint64_t>(study));
  const ScratchDirectory directory{seed};
  simulate({design.protocol_file, directory.path(), design.participants, seed,
            fmt::format("study {} of {}: ", study + 1, design.studies)},
           protocol);
  results::Store store = results::Store::open_existing(directory.path());
  return summary_of_study(store, results::Mode::simulated, directory.path());
}
}  // namespace

std::vector<ResultOfDesign> simulate_design(const SimulatedDesign& design,
                                            const protocols::Protocol& protocol) {
  std::map<std::pair<std::string, std::string>, std::size_t> places;
  std::vector<Sums> all;
  for (int i = 0; i < design.studies; ++i) {
    stop_if_asked();
    for (const auto& block : summary_of_one(design, i, protocol).blocks) {
      for (const analysis::MainResult& found : block->main_results()) {
        const auto [place, is_new] = places.try_emplace({block->block, found.name}, all.size());
        if (is_new) {
          all.push_back({{.block = block->block, .name = found.name}});
        }
        add(found, all[place->second]);
      }
    }
  }
  std::vector<ResultOfDesign> results;
  for (Sums& sums : all) {
    if (sums.result.found > 1) {
      sums.result.spread = std::sqrt(sums.squares / (sums.result.found - 1));
    }
    results.push_back(sums.result);
  }
  return results;
}
}  // namespace tapstudy::runner
