#include "runner/studies/shares/merge.hpp"

#include <fmt/format.h>

#include <memory>

#include "core/error.hpp"
#include "core/files/output_files.hpp"
#include "runner/commands/command_line.hpp"
#include "runner/studies/simulated_design.hpp"
namespace tapstudy::runner {
namespace {
struct MergeOptions {
  std::vector<std::string> directories;
  std::string out;
};

void merge_study(const std::vector<ShareDirectory>& shares, const std::string& out) {
  if (out.empty()) {
    throw core::InvalidInput{"merge of a simulated study needs --out"};
  }
  core::write_new_directory(
      out, [&](const std::string& unfinished) { write_whole(shares, unfinished); });
  fmt::print("{} simulated participants of {} shares\n{}/study.db\n",
             shares.front().file.of.participants, shares.size(), out);
}

void run_merge(const MergeOptions& options) {
  if (options.directories.empty()) {
    throw core::InvalidInput{"merge takes the directories of all shares of a simulation"};
  }
  const std::vector<ShareDirectory> shares = whole_of(options.directories);
  if (shares.front().file.of.studies == 0) {
    merge_study(shares, options.out);
    return;
  }
  if (!options.out.empty()) {
    throw core::InvalidInput{
        "--out: what `check --simulations` prints is all that its shares make together"};
  }
  fmt::print("{}", describe_design(shares.front().file.of.participants, results_of(shares)));
}
}  // namespace

void add_merge(CommandParser& line) {
  Command command = line.add(
      "merge", "Of all shares of a simulation (--share), what one run of the whole would give");
  const auto options = std::make_shared<MergeOptions>();
  command.arguments("directories", options->directories, "Directories of the shares, in any order");
  command.option("--out", options->out, "Directory of the study; nothing is overwritten");
  command.on_run([options] { run_merge(*options); });
}
}  // namespace tapstudy::runner
