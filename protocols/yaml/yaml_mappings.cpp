// Mappings and lists inside mappings.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>

#include "protocols/yaml/problems.hpp"
#include "protocols/yaml/yaml_reader.hpp"
namespace tapstudy::protocols {
void MapReader::read_inner(const YAML::Node& node, const std::string& path,
                           const std::string& pattern, const ReadMap& read) {
  MapReader inner{node, path, pattern, *problems_, translations_};
  if (!node.IsMap()) {
    inner.reject(fmt::format("{} is not a mapping", kind_of(node)));
    return;
  }
  read(inner);
  inner.finish();
}

void MapReader::map(const std::string& key, Presence presence, const ReadMap& read) {
  if (const auto node = find(key, presence != Presence::optional)) {
    read_inner(*node, path_of(key), pattern_of(key), read);
  }
}

void MapReader::map_or_list(const std::string& key, Presence presence,
                            const std::vector<std::string>& keys, const ReadMap& read) {
  const auto node = find(key, presence != Presence::optional);
  if (!node) {
    return;
  }
  if (node->IsMap()) {
    read_inner(*node, path_of(key), pattern_of(key), read);
    return;
  }
  if (!node->IsSequence()) {
    reject_at(*node, path_of(key),
              fmt::format("{} is neither a mapping nor a list of {}", kind_of(*node),
                          fmt::join(keys, ", ")));
    return;
  }
  if (node->size() > keys.size() || node->size() + 1 < keys.size()) {
    reject_at(*node, path_of(key),
              fmt::format("is not a list of {}: it has {} values (the last may be left out)",
                          fmt::join(keys, ", "), node->size()));
    return;
  }
  YAML::Node mapping{YAML::NodeType::Map};
  for (std::size_t i = 0; i < node->size(); ++i) {
    mapping[keys[i]] = (*node)[i];
  }
  MapReader inner{mapping, path_of(key), pattern_of(key), *problems_, translations_};
  inner.list_ = std::make_unique<YAML::Node>(*node);
  read(inner);
}

std::optional<YAML::Node> MapReader::find_map(const std::string& key, Presence presence) {
  auto node = find(key, presence != Presence::optional);
  if (node && (!node->IsMap() || node->size() == 0)) {
    reject_at(*node, path_of(key), "is not a mapping with at least one name");
    return std::nullopt;
  }
  return node;
}

void MapReader::each(const std::string& key, Presence presence, const ReadNamed& read) {
  const auto node = find_map(key, presence);
  if (!node) {
    return;
  }
  std::vector<std::string> seen;
  for (const auto& entry : *node) {
    if (!check_name(entry.first, path_of(key))) {
      continue;
    }
    const std::string name = entry.first.Scalar();
    if (std::ranges::find(seen, name) != seen.end()) {
      reject_at(entry.first, path_of(key) + "." + name, "is there twice");
    }
    seen.push_back(name);
    read_inner(entry.second, path_of(key) + "." + name, pattern_of(key) + ".*",
               [&](MapReader& inner) { read(name, inner); });
  }
}

void MapReader::each_point(
    const std::string& key, Presence presence,
    const std::function<void(const std::string&, const Eigen::Vector2d&)>& take) {
  const auto node = find_map(key, presence);
  if (!node) {
    return;
  }
  read_inner(*node, path_of(key), pattern_of(key), [&](MapReader& points) {
    points.has_free_names_ = true;
    for (const auto& entry : *points.node_) {
      if (points.check_name(entry.first, path_of(key))) {
        const std::string name = entry.first.Scalar();
        take(name, points.numbers(name, 2, {-100.0, 100.0}));
      }
    }
  });
}

void MapReader::each_text(const std::string& key, Presence presence,
                          const std::function<void(const std::string&, const std::string&)>& take) {
  each_named(key, presence,
             [&](MapReader& texts, const std::string& name) { take(name, texts.name(name)); });
}

void MapReader::each_named(
    const std::string& key, Presence presence,
    const std::function<void(MapReader& inner, const std::string& name)>& read) {
  map(key, presence, [&](MapReader& inner) {
    inner.has_free_names_ = true;
    for (const auto& entry : *inner.node_) {
      if (inner.check_name(entry.first, path_of(key))) {
        read(inner, entry.first.Scalar());
      }
    }
  });
}

void MapReader::list(const std::string& key, Presence presence, const ReadMap& read) {
  const auto node = find(key, presence != Presence::optional);
  if (!node) {
    return;
  }
  if (!node->IsSequence()) {
    reject_at(*node, path_of(key), fmt::format("{} is not a list", kind_of(*node)));
    return;
  }
  if (presence == Presence::at_least_one && node->size() == 0) {
    reject_at(*node, path_of(key), "is empty (at least one)");
  }
  for (std::size_t i = 0; i < node->size(); ++i) {
    read_inner((*node)[i], fmt::format("{}[{}]", path_of(key), i), pattern_of(key) + "[]", read);
  }
}

void MapReader::finish() {
  std::vector<std::string> seen;
  std::vector<std::string> allowed = known_;
  std::ranges::copy_if(looked_for_, std::back_inserter(allowed), [&](const std::string& key) {
    return std::ranges::find(allowed, key) == allowed.end();
  });
  for (const auto& entry : *node_) {
    const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "?";
    if (std::ranges::find(known_, key) == known_.end()) {
      reject_at(entry.first, path_of(key),
                fmt::format("is not a known key (one of: {}{})", fmt::join(allowed, ", "),
                            did_you_mean(key, allowed)));
    } else if (std::ranges::find(seen, key) != seen.end()) {
      reject_at(entry.first, path_of(key), "is there twice");
    }
    seen.push_back(key);
  }
}
}  // namespace tapstudy::protocols
