#pragma once
#include <string>
#include <utility>
#include <vector>
namespace tapstudy::runner {
// Settings of this machine that decide how punctual a loop can be: name and value of each, with
// what to do where a value is known to be bad.
std::vector<std::pair<std::string, std::string>> machine_facts();
}  // namespace tapstudy::runner
