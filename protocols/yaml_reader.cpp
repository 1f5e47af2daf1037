#include "protocols/yaml_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
namespace tapstudy::protocols {
namespace {
std::string kind_of(const YAML::Node& node) {
  switch (node.Type()) {
    case YAML::NodeType::Undefined:
    case YAML::NodeType::Null:
      return "nothing";
    case YAML::NodeType::Scalar:
      return fmt::format("'{}'", node.Scalar());
    case YAML::NodeType::Sequence:
      return "a list";
    case YAML::NodeType::Map:
      return "a mapping";
  }
  return "something else";
}
}  // namespace

bool Range::contains(double x) const {
  return std::isfinite(x) && (low_included ? x >= low : x > low) &&
         (high_included ? x <= high : x < high);
}

std::string Range::words() const {
  return fmt::format("{} {} and {} {}", low_included ? "at least" : "greater than", low,
                     high_included ? "at most" : "less than", high);
}

MapReader::MapReader(const YAML::Node& node, std::string path, std::string pattern,
                     Problems& problems)
    : node_{std::make_unique<YAML::Node>(node)},
      path_{std::move(path)},
      pattern_{std::move(pattern)},
      problems_{&problems} {}
MapReader::~MapReader() = default;
MapReader::MapReader(MapReader&&) noexcept = default;

MapReader MapReader::whole_file(const std::string& text, const std::string& file,
                                Problems& problems) {
  try {
    MapReader reader{YAML::Load(text), "", "", problems};
    if (!reader.node_->IsMap()) {
      throw core::InvalidInput{fmt::format("{}:1:1: not a mapping of keys to values", file)};
    }
    return reader;
  } catch (const YAML::ParserException& error) {
    throw core::InvalidInput{fmt::format("{}:{}:{}: not YAML: {}", file, error.mark.line + 1,
                                         error.mark.column + 1, error.msg)};
  }
}

std::string MapReader::path_of(const std::string& key) const {
  return path_.empty() ? key : path_ + "." + key;
}
std::string MapReader::pattern_of(const std::string& key) const {
  if (has_free_names_) {
    return pattern_ + ".*";
  }
  return pattern_.empty() ? key : pattern_ + "." + key;
}

void MapReader::reject_at(const YAML::Node& node, const std::string& path,
                          const std::string& what) {
  problems_->add(std::max(0, node.Mark().line), std::max(0, node.Mark().column), path, what);
}
void MapReader::reject(const std::string& what) {
  reject_at(*node_, path_, what);
}
void MapReader::reject(const std::string& key, const std::string& what) {
  const YAML::Node& whole = *node_;
  const YAML::Node value = whole[key];
  reject_at(value.IsDefined() ? value : whole, path_of(key), what);
}

bool MapReader::has(const std::string& key) const {
  const YAML::Node& whole = *node_;
  return whole[key].IsDefined();
}

std::optional<YAML::Node> MapReader::find(const std::string& key, bool required) {
  known_.push_back(key);
  problems_->asked_for(pattern_of(key));
  const YAML::Node& whole = *node_;  // through const, so that asking does not insert
  const YAML::Node value = whole[key];
  if (value.IsDefined()) {
    return value;
  }
  if (required) {
    reject(key, "is missing");
  }
  return std::nullopt;
}

std::optional<double> MapReader::as_number(const YAML::Node& node, const std::string& path,
                                           const Range& range) {
  double value{};
  if (!node.IsScalar() || !YAML::convert<double>::decode(node, value)) {
    reject_at(node, path, fmt::format("{} is not a number", kind_of(node)));
    return std::nullopt;
  }
  if (!range.contains(value)) {
    reject_at(node, path, fmt::format("{} is not allowed ({})", value, range.words()));
    return std::nullopt;
  }
  return value;
}

double MapReader::number(const std::string& key, const Range& range,
                         std::optional<double> otherwise) {
  const double harmless = otherwise.value_or(range.low_included ? range.low : range.high);
  const auto node = find(key, !otherwise);
  return node ? as_number(*node, path_of(key), range).value_or(harmless) : harmless;
}

int MapReader::integer(const std::string& key, int low, int high, std::optional<int> otherwise) {
  const auto node = find(key, !otherwise);
  if (!node) {
    return otherwise.value_or(low);
  }
  int value{};
  if (!node->IsScalar() || !YAML::convert<int>::decode(*node, value)) {
    reject_at(*node, path_of(key), fmt::format("{} is not a whole number", kind_of(*node)));
    return low;
  }
  if (value < low || value > high) {
    reject_at(*node, path_of(key),
              fmt::format("{} is not allowed (from {} to {})", value, low, high));
    return low;
  }
  return value;
}

bool MapReader::yes_or_no(const std::string& key, std::optional<bool> otherwise) {
  const auto node = find(key, !otherwise);
  bool value = otherwise.value_or(false);
  if (node && !YAML::convert<bool>::decode(*node, value)) {
    reject_at(*node, path_of(key), fmt::format("{} is neither true nor false", kind_of(*node)));
  }
  return value;
}

std::string MapReader::text(const std::string& key, std::optional<std::string> otherwise) {
  const auto node = find(key, !otherwise);
  if (!node) {
    return otherwise.value_or("");
  }
  if (!node->IsScalar() || node->Scalar().empty()) {
    reject_at(*node, path_of(key), fmt::format("{} is not text", kind_of(*node)));
    return "";
  }
  return node->Scalar();
}

Eigen::VectorXd MapReader::numbers(const std::string& key, Eigen::Index size, const Range& range) {
  Eigen::VectorXd values = Eigen::VectorXd::Constant(size, range.high);
  const auto node = find(key, true);
  if (!node) {
    return values;
  }
  if (!node->IsSequence() || node->size() != static_cast<std::size_t>(size)) {
    reject_at(*node, path_of(key), fmt::format("is not a list of {} numbers", size));
    return values;
  }
  for (Eigen::Index i = 0; i < size; ++i) {
    const std::string path = fmt::format("{}[{}]", path_of(key), i);
    values[i] = as_number((*node)[i], path, range).value_or(range.high);
  }
  return values;
}

bool MapReader::is_allowed(const YAML::Node& node, const std::string& path,
                           const std::string& kind, const std::vector<std::string>& allowed) {
  if (node.IsScalar() && std::ranges::find(allowed, node.Scalar()) != allowed.end()) {
    return true;
  }
  const std::string hint = node.IsScalar() ? did_you_mean(node.Scalar(), allowed) : "";
  reject_at(node, path, fmt::format("{} is not a known {} (one of: {}{})", kind_of(node), kind,
                                    fmt::join(allowed, ", "), hint));
  return false;
}

std::string MapReader::word(const std::string& key, const std::string& kind,
                            const std::vector<std::string>& allowed,
                            std::optional<std::string> otherwise) {
  const auto node = find(key, !otherwise);
  const std::string harmless = otherwise.value_or("");
  return node && is_allowed(*node, path_of(key), kind, allowed) ? node->Scalar() : harmless;
}

std::vector<std::string> MapReader::words(const std::string& key, const std::string& kind,
                                          const std::vector<std::string>& allowed,
                                          std::optional<std::vector<std::string>> otherwise) {
  const auto node = find(key, !otherwise);
  if (!node) {
    return otherwise.value_or(std::vector<std::string>{});
  }
  if (!node->IsSequence() || node->size() == 0) {
    reject_at(*node, path_of(key), fmt::format("is not a list of at least one {}", kind));
    return {};
  }
  std::vector<std::string> chosen;
  for (std::size_t i = 0; i < node->size(); ++i) {
    const std::string path = fmt::format("{}[{}]", path_of(key), i);
    const YAML::Node item = (*node)[i];
    if (!is_allowed(item, path, kind, allowed)) {
      continue;
    }
    if (std::ranges::find(chosen, item.Scalar()) != chosen.end()) {
      reject_at(item, path, fmt::format("'{}' is listed twice", item.Scalar()));
      continue;
    }
    chosen.push_back(item.Scalar());
  }
  return chosen;
}

void MapReader::read_inner(const YAML::Node& node, const std::string& path,
                           const std::string& pattern, const ReadMap& read) {
  MapReader inner{node, path, pattern, *problems_};
  if (!node.IsMap()) {
    inner.reject(fmt::format("{} is not a mapping", kind_of(node)));
    return;
  }
  read(inner);
  inner.finish();
}

void MapReader::map(const std::string& key, Presence presence, const ReadMap& read) {
  if (const auto node = find(key, presence == Presence::required)) {
    read_inner(*node, path_of(key), pattern_of(key), read);
  }
}

std::optional<YAML::Node> MapReader::find_map(const std::string& key, Presence presence) {
  const auto node = find(key, presence == Presence::required);
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
  map(key, presence, [&](MapReader& points) {
    points.has_free_names_ = true;
    for (const auto& entry : *points.node_) {
      const std::string name = entry.first.Scalar();
      take(name, points.numbers(name, 2, {-100.0, 100.0}));
    }
  });
}

void MapReader::each_text(
    const std::string& key, Presence presence,
    const std::function<void(const std::string&, const std::string&)>& take) {
  map(key, presence, [&](MapReader& texts) {
    texts.has_free_names_ = true;
    for (const auto& entry : *texts.node_) {
      const std::string name = entry.first.Scalar();
      take(name, texts.text(name));
    }
  });
}

void MapReader::list(const std::string& key, Presence presence, const ReadMap& read) {
  const auto node = find(key, presence == Presence::required);
  if (!node) {
    return;
  }
  if (!node->IsSequence()) {
    reject_at(*node, path_of(key), fmt::format("{} is not a list", kind_of(*node)));
    return;
  }
  for (std::size_t i = 0; i < node->size(); ++i) {
    read_inner((*node)[i], fmt::format("{}[{}]", path_of(key), i), pattern_of(key) + "[]", read);
  }
}

void MapReader::finish() {
  std::vector<std::string> seen;
  for (const auto& entry : *node_) {
    const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "?";
    if (std::ranges::find(known_, key) == known_.end()) {
      reject_at(entry.first, path_of(key),
                fmt::format("is not a known key (one of: {}{})", fmt::join(known_, ", "),
                            did_you_mean(key, known_)));
    } else if (std::ranges::find(seen, key) != seen.end()) {
      reject_at(entry.first, path_of(key), "is there twice");
    }
    seen.push_back(key);
  }
}
}  // namespace tapstudy::protocols
