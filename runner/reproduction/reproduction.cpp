#include "runner/reproduction/reproduction.hpp"

#include <fmt/format.h>

#include <fstream>

#include "runner/build_info.hpp"
#include "runner/terminal/progress.hpp"
#include "runner/terminal/say.hpp"
#include "runner/terminal/stop_signal.hpp"
namespace tapstudy::runner {
namespace {
std::string processor_name() {
  std::ifstream file{"/proc/cpuinfo"};
  for (std::string line; std::getline(file, line);) {
    const auto colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) {
      return line.substr(colon + 2);
    }
  }
  return "an unknown processor";
}
}  // namespace

Reproduction reproduce(Bench& bench, const std::vector<std::string>& only) {
  const std::vector<ClaimGroup> groups = claim_groups_named(only);
  Reproduction all;
  all.seed = bench.seed;
  all.effort = bench.effort;
  all.only = only;
  all.program = fmt::format("tapstudy {} ({})", program_version(), git_hash());
  all.machine = processor_name();
  for (std::size_t i = 0; i < groups.size(); ++i) {
    stop_if_asked();
    say("{} of {}: {}\n", i + 1, groups.size(), groups[i].title);
    Progress progress{std::string{groups[i].title}};
    bench.progress = progress.hook();
    all.groups.push_back({std::string{groups[i].title}, groups[i].measure(bench)});
    bench.progress = {};
  }
  all.not_reproducible = not_reproducible();
  return all;
}
}  // namespace tapstudy::runner
