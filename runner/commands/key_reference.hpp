#pragma once
#include <string>
#include <vector>
namespace tapstudy::runner {
// The keys of YAML files in tables of Markdown, a section for each mapping, made from their JSON
// schemas.
std::string key_reference(const std::vector<std::string>& schemas);
// The schemas and the reference, in this directory. Throws InvalidInput if one cannot be written.
void write_key_documents(const std::string& directory);
}  // namespace tapstudy::runner
