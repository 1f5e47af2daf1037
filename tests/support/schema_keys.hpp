#pragma once
#include <nlohmann/json.hpp>
#include <set>
#include <string>
namespace tapstudy::testing {
inline void collect_keys(const nlohmann::json& schema, const std::string& path,
                         std::set<std::string>& keys) {
  if (schema.contains("properties")) {
    for (const auto& [key, inner] : schema["properties"].items()) {
      const std::string own = path.empty() ? key : path + "." + key;
      keys.insert(own);
      collect_keys(inner, own, keys);
    }
  }
  if (schema.contains("additionalProperties") && schema["additionalProperties"].is_object()) {
    // names of mappings are free and not themselves keys; names of values are
    const nlohmann::json& value = schema["additionalProperties"];
    if (!value.contains("properties")) {
      keys.insert(path + ".*");
    }
    collect_keys(value, path + ".*", keys);
  }
  if (schema.contains("items") && schema["items"].contains("properties")) {
    collect_keys(schema["items"], path + "[]", keys);
  }
}

// The path of every key that a JSON schema allows, as Problems::asked has them.
inline std::set<std::string> schema_keys(const nlohmann::json& schema) {
  std::set<std::string> keys;
  collect_keys(schema, "", keys);
  return keys;
}
}  // namespace tapstudy::testing
