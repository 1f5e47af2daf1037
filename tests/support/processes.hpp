#pragma once
#include <string>
#include <vector>
namespace tapstudy::testing {
struct ProgramResult {
  int exit_code{};  // 128 + signal if one ended it
  std::string standard_output;
  std::string standard_error;
};
// Runs a program to its end with this on its standard input.
ProgramResult run_program(const std::vector<std::string>& arguments, const std::string& input = "");
// Runs the tapstudy that was built with these tests.
ProgramResult tapstudy(std::vector<std::string> arguments, const std::string& input = "");
// Runs a script of tests/ by Python; it finds that tapstudy in TAPSTUDY_PROGRAM.
ProgramResult run_script(const std::string& script, std::vector<std::string> arguments = {});
}  // namespace tapstudy::testing
