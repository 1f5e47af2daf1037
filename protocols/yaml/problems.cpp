#include "protocols/yaml/problems.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cctype>
#include <numeric>
#include <sstream>
#include <string_view>
#include <tuple>
#include <utility>

#include "core/error.hpp"
#include "core/text/plain_text.hpp"
namespace tapstudy::protocols {
namespace {
constexpr std::size_t max_echo = 60;
}

std::string printable(const std::string& text) {
  std::string safe = core::shortened(text, max_echo);
  std::ranges::replace_if(
      safe, [](unsigned char c) { return std::iscntrl(c) != 0; }, '?');
  return safe;
}

std::string kind_of(const YAML::Node& node) {
  switch (node.Type()) {
    case YAML::NodeType::Undefined:
    case YAML::NodeType::Null:
      return "nothing";
    case YAML::NodeType::Scalar:
      return fmt::format("'{}'", printable(node.Scalar()));
    case YAML::NodeType::Sequence:
      return "a list";
    case YAML::NodeType::Map:
      return "a mapping";
  }
  return "something else";
}

namespace {
// Levenshtein 1966.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
    }
  }
  return row.back();
}
}  // namespace

void Problems::read_from(const std::string& text) {
  std::istringstream stream{text};
  std::string line;
  while (std::getline(stream, line)) {
    lines_.push_back(line);
  }
}

std::string Problems::place(int line, int column, const std::string& key_path) const {
  const auto row = static_cast<std::size_t>(line);
  const auto bytes = static_cast<std::size_t>(column);
  const std::size_t characters =
      row < lines_.size() && bytes <= lines_[row].size()
          ? core::character_count(std::string_view{lines_[row]}.substr(0, bytes))
          : bytes;
  return fmt::format("{}:{}:{}{}{}", file_, line + 1, characters + 1, key_path.empty() ? "" : ": ",
                     key_path);
}

void Problems::add(int line, int column, const std::string& key_path, const std::string& what,
                   const std::optional<std::string>& may_follow) {
  if (places_.insert(place(line, column, key_path)).second) {
    problems_.push_back({line, column, key_path, what, may_follow});
  }
}

bool Problems::withdraw_missing(const std::string& key_path) {
  return std::erase_if(problems_, [&](const Problem& problem) {
           return problem.key_path == key_path && problem.what == key_is_missing;
         }) > 0;
}

bool Problems::follows(const Problem& problem) const {
  const auto is_at_or_below = [&](const std::string& path) {
    const std::string& whole = *problem.may_follow;
    return whole.empty() || path == whole || path.starts_with(whole + ".") ||
           path.starts_with(whole + "[");
  };
  return problem.may_follow && std::ranges::any_of(problems_, [&](const Problem& other) {
           return !other.may_follow && is_at_or_below(other.key_path);
         });
}

void Problems::throw_if_any() const {
  if (problems_.empty()) {
    return;
  }
  std::vector<Problem> sorted;
  std::ranges::copy_if(problems_, std::back_inserter(sorted),
                       [this](const Problem& problem) { return !follows(problem); });
  std::ranges::stable_sort(sorted, {}, [](const Problem& problem) {
    return std::tuple{problem.line, problem.column};
  });
  std::vector<std::string> lines;
  std::ranges::transform(sorted, std::back_inserter(lines), [this](const Problem& problem) {
    return place(problem.line, problem.column, problem.key_path) + ": " + problem.what;
  });
  throw core::InvalidInput{fmt::format("{}", fmt::join(lines, "\n"))};
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& allowed) {
  const auto closest = std::ranges::min_element(
      allowed, {}, [&](const std::string& candidate) { return edit_distance(word, candidate); });
  const auto most = std::min(1 + word.size() / 4, word.empty() ? 0 : word.size() - 1);
  if (closest == allowed.end() || edit_distance(word, *closest) > most) {
    return "";
  }
  return fmt::format(", did you mean '{}'?", *closest);
}
}  // namespace tapstudy::protocols
