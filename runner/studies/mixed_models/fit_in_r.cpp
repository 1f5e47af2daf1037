#include "runner/studies/mixed_models/fit_in_r.hpp"

#include <fmt/format.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "core/files/output_files.hpp"
#include "core/files/scratch_directory.hpp"
#include "core/text/plain_text.hpp"
#include "results/export/csv_file.hpp"
#include "runner/studies/mixed_models/data.hpp"
namespace tapstudy::runner {
namespace {
namespace fs = std::filesystem;
using analysis::MixedModelRow;
constexpr const char* results_file = "mixed_models.csv";
constexpr const char* script_file = "mixed_models.R";

// The exit code; one thread, so that a report takes no more of a shared machine than it did.
int exit_code_of_r(const fs::path& directory) {
  const std::string where = core::shell_word(directory.string());
  const std::string line = fmt::format(
      "cd {} && OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 timeout -k 5 {} Rscript --vanilla {} "
      ">r.log 2>&1",
      where, most_seconds_of_r, script_file);
  const int status = std::system(line.c_str());  // NOLINT(cert-env33-c,concurrency-mt-unsafe)
  return status != -1 && WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string last_line_of(const fs::path& file) {
  std::ifstream stream{file};
  std::string last;
  for (std::string line; std::getline(stream, line);) {
    last = line.empty() ? last : line;
  }
  return last;
}

// What to say where not all was done.
std::string trouble_of(int exit_code, const fs::path& directory) {
  constexpr int timed_out = 124;  // of timeout
  constexpr int killed = 137;     // likewise, where R did not end
  constexpr int not_found = 127;
  switch (exit_code) {
    case 0:
      return "";
    case timed_out:
    case killed:
      return fmt::format(
          "R was stopped after {} s: what follows is not fitted (`export` writes mixed_models.R, "
          "which runs as long as it takes)",
          most_seconds_of_r);
    case not_found:
      return "not fitted: needs R (apt install r-base-core r-cran-lme4 r-cran-ordinal)";
    default:
      return "not fitted: R ended with: " + last_line_of(directory / "r.log");
  }
}

std::vector<MixedModelRow> rows_of(const fs::path& file) {
  std::ifstream stream{file};
  return stream ? analysis::read_mixed_models(stream, file.string()) : std::vector<MixedModelRow>{};
}
}  // namespace

std::string mixed_models_script() {
  return
#include "mixed_models_script.inc"
      ;
}

std::vector<MixedModelRow> fit_mixed_models_in_r(const results::Table& data) {
  const core::ScratchDirectory scratch;
  const fs::path directory = scratch.path();
  core::write_new_file(directory / (data.name + ".csv"),
                       [&](std::ostream& out) { results::write_csv(out, data); });
  core::write_new_file(directory / script_file, mixed_models_script());
  const std::string trouble = trouble_of(exit_code_of_r(directory), directory);
  std::vector<MixedModelRow> rows = rows_of(directory / results_file);
  if (!trouble.empty()) {
    rows.push_back({"", "", "", {}, {}, {}, {}, "", trouble});
  }
  return rows;
}

std::vector<MixedModelRow> mixed_models_of_report(const std::string& directory) {
  return rows_of(fs::path{directory} / results_file);
}
}  // namespace tapstudy::runner
