#include "analysis/statistics/csv_rows.hpp"

#include <csv.h>
#include <fmt/format.h>

#include <utility>

#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
class CsvReader {
 public:
  explicit CsvReader(std::string file) : file_{std::move(file)} {
    csv_init(&parser_, CSV_STRICT | CSV_STRICT_FINI);
  }
  ~CsvReader() { csv_free(&parser_); }
  CsvReader(const CsvReader&) = delete;
  CsvReader& operator=(const CsvReader&) = delete;
  CsvReader(CsvReader&&) = delete;
  CsvReader& operator=(CsvReader&&) = delete;

  std::vector<CsvRow> read(std::istream& text) {
    for (std::string line; std::getline(text, line);) {
      ++line_;
      const bool is_comment = !is_inside_row_ && line.starts_with('#');
      if (!is_comment) {
        take(line + '\n');
      }
    }
    if (csv_fini(&parser_, end_cell, end_row, this) != 0) {
      refuse();
    }
    return std::move(rows_);
  }

 private:
  void take(const std::string& line) {
    if (!is_inside_row_) {
      row_.line = line_;
    }
    is_inside_row_ = true;
    if (csv_parse(&parser_, line.data(), line.size(), end_cell, end_row, this) != line.size()) {
      refuse();
    }
    // an empty line ends no row, for there is none
    is_inside_row_ = is_inside_row_ && !(row_.cells.empty() && parser_.quoted == 0);
  }
  [[noreturn]] void refuse() {
    throw core::InvalidInput{
        fmt::format("{}:{}: a quote is out of place or left open", file_, row_.line)};
  }
  static void end_cell(void* text, std::size_t size, void* self) {
    static_cast<CsvReader*>(self)->row_.cells.emplace_back(static_cast<const char*>(text), size);
  }
  static void end_row(int /*terminator*/, void* self) {
    auto& reader = *static_cast<CsvReader*>(self);
    reader.rows_.push_back(std::exchange(reader.row_, {}));
    reader.is_inside_row_ = false;
  }

  std::string file_;
  csv_parser parser_{};
  int line_{0};
  bool is_inside_row_{false};
  CsvRow row_;
  std::vector<CsvRow> rows_;
};
}  // namespace

std::vector<CsvRow> read_csv(std::istream& text, const std::string& file) {
  return CsvReader{file}.read(text);
}

std::string csv_cell(const std::string& text) {
  const bool needs_quotes = text.find_first_of(",\"\r\n#") != std::string::npos ||
                            text.starts_with(' ') || text.ends_with(' ');
  if (!needs_quotes) {
    return text;
  }
  std::string cell(2 * text.size() + 2, '\0');
  cell.resize(csv_write(cell.data(), cell.size(), text.data(), text.size()));
  return cell;
}
}  // namespace tapstudy::analysis
