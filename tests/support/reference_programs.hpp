#pragma once
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sstream>
#include <string>
#include <vector>

#include "support/catch.hpp"
#include "support/processes.hpp"
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

// The numbers that a script of R prints by `out(...)`, in order, as doubles whole to the last
// digit.
inline std::vector<double> r_numbers(const std::string& script) {
  const std::string out = "out <- function(...) cat(sprintf('%.17g\\n', c(...)), sep = '')\n";
  const ProgramResult run = run_program({"/usr/bin/Rscript", "--vanilla", "-e", out + script});
  INFO(run.standard_error);
  REQUIRE(run.exit_code == 0);
  std::istringstream lines{run.standard_output};
  std::vector<double> numbers;
  for (std::string line; std::getline(lines, line);) {
    numbers.push_back(std::stod(line));  // also Inf and NaN
  }
  return numbers;
}

// The numbers that a script for Debian's python3 prints by `out(...)`, in order.
inline std::vector<double> python_numbers(const std::string& script) {
  const std::string out =
      "import numpy as np\ndef out(*values):\n  for v in values:\n"
      "    for x in np.ravel(v):\n      print(repr(float(x)))\n";
  const ProgramResult run = run_program({"/usr/bin/python3", "-c", out + script});
  INFO(run.standard_error);
  REQUIRE(run.exit_code == 0);
  std::istringstream lines{run.standard_output};
  std::vector<double> numbers;
  for (std::string line; std::getline(lines, line);) {
    numbers.push_back(std::stod(line));  // also inf and nan
  }
  return numbers;
}
}  // namespace tapstudy::testing
