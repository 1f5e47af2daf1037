#pragma once
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "core/files/sha256.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
namespace tapstudy::testing {
// A vector of R's.
template <typename Values>
std::string r_vector(const Values& values) {
  return fmt::format("c({})", fmt::join(values, ","));
}

// The exact signed rank test of differences, those of 0 left out, as R's coin has it.
inline const std::string exact_signed_rank_p =
    "suppressPackageStartupMessages(library(coin)); exact_signed_rank_p <- function(d) "
    "as.numeric(pvalue(wilcoxsign_test(d ~ rep(0, length(d)), zero.method = 'Wilcoxon', "
    "distribution = exact())))\n";

// What a script prints. Where TAPSTUDY_REFERENCE_CACHE names a directory, a script that has run is
// not run again: the same tests built by another compiler ask the same of R and SciPy.
inline std::string printed_by_script(std::vector<std::string> interpreter,
                                     const std::string& script) {
  const char* cache = std::getenv("TAPSTUDY_REFERENCE_CACHE");
  const std::filesystem::path kept =
      cache == nullptr ? "" : std::filesystem::path{cache} / core::sha256(interpreter[0] + script);
  if (cache != nullptr && std::filesystem::exists(kept)) {
    return contents(kept);
  }
  interpreter.push_back(script);
  const ProgramResult run = run_program(interpreter);
  INFO(run.standard_error);
  REQUIRE(run.exit_code == 0);
  if (cache != nullptr) {  // whole or not at all, whoever else writes it
    const std::string written = fmt::format("{}.{}", kept.string(), getpid());
    write(written, run.standard_output);
    std::filesystem::rename(written, kept);
  }
  return run.standard_output;
}

inline std::vector<double> numbers_in_lines(const std::string& text) {
  std::istringstream lines{text};
  std::vector<double> numbers;
  for (std::string line; std::getline(lines, line);) {
    numbers.push_back(std::stod(line));  // also infinities and NaN
  }
  return numbers;
}

// The numbers that a script of R prints by `out(...)`, in order, as doubles whole to the last
// digit.
inline std::vector<double> r_numbers(const std::string& script) {
  const std::string out = "out <- function(...) cat(sprintf('%.17g\\n', c(...)), sep = '')\n";
  return numbers_in_lines(printed_by_script({"/usr/bin/Rscript", "--vanilla", "-e"}, out + script));
}

// The numbers that a script for Debian's python3 prints by `out(...)`, in order.
inline std::vector<double> python_numbers(const std::string& script) {
  const std::string out =
      "import numpy as np\ndef out(*values):\n  for v in values:\n"
      "    for x in np.ravel(v):\n      print(repr(float(x)))\n";
  return numbers_in_lines(printed_by_script({"/usr/bin/python3", "-c"}, out + script));
}
}  // namespace tapstudy::testing
