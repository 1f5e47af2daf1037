#include "protocols/yaml/changed_texts.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <utility>
#include <vector>
namespace tapstudy::protocols {
namespace {
struct Leaf {
  std::string key;
  std::string value;
  int line{};
  // Where it stands is no matter of the data.
  bool operator==(const Leaf& other) const { return key == other.key && value == other.value; }
};

// A file as its values in order: those that may enter the data, and texts for people.
struct Leaves {
  std::vector<Leaf> data;
  std::vector<Leaf> texts;
};

// A stimulus of the name "a.label" has the path of the label of a stimulus "a".
bool can_be_text(const YAML::Node& node) {
  return node.IsScalar() ||
         (node.IsMap() && std::all_of(node.begin(), node.end(), [](const auto& entry) {
            return entry.first.IsScalar() && is_language(entry.first.Scalar());
          }));
}

std::string without_last_newline(std::string text) {
  if (text.ends_with('\n')) {
    text.pop_back();
  }
  return text;
}

enum class KeyOrder { of_file, as_read };  // the keys of some mappings have none to the reader

class LeafReader {
 public:
  LeafReader(const Translations& translations, KeyOrder order)
      : translations_{translations}, order_{order} {}
  void add(const YAML::Node& node, const std::string& path) {
    const auto text = translations_.texts.find(path);
    if (text != translations_.texts.end() && can_be_text(node)) {
      add_text(node, path, text->second);
      return;
    }
    const auto children = children_of(node, path);
    for (const auto& [child_path, child] : children) {
      add(child, child_path);
    }
    if (children.empty()) {
      leaves.data.push_back({path, value_of(node, path)});
    }
  }
  Leaves leaves;

 private:
  using Children = std::vector<std::pair<std::string, YAML::Node>>;
  void add_text(const YAML::Node& node, const std::string& path, InData in_data) {
    const std::size_t first = leaves.texts.size();
    if (node.IsScalar()) {
      leaves.texts.push_back(
          {path, without_last_newline(scalar(node, path)), node.Mark().line + 1});
    } else {
      for (const auto& entry : node) {
        leaves.texts.push_back({path + "." + entry.first.Scalar(),
                                without_last_newline(entry.second.Scalar()),
                                entry.second.Mark().line + 1});
      }
    }
    if (in_data == InData::first_text) {
      leaves.data.push_back({path, leaves.texts[first].value});
    } else if (in_data == InData::presence) {
      leaves.data.push_back({path, "given"});
    }
  }
  Children children_of(const YAML::Node& node, const std::string& path) const {
    const auto keys = translations_.keys.find({path, node.Mark().pos});
    const bool has_keys = keys != translations_.keys.end();
    const auto path_of = [&](const std::string& key) {
      return path.empty() ? key : path + "." + key;
    };
    Children children;
    if (node.IsMap()) {
      for (const auto& entry : node) {
        children.emplace_back(path_of(entry.first.Scalar()), entry.second);
      }
    } else if (node.IsSequence()) {
      for (std::size_t i = 0; i < node.size(); ++i) {
        children.emplace_back(has_keys ? path_of(keys->second[i]) : fmt::format("{}[{}]", path, i),
                              node[i]);
      }
    }
    if (has_keys && order_ == KeyOrder::as_read) {  // assigning to a node would change the file's
      const std::map<std::string, YAML::Node> sorted{children.begin(), children.end()};
      return {sorted.begin(), sorted.end()};
    }
    return children;
  }
  // As it was read: whether it is in quotes is no matter, nor how a number is written.
  std::string value_of(const YAML::Node& node, const std::string& path) const {
    if (!node.IsScalar()) {
      return node.IsMap() ? "{}" : node.IsSequence() ? "[]" : "null";
    }
    return "'" + scalar(node, path);
  }
  const std::string& scalar(const YAML::Node& node, const std::string& path) const {
    const auto value = translations_.values.find({path, node.Mark().pos});
    return value == translations_.values.end() ? node.Scalar() : value->second;
  }

  const Translations& translations_;
  KeyOrder order_;
};

Leaves leaves_of(const ReadText& file, KeyOrder order) {
  LeafReader reader{file.translations, order};
  reader.add(YAML::Load(file.text), "");
  return std::move(reader.leaves);
}

std::map<std::string, Leaf> by_key(const std::vector<Leaf>& leaves) {
  std::map<std::string, Leaf> all;
  for (const Leaf& leaf : leaves) {
    all.emplace(leaf.key, leaf);
  }
  return all;
}

// Keys whose values are not in both.
std::vector<std::string> differing_keys(const std::vector<Leaf>& before,
                                        const std::vector<Leaf>& now) {
  std::vector<std::string> keys;
  const auto add_missing = [&](const std::vector<Leaf>& from, const std::vector<Leaf>& in) {
    const std::map<std::string, Leaf> others = by_key(in);
    for (const Leaf& leaf : from) {
      const auto other = others.find(leaf.key);
      if ((other == others.end() || !(other->second == leaf)) &&
          std::ranges::find(keys, leaf.key) == keys.end()) {
        keys.push_back(leaf.key);
      }
    }
  };
  add_missing(now, before);
  add_missing(before, now);
  return keys;
}

// Where the order begins to differ.
std::vector<std::string> out_of_place(const std::vector<Leaf>& before,
                                      const std::vector<Leaf>& now) {
  const auto [in_before, in_now] = std::ranges::mismatch(before, now);
  if (in_before == before.end() && in_now == now.end()) {
    return {};
  }
  return {(in_now == now.end() ? *in_before : *in_now).key + " (its place)"};
}

// The first line that differs, of each; empty where one of them has no such line.
std::pair<std::string, std::string> differing_lines(const std::string& before,
                                                    const std::string& now) {
  std::istringstream lines_before{before};
  std::istringstream lines_now{now};
  std::pair<std::string, std::string> lines;
  while (lines.first == lines.second && (lines_before || lines_now)) {
    lines = {};
    std::getline(lines_before, lines.first);
    std::getline(lines_now, lines.second);
  }
  return lines;
}

std::vector<ChangedText> changed_texts(const std::vector<Leaf>& before,
                                       const std::vector<Leaf>& now) {
  std::vector<ChangedText> changed;
  const std::map<std::string, Leaf> earlier = by_key(before);
  for (const Leaf& leaf : now) {
    const auto found = earlier.find(leaf.key);
    const std::string was = found == earlier.end() ? "" : found->second.value;
    if (was != leaf.value) {
      const auto [line_before, line_now] = differing_lines(was, leaf.value);
      changed.push_back({leaf.key, line_before, line_now, leaf.line});
    }
  }
  const std::map<std::string, Leaf> later = by_key(now);
  for (const Leaf& leaf : before) {
    if (!later.contains(leaf.key)) {
      changed.push_back({leaf.key, differing_lines(leaf.value, "").first, "", leaf.line});
    }
  }
  return changed;
}
}  // namespace

ChangesOfFile changes_between(const ReadText& before, const ReadText& now) {
  const Leaves earlier = leaves_of(before, KeyOrder::of_file);
  const Leaves later = leaves_of(now, KeyOrder::of_file);
  std::vector<std::string> keys = differing_keys(earlier.data, later.data);
  if (keys.empty()) {
    keys = out_of_place(leaves_of(before, KeyOrder::as_read).data,
                        leaves_of(now, KeyOrder::as_read).data);
  }
  return {keys, changed_texts(earlier.texts, later.texts)};
}
}  // namespace tapstudy::protocols
