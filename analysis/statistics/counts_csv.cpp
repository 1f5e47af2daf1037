#include "analysis/statistics/counts_csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <set>
#include <span>

#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
struct Line {
  int number;
  std::vector<std::string> cells;
};

constexpr std::size_t max_classes = 200;
constexpr int max_answers = 1'000'000;

[[noreturn]] void refuse(const std::string& file, int line, const std::string& what) {
  throw core::InvalidInput{fmt::format("{}:{}: {}", file, line, what)};
}

bool has_name(const std::vector<Item>& items, const std::string& name) {
  return std::ranges::find(items, name, &Item::name) != items.end();
}

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r\"");
  const auto last = text.find_last_not_of(" \t\r\"");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::size_t start = 0;
  for (std::size_t comma = 0; comma != std::string::npos; start = comma + 1) {
    comma = line.find(',', start);
    cells.push_back(trimmed(line.substr(start, comma - start)));
  }
  return cells;
}

std::vector<Line> read_lines(std::istream& text, const std::string& file) {
  std::vector<Line> lines;
  int number = 0;
  for (std::string line; std::getline(text, line);) {
    ++number;
    if (trimmed(line).empty() || line.front() == '#') {
      continue;
    }
    lines.push_back({number, split(line)});
    if (lines.back().cells.size() != lines.front().cells.size()) {
      refuse(file, number,
             fmt::format("has {} cells, the header has {}", lines.back().cells.size(),
                         lines.front().cells.size()));
    }
  }
  if (lines.size() < 2 || lines.front().cells.front() != "stimulus") {
    refuse(file, lines.empty() ? 1 : lines.front().number,
           "is not a table with a header that starts with 'stimulus' and at least one row");
  }
  return lines;
}

int count_in(const std::string& cell, const std::string& file, int line) {
  int value{};
  const char* const end = cell.data() + cell.size();
  const auto [stopped, error] = std::from_chars(cell.data(), end, value);
  if (error != std::errc{} || stopped != end || value < 0 || value > max_answers) {
    refuse(file, line, fmt::format("'{}' is not a count (from 0 to {})", cell, max_answers));
  }
  return value;
}

ConfusionMatrix from_answers(const std::vector<Line>& lines, const std::string& file) {
  std::set<std::string> names;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    names.insert({lines[i].cells[0], lines[i].cells[1]});
  }
  if (names.size() > max_classes) {
    refuse(file, lines.front().number,
           fmt::format("names {} different stimuli and responses (at "
                       "most {})",
                       names.size(), max_classes));
  }
  std::vector<Item> items;
  for (const std::string& name : names) {
    items.push_back({name, name, {}});
  }
  ConfusionMatrix matrix{items, items};
  for (std::size_t i = 1; i < lines.size(); ++i) {
    matrix.add(lines[i].cells[0], lines[i].cells[1]);
  }
  return matrix;
}

std::vector<Item> stimuli_of(const std::vector<Line>& lines, const std::string& file) {
  std::vector<Item> stimuli;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const std::string& name = lines[i].cells[0];
    if (has_name(stimuli, name)) {
      refuse(file, lines[i].number, fmt::format("stimulus '{}' is there twice", name));
    }
    stimuli.push_back({name, name, {}});
  }
  return stimuli;
}

// The first column that is named like a stimulus, or their number.
std::size_t first_response(const std::vector<std::string>& header,
                           const std::vector<Item>& stimuli) {
  const auto found = std::find_if(header.begin() + 1, header.end(),
                                  [&](const std::string& name) { return has_name(stimuli, name); });
  return static_cast<std::size_t>(found - header.begin());
}

std::vector<Item> responses_of(const Line& header, std::size_t first,
                               const std::vector<Item>& stimuli, const std::string& file) {
  std::vector<Item> responses;
  for (std::size_t column = first; column < header.cells.size(); ++column) {
    const std::string& name = header.cells[column];
    if (has_name(responses, name)) {
      refuse(file, header.number, fmt::format("response '{}' is there twice", name));
    }
    const auto stimulus = std::ranges::find(stimuli, name, &Item::name);
    responses.push_back(stimulus != stimuli.end() ? *stimulus : Item{name, name, {}});
  }
  if (responses.size() < 2) {
    refuse(file, header.number, "has fewer than two responses");
  }
  return responses;
}

ConfusionMatrix from_matrix(const std::vector<Line>& lines, const std::string& file) {
  const std::vector<std::string>& header = lines.front().cells;
  if (std::max(lines.size(), header.size()) > max_classes) {
    refuse(file, lines.front().number,
           fmt::format("has more than {} stimuli or responses", max_classes));
  }
  std::vector<Item> stimuli = stimuli_of(lines, file);
  const std::size_t first = first_response(header, stimuli);
  for (std::size_t i = 0; i < stimuli.size(); ++i) {
    for (std::size_t column = 1; column < first; ++column) {
      stimuli[i].factors[header[column]] = lines[i + 1].cells[column];
    }
  }
  ConfusionMatrix matrix{stimuli, responses_of(lines.front(), first, stimuli, file)};
  for (const Line& line : std::span{lines}.subspan(1)) {
    for (std::size_t column = first; column < header.size(); ++column) {
      matrix.add(line.cells[0], header[column], count_in(line.cells[column], file, line.number));
    }
  }
  return matrix;
}
}  // namespace

ConfusionMatrix read_counts(std::istream& text, const std::string& file) {
  const std::vector<Line> lines = read_lines(text, file);
  const std::vector<std::string>& header = lines.front().cells;
  const bool is_answers = header.size() >= 2 && header[1] == "response";
  ConfusionMatrix matrix = is_answers ? from_answers(lines, file) : from_matrix(lines, file);
  if (matrix.total() == 0) {
    refuse(file, lines.front().number, "holds no answers");
  }
  return matrix;
}
}  // namespace tapstudy::analysis
