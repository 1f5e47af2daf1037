#pragma once
#include <string>
#include <vector>
namespace tapstudy::runner {
// The keys of YAML files in tables of Markdown, a section for each mapping, made from their JSON
// schemas.
std::string key_reference(const std::vector<std::string>& schemas);
}  // namespace tapstudy::runner
