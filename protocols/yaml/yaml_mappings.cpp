// Mappings and lists inside mappings.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>

#include "protocols/yaml/described_values.hpp"
#include "protocols/yaml/problems.hpp"
#include "protocols/yaml/yaml_reader.hpp"
namespace tapstudy::protocols {
void MapReader::read_inner(const YAML::Node& node, const std::string& path,
                           const std::string& pattern, const ReadMap& read) {
  MapReader inner{node, path, pattern, *problems_, translations_};
  if (!node.IsMap()) {
    reject_at(node, path, fmt::format("{} is not a mapping", kind_of(node)));
    return;
  }
  inner.reject_decimal_commas();
  read(inner);
  inner.finish();
}

std::string MapReader::schema_of(const std::string& title, const std::string& about,
                                 const ReadMap& read) {
  SchemaJson schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                    {"title", "tapstudy " + title},
                    {"description", about}};
  Problems ignored{title};
  KnownMappings known;
  schema.update(described_mapping("", known, [&](Description& pass) {
    MapReader top{YAML::Node{YAML::NodeType::Map}, "", "", ignored, nullptr};
    top.pass_ = &pass;
    read(top);
  }));
  return schema.dump(2) + "\n";
}

void MapReader::describe_inner(const Key& key, Presence presence, Shape shape, const ReadMap& read,
                               const std::vector<std::string>& as_list, const std::string& word) {
  problems_->add_unread();
  SchemaJson schema =
      described_mapping(pattern_of(key.name), pass_->known_mappings(), [&](Description& pass) {
        MapReader inner{YAML::Node{YAML::NodeType::Map}, path_of(key.name), pattern_of(key.name),
                        *problems_, translations_};
        inner.pass_ = &pass;
        read(inner);
      });
  const bool is_optional = presence == Presence::optional;
  if (shape == Shape::named) {
    schema = described_named(std::move(schema), 1);
  } else if (shape == Shape::list) {
    schema = {{"type", "array"}, {"items", std::move(schema)}};
    if (presence == Presence::at_least_one) {
      schema["minItems"] = 1;
    }
  }
  if (!as_list.empty()) {
    make_list_too(schema, as_list);
  }
  if (!word.empty()) {
    make_word_too(schema, word);
  }
  pass_->add(
      key, std::move(schema), !is_optional,
      shape == Shape::list ? described_empty_list(is_optional) : described_empty(is_optional));
}

void MapReader::map(const Key& key, Presence presence, const ReadMap& read) {
  if (pass_ != nullptr) {
    describe_inner(key, presence, Shape::mapping, read);
    return;
  }
  if (const auto node = find(key.name, presence != Presence::optional)) {
    read_inner(*node, path_of(key.name), pattern_of(key.name), read);
  }
}

void MapReader::map_or_list(const Key& key, Presence presence, const std::vector<std::string>& keys,
                            const ReadMap& read) {
  if (pass_ != nullptr) {
    describe_inner(key, presence, Shape::mapping, read, keys);
    return;
  }
  const auto node = find(key.name, presence != Presence::optional);
  if (!node) {
    return;
  }
  if (node->IsMap()) {
    read_inner(*node, path_of(key.name), pattern_of(key.name), read);
    return;
  }
  if (!node->IsSequence()) {
    reject_at(*node, path_of(key.name),
              fmt::format("{} is neither a mapping nor a list of {}", kind_of(*node),
                          fmt::join(keys, ", ")));
    return;
  }
  if (node->size() > keys.size() || node->size() + 1 < keys.size()) {
    reject_at(*node, path_of(key.name),
              fmt::format("is not a list of {}: it has {} values (the last may be left out)",
                          fmt::join(keys, ", "), node->size()));
    return;
  }
  YAML::Node mapping{YAML::NodeType::Map};
  for (std::size_t i = 0; i < node->size(); ++i) {
    mapping[keys[i]] = (*node)[i];
  }
  MapReader inner{mapping, path_of(key.name), pattern_of(key.name), *problems_, translations_};
  inner.list_ = std::make_unique<YAML::Node>(*node);
  read(inner);
  if (translations_ != nullptr) {
    translations_->keys[{inner.path_, node->Mark().pos}] = keys;
  }
}

void MapReader::map_or_word(const Key& key, Presence presence, const std::string& word,
                            const std::function<void()>& take, const ReadMap& read) {
  if (pass_ != nullptr) {
    describe_inner(key, presence, Shape::mapping, read, {}, word);
    return;
  }
  const auto node = find(key.name, presence != Presence::optional);
  if (node && node->IsScalar() && node->Scalar() == word) {
    take();
  } else if (node && !node->IsMap()) {
    reject_at(*node, path_of(key.name),
              fmt::format("{} is neither a mapping nor '{}'", kind_of(*node), word));
  } else if (node) {
    read_inner(*node, path_of(key.name), pattern_of(key.name), read);
  }
}

std::optional<YAML::Node> MapReader::find_map(const std::string& key, Presence presence) {
  auto node = find(key, presence != Presence::optional);
  if (node && (!node->IsMap() || node->size() == 0)) {
    reject_at(*node, path_of(key), "is not a mapping with at least one name");
    return std::nullopt;
  }
  return node;
}

void MapReader::each(const Key& key, Presence presence, const ReadNamed& read) {
  if (pass_ != nullptr) {
    describe_inner(key, presence, Shape::named, [&](MapReader& inner) { read("", inner); });
    return;
  }
  const auto node = find_map(key.name, presence);
  if (!node) {
    return;
  }
  std::vector<std::string> seen;
  for (const auto& entry : *node) {
    if (!check_name(entry.first, path_of(key.name))) {
      continue;
    }
    const std::string name = entry.first.Scalar();
    if (std::ranges::find(seen, name) != seen.end()) {
      reject_at(entry.first, path_of(key.name) + "." + name, "is there twice");
    }
    seen.push_back(name);
    read_inner(entry.second, path_of(key.name) + "." + name, pattern_of(key.name) + ".*",
               [&](MapReader& inner) { read(name, inner); });
  }
}

namespace {
constexpr Range place_m{-100.0, 100.0};
}

void MapReader::each_point(
    const Key& key, Presence presence,
    const std::function<void(const std::string&, const Eigen::Vector2d&)>& take) {
  if (pass_ != nullptr) {
    SchemaJson point{
        {"type", "array"}, {"items", described(place_m)}, {"minItems", 2}, {"maxItems", 2}};
    pass_->add(key, described_named(std::move(point), 1), presence != Presence::optional);
    return;
  }
  const auto node = find_map(key.name, presence);
  if (!node) {
    return;
  }
  read_inner(*node, path_of(key.name), pattern_of(key.name), [&](MapReader& points) {
    points.has_free_names_ = true;
    for (const auto& entry : *points.node_) {
      if (points.check_name(entry.first, path_of(key.name))) {
        const std::string name = entry.first.Scalar();
        take(name, points.numbers(Key{name}, 2, place_m));
      }
    }
  });
}

void MapReader::each_text(const Key& key, Presence presence,
                          const std::function<void(const std::string&, const std::string&)>& take) {
  if (pass_ != nullptr) {
    pass_->add(key, described_named(described_name(), presence == Presence::at_least_one ? 1 : 0),
               presence != Presence::optional, described_empty(presence == Presence::optional));
    return;
  }
  each_named(key, presence,
             [&](MapReader& texts, const std::string& name) { take(name, texts.name(Key{name})); });
}

void MapReader::each_list(
    const Key& key, Presence presence,
    const std::function<void(MapReader& inner, const std::string& name)>& read) {
  if (pass_ != nullptr) {
    SchemaJson words{
        {"type", "array"}, {"items", described_name()}, {"minItems", 1}, {"uniqueItems", true}};
    pass_->add(key, described_named(std::move(words), presence == Presence::optional ? 0 : 1),
               presence != Presence::optional, described_empty(presence == Presence::optional));
    return;
  }
  each_named(key, presence, read);
}

void MapReader::each_named(
    const Key& key, Presence presence,
    const std::function<void(MapReader& inner, const std::string& name)>& read) {
  map(key, presence, [&](MapReader& inner) {
    inner.has_free_names_ = true;
    for (const auto& entry : *inner.node_) {
      if (inner.check_name(entry.first, path_of(key.name))) {
        read(inner, entry.first.Scalar());
      }
    }
  });
}

void MapReader::list(const Key& key, Presence presence, const ReadMap& read) {
  if (pass_ != nullptr) {
    describe_inner(key, presence, Shape::list, read);
    return;
  }
  const auto node = find(key.name, presence != Presence::optional);
  if (!node) {
    return;
  }
  if (!node->IsSequence()) {
    reject_at(*node, path_of(key.name), fmt::format("{} is not a list", kind_of(*node)));
    return;
  }
  if (presence == Presence::at_least_one && node->size() == 0) {
    reject_at(*node, path_of(key.name), "is empty (at least one)");
  }
  for (std::size_t i = 0; i < node->size(); ++i) {
    read_inner((*node)[i], fmt::format("{}[{}]", path_of(key.name), i), pattern_of(key.name) + "[]",
               read);
  }
}

int MapReader::count_given(const std::vector<std::string>& keys, Presence presence) {
  if (pass_ != nullptr) {
    pass_->choose(presence == Presence::at_least_one ? "anyOf" : "oneOf", keys);
    return 0;
  }
  return static_cast<int>(std::ranges::count_if(keys, [&](const auto& key) { return has(key); }));
}

bool MapReader::depends_on_others(bool condition) {
  depends_on_others_ = depends_on_others_ || !condition;
  return pass_ == nullptr
             ? condition
             : pass_->ask({Description::Question::Kind::hidden, "", {false, true}}) == 1;
}

Range MapReader::narrowed(const Range& stated, const Range& here) const {
  return pass_ == nullptr ? here : stated;
}

void MapReader::refuse(const std::string& key, const std::string& what) {
  if (pass_ != nullptr) {
    pass_->remove(key);
  } else if (has(key)) {
    known_.push_back(key);
    const YAML::Node& whole = *node_;
    reject_at(whole[key], path_of(key), what,
              is_choice_unread_ ? std::optional{path_} : std::nullopt);
  }
}

void MapReader::refuse_beside(const std::string& chosen, const std::vector<std::string>& others) {
  const YAML::Node& whole = *node_;
  const auto given = std::ranges::find_if(
      others, [&](const std::string& other) { return whole[other].IsDefined(); });
  if (pass_ == nullptr && given != others.end()) {
    reject_at(whole[*given], path_of(*given),
              fmt::format("stands beside {}: one of them says it", chosen));
    known_.insert(known_.end(), given, others.end());
  }
}

void MapReader::refuse_former(const std::string& key, const std::string& now) {
  const YAML::Node& whole = *node_;
  if (pass_ == nullptr && whole[key].IsDefined()) {
    known_.push_back(key);
    reject_at(whole[key], path_of(key), "is a key of an earlier version: now it is " + now);
  }
}

void MapReader::check(const std::string& key, bool is_right, const std::string& schema,
                      const std::string& what) {
  if (pass_ != nullptr) {
    pass_->narrow(key, SchemaJson::parse(schema));
  } else if (!is_right) {
    reject(key, what);
  }
}

void MapReader::check_count(const std::string& key, const std::vector<std::string>& names,
                            std::size_t least, std::size_t most, const std::string& what) {
  if (pass_ != nullptr) {
    pass_->narrow(key, {{"minItems", std::max<std::size_t>(least, 1)}, {"maxItems", most}});
  } else if (names.size() < least || names.size() > most) {
    reject(key, what);
  }
}

void MapReader::reject_unknown(const YAML::Node& node, const std::string& key) {
  if (key == "<<") {
    reject_at(node, path_of(key), merges_are_not_read);
    for (const std::string& merged : known_) {
      problems_->withdraw_missing(path_of(merged));
    }
    return;
  }
  std::vector<std::string> allowed = known_;
  if (std::ranges::find(looked_for_, key) != looked_for_.end()) {
    reject_at(node, path_of(key),
              fmt::format("is not read beside the other keys given (allowed with them: {})",
                          fmt::join(allowed, ", ")));
    return;
  }
  std::ranges::copy_if(looked_for_, std::back_inserter(allowed), [&](const std::string& other) {
    return std::ranges::find(allowed, other) == allowed.end();
  });
  const std::string hint = did_you_mean(key, allowed);
  const bool is_misspelt = std::ranges::any_of(allowed, [&](const std::string& other) {
    return hint == did_you_mean(other, {other}) && problems_->withdraw_missing(path_of(other));
  });
  if (is_choice_unread_ && !is_misspelt) {
    return;
  }
  const std::optional<std::string> may_follow =
      depends_on_others_ && hint.empty() ? std::optional<std::string>{""} : std::nullopt;
  reject_at(node, path_of(key),
            fmt::format("is not a known key (one of: {}{})", fmt::join(allowed, ", "), hint),
            may_follow);
}

void MapReader::finish() {
  if (!has_free_names_ && translations_ != nullptr) {
    translations_->keys.try_emplace({path_, node_->Mark().pos});
  }
  std::vector<std::string> seen;
  for (const auto& entry : *node_) {
    const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "?";
    if (decimals_.contains(key)) {
      continue;
    }
    if (std::ranges::find(known_, key) == known_.end()) {
      reject_unknown(entry.first, key);
    } else if (std::ranges::find(seen, key) != seen.end()) {
      reject_at(entry.first, path_of(key), "is there twice", path_of(key));  // nothing follows
    }
    seen.push_back(key);
  }
}
}  // namespace tapstudy::protocols
