#pragma once
#include <string>
namespace tapstudy::protocols {
// A key of a YAML file where it is read. Schema and reference are made from what stands there.
struct Key {
  explicit Key(std::string free_name) : name{std::move(free_name)} {}
  Key(std::string key, std::string said, std::string shown = {})
      : name{std::move(key)}, meaning{std::move(said)}, example{std::move(shown)} {}
  std::string name;
  std::string meaning;  // one sentence; "unset: …" where an absent key has no default
  std::string example;  // in YAML; of a section that no shipped file has
};
}  // namespace tapstudy::protocols
