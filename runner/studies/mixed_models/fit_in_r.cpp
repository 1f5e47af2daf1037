#include "runner/studies/mixed_models/fit_in_r.hpp"

#include <fmt/format.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "core/error.hpp"
#include "core/files/output_files.hpp"
#include "results/export/csv_file.hpp"
#include "runner/studies/mixed_models/data.hpp"
namespace tapstudy::runner {
namespace {
namespace fs = std::filesystem;
using analysis::MixedModelRow;
constexpr const char* results_file = "mixed_models.csv";
constexpr const char* script_file = "mixed_models.R";

// Of the temporary files; removed with all that is in it.
class ScratchDirectory {
 public:
  ScratchDirectory() {
    std::error_code error;
    std::string name = (fs::temp_directory_path(error) / "tapstudy-models-XXXXXX").string();
    if (error || mkdtemp(name.data()) == nullptr) {
      throw core::InvalidInput{name + ": cannot be made (mixed models are fitted there)"};
    }
    path_ = name;
  }
  ~ScratchDirectory() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  ScratchDirectory(const ScratchDirectory&) = delete;
  ScratchDirectory& operator=(const ScratchDirectory&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

// Within single quotes a shell takes every other character as it is.
std::string shell_quoted(const std::string& text) {
  std::string quoted{"'"};
  for (const char c : text) {
    quoted += c == '\'' ? std::string{"'\\''"} : std::string{c};
  }
  return quoted + "'";
}

// The exit code; one thread, so that a report takes no more of a shared machine than it did.
int exit_code_of_r(const fs::path& directory) {
  const std::string where = shell_quoted(directory.string());
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
  const ScratchDirectory scratch;
  core::write_new_file(scratch.path() / (data.name + ".csv"),
                       [&](std::ostream& out) { results::write_csv(out, data); });
  core::write_new_file(scratch.path() / script_file, mixed_models_script());
  const std::string trouble = trouble_of(exit_code_of_r(scratch.path()), scratch.path());
  std::vector<MixedModelRow> rows = rows_of(scratch.path() / results_file);
  if (!trouble.empty()) {
    rows.push_back({"", "", "", {}, {}, {}, {}, "", trouble});
  }
  return rows;
}

std::vector<MixedModelRow> mixed_models_of_report(const std::string& directory) {
  return rows_of(fs::path{directory} / results_file);
}
}  // namespace tapstudy::runner
