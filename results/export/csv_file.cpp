#include "results/export/csv_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/text/spreadsheet_cell.hpp"
namespace tapstudy::results {
namespace {
using Buffer = fmt::memory_buffer;

void append(Buffer& line, const std::string& text) {
  line.append(text.data(), text.data() + text.size());
}

bool needs_quotes(const std::string& text) {
  return text.empty() || text.find_first_of(",\"\n\r\t") != std::string::npos ||
         text.front() == ' ' || text.back() == ' ';
}

void append_text(Buffer& line, const std::string& stored) {
  const std::string text = core::guarded_cell(stored);
  if (!needs_quotes(text)) {
    append(line, text);
    return;
  }
  line.push_back('"');
  for (const char c : text) {
    if (c == '"') {
      line.push_back('"');
    }
    line.push_back(c);
  }
  line.push_back('"');
}

void append_real(Buffer& line, double number) {
  if (std::isnan(number)) {
    append(line, missing_in_csv);
  } else if (std::isinf(number)) {
    append(line, number > 0.0 ? "INF" : "-INF");
  } else if (number == 0.0 && std::signbit(number)) {
    append(line, "-0.0");  // "-0" would be read as an integer, without its sign
  } else {
    fmt::format_to(std::back_inserter(line), "{}", number);
  }
}

struct AppendCell {
  Buffer& line;
  void operator()(std::monostate /*missing*/) const { append(line, missing_in_csv); }
  void operator()(std::int64_t number) const {
    fmt::format_to(std::back_inserter(line), "{}", number);
  }
  void operator()(double number) const { append_real(line, number); }
  void operator()(const std::string& text) const { append_text(line, text); }
};

void write_line(std::ostream& out, Buffer& line, const Row& row) {
  line.clear();
  for (const Cell& cell : row) {
    if (&cell != row.data()) {
      line.push_back(',');
    }
    std::visit(AppendCell{line}, cell);
  }
  line.push_back('\n');
  out.write(line.data(), static_cast<std::streamsize>(line.size()));
}
}  // namespace

void write_csv(std::ostream& out, const Table& table) {
  Buffer line;
  Row header;
  for (const Column& column : table.columns) {
    header.emplace_back(column.name);
  }
  write_line(out, line, header);
  table.each_row([&](const Row& row) { write_line(out, line, row); });
}

namespace {
struct TextOf {
  std::string operator()(std::monostate /*missing*/) const { return missing_in_tsv; }
  std::string operator()(std::int64_t number) const { return fmt::format("{}", number); }
  std::string operator()(double number) const {
    return std::isnan(number) ? missing_in_tsv : fmt::format("{}", number);
  }
  std::string operator()(std::string text) const {
    std::ranges::replace_if(
        text, [](char c) { return c == '\t' || c == '\n' || c == '\r'; }, ' ');
    return text.empty() ? missing_in_tsv : text;
  }
};
}  // namespace

std::string tsv_line(const Row& row) {
  std::string line;
  for (const Cell& cell : row) {
    if (!line.empty()) {
      line += '\t';
    }
    line += std::visit(TextOf{}, cell);
  }
  return line + '\n';
}
}  // namespace tapstudy::results
