#include "analysis/statistics/csv_rows.hpp"

#include <csv.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "analysis/statistics/file_kinds.hpp"
#include "analysis/statistics/text_encoding.hpp"
#include "core/error.hpp"
#include "core/text/plain_text.hpp"
#include "core/text/spreadsheet_cell.hpp"
namespace tapstudy::analysis {
namespace {
constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

// Outside of quotes: commas may be decimal ones beside the others.
char separator_of(std::string_view header) {
  constexpr std::string_view before_quote = " \t;,\"";
  std::string outside;
  bool is_quoted = false;
  char before = ' ';
  for (const char c : header) {
    const bool may_turn = is_quoted || before_quote.find(before) != std::string_view::npos;
    is_quoted = is_quoted != (c == '"' && may_turn);
    outside += is_quoted ? ' ' : c;
    before = c;
  }
  for (const char separator : {'\t', ';'}) {
    if (outside.find(separator) != std::string::npos) {
      return separator;
    }
  }
  const bool has_only_names =
      header.starts_with('"') && outside.find_first_not_of(" \"\r") == std::string::npos;
  return has_only_names && header.find("\" \"") != std::string::npos ? ' ' : ',';
}

class CsvReader {
 public:
  // Of the text of an option: a row without header, in which quotes are characters but around
  // cells.
  explicit CsvReader(std::string file, bool is_option = false)
      : file_{std::move(file)}, is_option_{is_option} {
    csv_init(&parser_, strict);
  }
  ~CsvReader() { csv_free(&parser_); }
  CsvReader(const CsvReader&) = delete;
  CsvReader& operator=(const CsvReader&) = delete;
  CsvReader(CsvReader&&) = delete;
  CsvReader& operator=(CsvReader&&) = delete;

  CsvText read(std::string_view text) {
    if (text.starts_with(byte_order_mark)) {
      text.remove_prefix(byte_order_mark.size());
    }
    while (!text.empty()) {
      const std::size_t end = text.find('\n');
      const std::string_view line = text.substr(0, end);
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
      ++line_;
      check_characters(line);
      const bool is_before_rows = !is_option_ && !is_inside_row_ && text_.rows.empty();
      if (is_before_rows && line.starts_with('#')) {
        text_.comments.emplace_back(line);
      } else {
        if (is_before_rows) {
          text_.separator = separator_of(line);
          csv_set_delim(&parser_, static_cast<unsigned char>(text_.separator));
        }
        take(line);
      }
    }
    if (csv_fini(&parser_, end_cell, end_row, this) != 0) {
      refuse();
    }
    return std::move(text_);
  }

 private:
  void check_characters(std::string_view line) const {
    if (!is_utf8(line)) {
      throw core::InvalidInput{fmt::format(
          "{}:{}: is not UTF-8 text (save it as UTF-8, as spreadsheets do by 'CSV UTF-8')", file_,
          line_)};
    }
    const auto is_control = [](unsigned char c) {
      return (c < ' ' && c != '\t' && c != '\r') || c == 0x7F;
    };
    if (std::ranges::any_of(line, is_control)) {
      throw core::InvalidInput{fmt::format("{}:{}: has a control character", file_, line_)};
    }
  }
  void take(std::string_view line) {
    if (!is_inside_row_) {
      row_.line = line_;
    }
    is_inside_row_ = true;
    for (auto quote = line.find('"'); quote != std::string_view::npos; quote = line.find('"')) {
      parse(line.substr(0, quote));
      // programs that never quote separate by tabs
      const bool is_character =
          (is_option_ || text_.separator == '\t') && parser_.quoted == 0 && parser_.entry_pos > 0;
      csv_set_opts(&parser_, is_character ? CSV_STRICT_FINI : strict);
      parse("\"");
      csv_set_opts(&parser_, strict);
      line.remove_prefix(quote + 1);
    }
    parse(line);
    parse("\n");
    // an empty line ends no row, for there is none
    is_inside_row_ = is_inside_row_ && !(row_.cells.empty() && parser_.quoted == 0);
  }
  void parse(std::string_view part) {
    if (csv_parse(&parser_, part.data(), part.size(), end_cell, end_row, this) != part.size()) {
      refuse();
    }
  }
  [[noreturn]] void refuse() {
    throw core::InvalidInput{
        fmt::format("{}:{}: a quote is out of place or left open", file_, row_.line)};
  }
  static void end_cell(void* text, std::size_t size, void* self) {
    static_cast<CsvReader*>(self)->row_.cells.emplace_back(
        core::text_of_cell({static_cast<const char*>(text), size}));
  }
  static void end_row(int /*terminator*/, void* self) {
    auto& reader = *static_cast<CsvReader*>(self);
    const std::size_t cells = reader.row_.cells.size();
    reader.text_.rows.push_back(std::exchange(reader.row_, {}));
    reader.row_.cells.reserve(cells);  // the next row has as many, too
    reader.is_inside_row_ = false;
  }

  static constexpr unsigned char strict = CSV_STRICT | CSV_STRICT_FINI;
  std::string file_;
  bool is_option_;
  csv_parser parser_{};
  int line_{0};
  bool is_inside_row_{false};
  CsvRow row_;
  CsvText text_;
};
}  // namespace

std::optional<double> CsvText::number(std::string cell) const {
  if (separator != ',') {
    std::ranges::replace(cell, ',', '.');
  }
  return core::number_in<double>(std::string_view{cell}.substr(cell.starts_with('+') ? 1 : 0));
}

std::optional<std::int64_t> count_in_cell(const CsvText& table, const std::string& cell) {
  const std::size_t end = cell.find_first_of(table.separator == ',' ? "." : ".,");
  const std::string decimals = end == std::string::npos ? "0" : cell.substr(end + 1);
  constexpr std::size_t of_thousands = 3;  // in 1.000 the point may stand between thousands
  const bool is_whole = !decimals.empty() && decimals.size() != of_thousands &&
                        decimals.find_first_not_of('0') == std::string::npos;
  const auto count = core::number_in<std::int64_t>(cell.substr(0, end));
  return is_whole && count && *count >= 0 ? count : std::nullopt;
}

std::string CsvText::place(const std::string& file, int row) const {
  return fmt::format("{}{}{}", file, has_objects ? ", object " : ":", row);
}

// A device such as /dev/zero has no end.
std::string table_text(std::istream& text, const std::string& file) {
  constexpr std::size_t max_bytes = 64'000'000;
  std::string bytes;
  std::array<char, 65'536> part{};
  while (text.read(part.data(), part.size()) || text.gcount() > 0) {
    if (bytes.empty()) {
      check_may_be_text({part.data(), static_cast<std::size_t>(text.gcount())}, file);
    }
    bytes.append(part.data(), static_cast<std::size_t>(text.gcount()));
    if (bytes.size() > max_bytes) {
      throw core::InvalidInput{
          fmt::format("{}: is larger than {} MB", file, max_bytes / 1'000'000)};
    }
  }
  return bytes;
}

CsvText read_csv(std::istream& text, const std::string& file) {
  return CsvReader{file}.read(table_text(text, file));
}

std::vector<std::string> cells_of_option(const std::string& text, const std::string& option) {
  const CsvText csv = CsvReader{option, true}.read(text);
  return csv.rows.empty() ? std::vector<std::string>{} : csv.rows.front().cells;
}

std::string csv_cell(const std::string& unguarded) {
  const std::string text = core::guarded_cell(unguarded);
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
