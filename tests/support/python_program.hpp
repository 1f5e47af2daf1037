#pragma once
#include <sstream>
#include <string>
#include <vector>

#include "support/catch.hpp"
#include "support/processes.hpp"
namespace tapstudy::testing {
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
